// The job behind `lilytank optimize`: search, write the optimum, prepare its comparison.
#include <cmath>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "lilytank/search_run.hpp"
#include "optimize/comparison.hpp"
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

/// What one has is given up only for something better: a race's winner, as it was searched, against
/// the scenario's own ruleset at its start, in worlds that neither had.
void keep_own_if_better(const RaceOutcome& race, const Optimization::Source*& source,
                        OptimizationResult& result, const OptimizationOptions& options) {
  if (race.own == nullptr) return;
  const int count = last_worlds(*source);
  const auto last = [&](const Optimization::Source& of, const std::vector<double>& point) {
    const std::string name = of.scenario(point).model.rulesets.front().name;
    options.report(1, "last comparison: " + name);
    const fs::path file = fs::path(options.out) / "race" / "last" / (name + ".csv");
    const Incumbent mean = repeated(of, point, kFirstOfLast, count, file.string(), options);
    for (RaceEntry& entry : result.race) {
      if (entry.ruleset == name) entry.last = mean.mean;
    }
    return mean;
  };
  const Incumbent searched = last(*source, result.best.point);
  const Incumbent own = last(*race.own, race.own->plan.start);
  const bool stays = !(searched.mean < own.mean);
  if (stays) source = race.own;
  result.best = stays ? own : searched;
}

/// The best point as an overlay, with its rulesets; the overlay's path.
std::string write_optimum(const Optimization::Source& source, const Incumbent& best,
                          const std::string& dir) {
  for (const auto& file : source.overlay(best.point, "optimum", comment_of(source.plan, best))) {
    write_atomically((fs::path(dir) / file.name).string(), file.content);
  }
  return (fs::path(dir) / "optimum.toml").string();
}

void prepare_comparison(const Optimization::Source& source, OptimizationResult& result) {
  OptimumComparison comparison = comparison_with(source, result.optimum);
  result.compare = fs::path(result.optimum).replace_filename("compare.toml").string();
  result.left_out = std::move(comparison.left_out);
  write_atomically(result.compare, comparison.text);
}

}  // namespace

OptimizationResult run_optimization(const Optimization& what, const OptimizationOptions& options) {
  OptimizationResult result;
  const Optimization::Source* source = &what.source();
  const auto lock = claim_search_directory(*source, options.out, options.force);
  if (options.lock != nullptr) *options.lock = lock;
  std::unique_ptr<Search> search = source->search();
  const RaceOutcome race = run_race(*source, options);
  result.race = race.entries;
  if (race.winner != nullptr) source = race.winner, search = source->winners_search(race.start);
  SearchRunOptions run;
  run.dir = options.out, run.identity = source->identity(), run.locked = true;
  run.force = options.force, run.threads = options.threads, run.stop = options.stop;
  run.progress = [&](double done, const std::string& note) {
    options.report(race.share + (1 - race.share) * done,
                   note + " " + fitness_unit(source->plan.fitness.fitness));
  };
  SearchRunResult found = run_search(
      std::move(search), [&](const Trial& trial) { return source->evaluate(trial, options); }, run);
  result.best = found.search->best();
  result.history = found.search->history(), result.selected = found.search->selected();
  keep_own_if_better(race, source, result, options);
  if (!std::isfinite(result.best.mean)) return result;
  result.optimum = write_optimum(*source, result.best, options.out);
  if (source->plan.replicates > 0) prepare_comparison(*source, result);
  return result;
}

}  // namespace lilytank
