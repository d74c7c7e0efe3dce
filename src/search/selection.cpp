#include "search/selection.hpp"

#include <algorithm>

#include "search/candidates.hpp"
#include "search/space.hpp"

namespace lilytank {
namespace {

constexpr int kFirst = 2;            ///< evaluations of each candidate before any is preferred
constexpr int kMostCandidates = 10;  ///< candidates
constexpr int kStages = 8;           ///< after the first evaluations

}  // namespace

int selection_size(int evaluations) {
  return std::clamp(evaluations / (2 * kFirst), 1, kMostCandidates);
}

Selection::Selection(std::vector<UnitPoint> points, int evaluations, std::int64_t first_replicate)
    : points_(std::move(points)),
      tallies_(points_.size()),
      evaluations_(evaluations),
      first_replicate_(first_replicate) {}

/// Each of them once or twice first, then by what is known.
std::vector<int> Selection::plan() const {
  const int left = evaluations_ - spent_;
  std::vector<int> shares(points_.size(), kFirst);
  if (stage_ > 0 || left < kFirst * static_cast<int>(points_.size())) {
    const int stages = std::max(1, kStages - stage_ + 1);
    std::vector<const Tally*> tallies;
    for (const Tally& tally : tallies_) tallies.push_back(&tally);
    shares = ocba_shares(candidates_of(tallies), (left + stages - 1) / stages);
  }
  std::vector<int> out;
  for (std::size_t c = 0; c < shares.size(); ++c) {
    out.insert(out.end(), static_cast<std::size_t>(shares[c]), static_cast<int>(c));
  }
  return out;
}

std::vector<Trial> Selection::ask(const SearchSpace& space, std::int64_t evaluated,
                                  bool common_random_numbers) {
  if (!begun() || over()) return {};
  if (asked_.empty()) asked_ = plan();
  std::vector<Trial> trials;
  std::int64_t ahead = 0;  // evaluations of the same candidate in this batch
  for (std::size_t i = 0; i < asked_.size(); ++i) {
    ahead = i > 0 && asked_[i] == asked_[i - 1] ? ahead + 1 : 0;
    const std::int64_t common = first_replicate_ + tally(asked_[i]).count + ahead;
    const std::int64_t own = evaluated + static_cast<std::int64_t>(i);
    trials.push_back({from_unit(space, point(asked_[i])), common_random_numbers ? common : own});
  }
  return trials;
}

void Selection::tell(std::span<const double> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    tallies_[static_cast<std::size_t>(asked_[i])].add(values[i]);
  }
  asked_.clear();
  spent_ += static_cast<int>(values.size());
  ++stage_;
}

const UnitPoint& Selection::point(int candidate) const {
  return points_[static_cast<std::size_t>(candidate)];
}

const Tally& Selection::tally(int candidate) const {
  return tallies_[static_cast<std::size_t>(candidate)];
}

int Selection::leader() const {
  int best = 0;
  for (int c = 1; c < static_cast<int>(points_.size()); ++c) {
    if (tally(c).mean < tally(best).mean) best = c;
  }
  return best;
}

std::vector<double> Selection::means() const {
  std::vector<double> out;
  for (const Tally& tally : tallies_) out.push_back(tally.mean);
  std::sort(out.begin(), out.end());
  return out;
}

void Selection::save(StateWriter& out) const {
  out.whole("candidates", static_cast<std::int64_t>(points_.size()));
  if (!begun()) return;
  const std::int64_t counts[] = {evaluations_, spent_, stage_, first_replicate_};
  out.wholes("selection", counts);
  for (std::size_t c = 0; c < points_.size(); ++c) {
    out.numbers("candidate", points_[c]);
    save_tally(out, tallies_[c]);
  }
  out.wholes("asked", std::vector<std::int64_t>(asked_.begin(), asked_.end()));
}

Selection::Selection(StateReader& in, std::size_t axes) {
  points_.resize(static_cast<std::size_t>(in.whole("candidates", 0, kMostCandidates)));
  if (!begun()) return;
  const auto counts = in.wholes("selection");
  if (counts.size() != 4) in.refuse("four whole numbers were expected");
  evaluations_ = static_cast<int>(counts[0]), spent_ = static_cast<int>(counts[1]);
  stage_ = static_cast<int>(counts[2]), first_replicate_ = counts[3];
  for (UnitPoint& point : points_) {
    point = in.numbers("candidate", axes);
    tallies_.push_back(load_tally(in));
  }
  for (const std::int64_t candidate : in.wholes("asked")) {
    if (candidate < 0 || candidate >= static_cast<std::int64_t>(points_.size())) {
      in.refuse("there is no such candidate");
    }
    asked_.push_back(static_cast<int>(candidate));
  }
}

}  // namespace lilytank
