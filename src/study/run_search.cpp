#include <filesystem>

#include "io/atomic_file.hpp"
#include "lilytank/search_run.hpp"
#include "lilytank/study.hpp"
#include "text/number.hpp"

namespace lilytank {

std::string history_text(const Search& search) {
  std::string out = "iteration,evaluations,best,median,worst,spread";
  for (const SearchAxis& axis : search.space()) out += "," + axis.name;
  out += "\n";
  for (const IterationRecord& r : search.history()) {
    out += std::to_string(r.iteration) + "," + std::to_string(r.evaluations);
    for (const double v : {r.best, r.median, r.worst, r.spread}) out += "," + shortest(v);
    for (const double v : r.best_point) out += "," + shortest(v);
    out += "\n";
  }
  return out;
}

SearchRunResult run_search(std::unique_ptr<Search> search, const Objective& objective,
                           const SearchRunOptions& options) {
  std::filesystem::create_directories(options.dir);
  SearchRunResult result;
  result.search = std::move(search);
  for (auto trials = result.search->ask(); !trials.empty(); trials = result.search->ask()) {
    std::vector<std::optional<double>> found(trials.size());
    for_each_world(static_cast<int>(trials.size()), options.threads, [&](int i) {
      const auto t = static_cast<std::size_t>(i);
      found[t] = objective(trials[t]);
    });
    std::vector<double> values;
    for (const auto& value : found) {
      if (value) values.push_back(*value);
    }
    result.stopped = values.size() != trials.size();
    if (result.stopped) break;
    result.search->tell(values);
    result.evaluated += static_cast<std::int64_t>(values.size());
  }
  write_atomically((std::filesystem::path(options.dir) / "history.csv").string(),
                   history_text(*result.search));
  return result;
}

}  // namespace lilytank
