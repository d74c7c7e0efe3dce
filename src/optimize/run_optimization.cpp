// The job behind `lilytank optimize`: search, write the optimum, prepare its comparison.
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/scenario_values.hpp"
#include "lilytank/search_run.hpp"
#include "optimize/race.hpp"
#include "optimize/repeats.hpp"
#include "optimize/search_directory.hpp"
#include "optimize/source.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kFirstOfLast = 1LL << 32;  // replicates; no search comes that far

/// Worlds of each of the two in a race's last comparison.
int last_worlds(const Optimization::Source& source) {
  return static_cast<int>(std::max<std::int64_t>(12, source.file.cma_es.budget / 4));
}

std::string four(double value) {
  return significant(value, 4);
}

std::string comment_of(const OptimizationPlan& plan, const Incumbent& best) {
  const std::string unit = fitness_unit(plan.fitness.fitness);
  return "The best point that lilytank optimize found for " + plan.name + ":\n" +
         name_of(plan.fitness.fitness) + " " + four(best.mean) + (unit == "1" ? "" : " " + unit) +
         ", standard error " + four(best.standard_error) + ", from " +
         std::to_string(best.evaluations) + " of its evaluations.";
}

/// A list of TOML texts.
std::string list_of(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + toml_quoted(word);
  return "[" + out + "]";
}

/// A study file that compares the optimum, first, with the other overlays.
std::string compare_text(const Optimization::Source& source, const std::string& dir) {
  const CompareTable& compare = source.file.compare;
  const auto from_here = [&](const std::string& file) {
    return fs::proximate(file, dir).generic_string();
  };
  std::vector<std::string> scenarios, overlays{"optimum.toml"}, labels{"optimum"};
  for (const std::string& file : source.plan.scenarios) scenarios.push_back(from_here(file));
  for (const std::string& file : compare.overlays) overlays.push_back(from_here(file));
  labels.insert(labels.end(), compare.labels.begin(), compare.labels.end());
  return "# The optimum beside what it is compared with.\n[study]\nname = " +
         toml_quoted(source.plan.name + "_compare") + "\nscenario = " + list_of(scenarios) +
         "\nreplicates = " + std::to_string(compare.replicates) +
         "\nseed = " + std::to_string(compare.seed) +
         "\nuntil = \"settled\"\n\n[[axis]]\nname = \"strategy\"\noverlays = " + list_of(overlays) +
         "\nlabels = " + list_of(labels) + "\n";
}

/// What one has is given up only for something better: a race's winner, as it was searched, against
/// the scenario's own ruleset at its start, in worlds that neither had. False if it was stopped.
bool keep_own_if_better(const RaceOutcome& race, const Optimization::Source*& source,
                        OptimizationResult& result, const OptimizationOptions& options) {
  if (!race.own) return true;
  const int count = last_worlds(*source);
  const auto last = [&](const Optimization::Source& of, const std::vector<double>& point) {
    const std::string name = of.scenario(point).model.rulesets.front().name;
    if (options.progress) options.progress(1, "last comparison: " + name);
    const fs::path file = fs::path(options.out) / "race" / "last" / (name + ".csv");
    const auto mean = repeated(of, point, kFirstOfLast, count, file.string(), options);
    for (RaceEntry& entry : result.race) {
      if (mean && entry.ruleset == name) entry.last = mean->mean;
    }
    return mean;
  };
  const auto searched = last(*source, result.best.point);
  if (!searched) return false;
  const auto own = last(*race.own, race.own->plan.start);
  if (!own) return false;
  const bool stays = !(searched->mean < own->mean);
  if (stays) source = race.own.get();
  result.best = stays ? *own : *searched;
  return true;
}

/// The best point as an overlay, with its rulesets; the overlay's path.
std::string write_optimum(const Optimization::Source& source, const Incumbent& best,
                          const std::string& dir) {
  for (const auto& file : source.overlay(best.point, "optimum", comment_of(source.plan, best))) {
    write_atomically((fs::path(dir) / file.name).string(), file.content);
  }
  return (fs::path(dir) / "optimum.toml").string();
}

}  // namespace

OptimizationResult run_optimization(const Optimization& what, const OptimizationOptions& options) {
  OptimizationResult result;
  const Optimization::Source* source = &what.source();
  check_search_directory(*source, options.out, options.force);
  std::unique_ptr<Search> search = source->search();
  std::string before;  // of the progress
  const RaceOutcome race = run_race(*source, options);
  result.race = race.entries;
  result.stopped = race.stopped;
  if (result.stopped) return result;
  if (race.winner) {
    source = race.winner.get();
    search = source->cma_es(source->file.cma_es.budget, race.start, source->file.cma_es.sigma / 2);
  }
  SearchRunOptions run;
  run.dir = options.out, run.identity = source->identity();
  run.force = options.force, run.threads = options.threads, run.stop = options.stop;
  run.progress = [&](const SearchProgress& now) {
    if (!options.progress) return;
    options.progress(race.share + (1 - race.share) * now.done,
                     std::to_string(now.evaluations) + " evaluations, best " + four(now.best) +
                         " " + fitness_unit(source->plan.fitness.fitness) + ", " +
                         four(now.evaluations_per_second) + "/s");
  };
  SearchRunResult found = run_search(
      std::move(search), [&](const Trial& trial) { return source->evaluate(trial, options.stop); },
      run);
  result.best = found.search->best();
  result.history = found.search->history(), result.selected = found.search->selected();
  result.stopped = found.stopped || !keep_own_if_better(race, source, result, options);
  if (result.stopped) return result;
  result.optimum = write_optimum(*source, result.best, options.out);
  if (source->plan.replicates == 0) return result;
  result.compare = (fs::path(options.out) / "compare.toml").string();
  write_atomically(result.compare, compare_text(*source, options.out));
  return result;
}

}  // namespace lilytank
