// A search from its first batch, or where it stopped, to its last.
#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "jobs/stop_watch.hpp"
#include "lilytank/search_run.hpp"
#include "lilytank/study.hpp"
#include "study/search_store.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

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
      try {
        search.tell(values_of(trials));
      } catch (const Stopped&) {
        store_.checkpoint(search);
        throw;
      }
      store_.completed(search);
    }
    store_.finish(search);
    return std::move(result_);
  }

 private:
  /// Those that are stored, and the others evaluated. Throws Stopped.
  std::vector<double> values_of(const std::vector<Trial>& trials) {
    std::vector<std::optional<double>> found = store_.known(trials);
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (!found[i]) missing.push_back(i);
    }
    here_ = static_cast<std::int64_t>(found.size() - missing.size());
    const auto one = [&](int m) {
      const std::size_t i = missing[static_cast<std::size_t>(m)];
      found[i] = evaluate(i, trials[i]);
    };
    for_each_world(static_cast<int>(missing.size()), options_->threads, one, *options_);
    std::vector<double> values;
    for (const auto& value : found) values.push_back(*value);
    return values;
  }

  double evaluate(std::size_t index, const Trial& trial) {
    double value = (*objective_)(trial);
    // Whatever is no number is one thing, so that the log's text is the value.
    if (!std::isfinite(value)) value = std::numeric_limits<double>::infinity();
    store_.keep(index, trial, value);
    const std::lock_guard hold(lock_);
    ++here_, ++result_.evaluated;
    if (options_->progress && reports_.due(kBetweenReports)) report();
    return value;
  }

  void report() const {
    const Search& search = *result_.search;
    const std::int64_t evaluations = search.evaluations() + here_;
    const double done = static_cast<double>(evaluations) / static_cast<double>(search.budget());
    const double best = search.history().empty() ? std::numeric_limits<double>::quiet_NaN()
                                                 : search.history().back().best;
    const double rate = static_cast<double>(result_.evaluated) / watch_.seconds();
    options_->report(std::min(1.0, done), std::to_string(evaluations) + " evaluations, " +
                                              significant(rate, 4) + "/s, best " +
                                              significant(best, 4));
  }

  const Objective* objective_;
  const SearchRunOptions* options_;
  SearchStore store_;
  SearchRunResult result_;
  std::mutex lock_;
  std::int64_t here_ = 0;  ///< values of this batch so far
  StopWatch watch_, reports_;
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
