#include "search/records.hpp"

#include <algorithm>
#include <stdexcept>

#include "search/space.hpp"

namespace lilytank {
namespace {

constexpr std::int64_t kMostRecords = 10'000'000;

}  // namespace

IterationRecord record_of(std::vector<double> means, std::int64_t evaluations,
                          const Incumbent& best, double spread) {
  std::sort(means.begin(), means.end());
  const std::size_t half = means.size() / 2;
  const double median = means.size() % 2 == 1 ? means[half] : (means[half - 1] + means[half]) / 2;
  return {0, evaluations, best.mean, median, means.back(), best.point, spread};
}

Incumbent incumbent_of(const SearchSpace& space, const std::vector<double>& u, const Tally& tally) {
  return {from_unit(space, u), tally.mean, tally.standard_error(), tally.count};
}

void check_count(std::size_t received, std::size_t requested) {
  if (received == requested && requested > 0) return;
  throw std::logic_error("a search received " + std::to_string(received) +
                         " values where it needs " + std::to_string(requested));
}

void save_history(StateWriter& out, const std::vector<IterationRecord>& history) {
  out.whole("records", static_cast<std::int64_t>(history.size()));
  for (const IterationRecord& record : history) {
    const std::int64_t counts[] = {record.iteration, record.evaluations};
    out.wholes("iteration", counts);
    const double values[] = {record.best, record.median, record.worst, record.spread};
    out.numbers("values", values);
    out.numbers("best", record.best_point);
  }
}

std::vector<IterationRecord> load_history(StateReader& in, std::size_t axes) {
  const auto count = in.whole("records", 0, kMostRecords);
  std::vector<IterationRecord> history;
  for (std::int64_t i = 0; i < count; ++i) {
    IterationRecord record;
    const auto counts = in.wholes("iteration");
    if (counts.size() != 2) in.refuse("two whole numbers were expected");
    record.iteration = static_cast<int>(counts[0]), record.evaluations = counts[1];
    const auto values = in.numbers("values", 4);
    record.best = values[0], record.median = values[1], record.worst = values[2];
    record.spread = values[3];
    record.best_point = in.numbers("best", axes);
    history.push_back(std::move(record));
  }
  return history;
}

}  // namespace lilytank
