// A search from its first batch, or where it stopped, to its last.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>

#include "lilytank/search_run.hpp"
#include "lilytank/study.hpp"
#include "study/search_store.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr double kBetweenTellings = 0.2;  // s of wall time

class SearchJob {
 public:
  SearchJob(std::unique_ptr<Search> fresh, const Objective& objective,
            const SearchRunOptions& options)
      : objective_(&objective), options_(&options), store_(options, *fresh) {
    result_.search = store_.stored();
    if (!result_.search) result_.search = std::move(fresh);
  }

  SearchRunResult run() {
    Search& search = *result_.search;
    for (auto trials = search.ask(); !trials.empty(); trials = search.ask()) {
      if (!batch(trials)) {
        store_.checkpoint(search);
        throw Stopped();
      }
      search.tell(values_);
      store_.completed(search);
    }
    store_.finish(search);
    return std::move(result_);
  }

 private:
  bool stopped() const {
    return options_->stop != nullptr && options_->stop->load(std::memory_order_relaxed);
  }

  /// Brings values_ together; false if some are missing because of the stop signal.
  bool batch(const std::vector<Trial>& trials) {
    std::vector<std::optional<double>> found = store_.known(trials);
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (!found[i]) missing.push_back(i);
    }
    here_ = static_cast<std::int64_t>(found.size() - missing.size());
    for_each_world(static_cast<int>(missing.size()), options_->threads, [&](int m) {
      const std::size_t i = missing[static_cast<std::size_t>(m)];
      if (!stopped()) found[i] = evaluate(i, trials[i]);
    });
    values_.clear();
    for (const auto& value : found) {
      if (value) values_.push_back(*value);
    }
    return values_.size() == trials.size();
  }

  std::optional<double> evaluate(std::size_t index, const Trial& trial) {
    std::optional<double> value = (*objective_)(trial);
    if (!value) return value;
    // Whatever is no number is one thing, so that the log's text is the value.
    if (!std::isfinite(*value)) value = std::numeric_limits<double>::infinity();
    store_.keep(index, trial, *value);
    const std::lock_guard hold(lock_);
    ++here_, ++result_.evaluated;
    tell();
    return value;
  }

  void tell() {
    if (!options_->progress) return;
    const double t = std::chrono::duration<double>(Clock::now() - start_).count();
    if (t - told_ < kBetweenTellings) return;
    told_ = t;
    const Search& search = *result_.search;
    SearchProgress now;
    now.evaluations = search.evaluations() + here_;
    now.done =
        std::min(1.0, static_cast<double>(now.evaluations) / static_cast<double>(search.budget()));
    now.iteration = static_cast<int>(search.history().size());
    now.best = search.history().empty() ? std::numeric_limits<double>::quiet_NaN()
                                        : search.history().back().best;
    now.evaluations_per_second = static_cast<double>(result_.evaluated) / t;
    options_->progress(now);
  }

  using Clock = std::chrono::steady_clock;
  const Objective* objective_;
  const SearchRunOptions* options_;
  SearchStore store_;
  SearchRunResult result_;
  std::vector<double> values_;
  std::mutex lock_;
  std::int64_t here_ = 0;  ///< values of this batch so far
  double told_ = 0;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

SearchRunResult run_search(std::unique_ptr<Search> search, const Objective& objective,
                           const SearchRunOptions& options) {
  return SearchJob(std::move(search), objective, options).run();
}

std::string history_text(const Search& search) {
  std::string out = "iteration,evaluations,best,median,worst,spread";
  for (const SearchAxis& axis : search.space()) out += "," + axis.name;
  out += "\n";
  for (const IterationRecord& r : search.history()) {
    out += std::to_string(r.iteration) + "," + std::to_string(r.evaluations);
    for (const double value : {r.best, r.median, r.worst, r.spread}) out += "," + shortest(value);
    for (const double value : r.best_point) out += "," + shortest(value);
    out += "\n";
  }
  return out;
}

}  // namespace lilytank
