// lilytank optimize: what builds a target best.
#include <filesystem>
#include <iostream>

#include "cli/progress.hpp"
#include "cli/results.hpp"
#include "cli/study_verb.hpp"
#include "io/atomic_file.hpp"
#include "lilytank/optimize.hpp"
#include "optimize/search_directory.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

namespace fs = std::filesystem;

std::string plan_line(const OptimizationPlan& plan, const std::string& out) {
  const std::string copies =
      std::to_string(plan.possible) + (plan.possible == 1 ? " copy" : " copies");
  return "optimize " + plan.name + ": " + name_of(plan.fitness.fitness) + " of " + copies +
         " within " + shortest(plan.horizon) + " s over " +
         counted(static_cast<std::int64_t>(plan.space.size()), "parameter") + ", " + plan.method +
         ", " +
         (plan.rulesets > 0 ? "a race of " + std::to_string(plan.rulesets) + " rulesets, " : "") +
         std::to_string(plan.budget) + " evaluations; in " + out;
}

int dry_run(const OptimizationPlan& plan, const std::string& out) {
  std::cout << "would " << plan_line(plan, out) << "\n";
  for (std::size_t i = 0; i < plan.space.size(); ++i) {
    const SearchAxis& axis = plan.space[i];
    std::cout << "  " << axis.name << ": " << shortest(axis.low) << " .. " << shortest(axis.high)
              << (axis.logarithmic ? " (log)" : "") << ", from " << shortest(plan.start[i]) << "\n";
  }
  return Exit::done;
}

/// What the search gained, as a figure's title.
std::string search_sentence(const std::vector<IterationRecord>& history) {
  if (history.empty()) return "";
  return "The search moves the best point from " + significant(history.front().best, 3) + " to " +
         significant(history.back().best, 3) + " in " +
         counted(history.back().evaluations, "evaluation") + ".";
}

/// Text and, where they can be drawn, the plot and the page.
void write_report(const OptimizationPlan& plan, const OptimizationResult& result,
                  const ReportDocument& document, const std::string& dir,
                  const FigureStyle& style) {
  write_atomically((fs::path(dir) / "optimum.txt").string(), report_text(document));
  write_atomically((fs::path(dir) / "optimum.json").string(), report_json(document));
  if constexpr (kDraws) {
    const std::string unit = fitness_unit(plan.fitness.fitness);
    const Plot plot =
        search_plot(result.history, result.selected, search_sentence(result.history),
                    name_of(plan.fitness.fitness) + (unit == "1" ? "" : " (" + unit + ")"));
    draw_search(plot, document, dir, style);
  } else {
    say_undrawn("plots");
  }
}

OptimizationResult run_with_progress(const Optimization& what, OptimizationOptions job, bool quiet,
                                     const Host& host) {
  Progress progress(quiet, host);
  if (!quiet) std::cerr << plan_line(what.plan(), job.out) << "\n";
  progress.watch(job);
  return run_optimization(what, job);
}

/// The study that compares the optimum; its exit code.
int compare(const Optimization& what, const OptimizationResult& result,
            const OptimizationOptions& options, const FigureStyle& style, bool quiet,
            const Host& host) {
  const Study study(result.compare, what.plan().sets);
  StudyOptions job;
  job.out = (fs::path(options.out) / "compare").string();
  job.threads = options.threads, job.force = options.force;
  Progress progress(quiet, host);
  progress.watch(job);
  job.progress = [&](double share, const std::string& note) {
    progress.show(share, "comparing: " + note);
  };
  const StudyResult done = run_study(study, job);
  progress.clear();
  const StoredStudy stored = load_study(job.out);
  write_table(stored, job.out);
  std::cout << report(stored, job.out, style, host) << std::flush;
  return done.failed > 0 ? Exit::diverged : Exit::done;
}

}  // namespace

int optimize_verb(const Arguments& arguments, const Host& host) {
  VerbOptions options("optimize", "STUDY.toml",
                      "Searches rule probabilities, a switch of them, pump power or rulesets for "
                      "what builds a target best.");
  OptimizationOptions job;
  std::vector<std::string> overlays, sets;
  bool quiet = false;
  options.add({"overlay", "a file that overrides values of the scenarios, before --set", "FILE"},
              &overlays);
  options.add({"set", "a value for every simulation, as run.duration='1 h'", "PATH=VALUE"}, &sets);
  options.add_seed("where the seeds of the simulations come from, instead of optimize.seed", &sets);
  options.add({"out", "directory of the results (default: out/<name>)", "DIR"});
  options.add({"threads", "simulations at a time (default: one a core)", "N"}, &job.threads, 1,
              kMostThreads);
  FigureStyle style;
  add_figure_options(options, style);
  options.add({"no-compare", "skip the comparison of [compare]"});
  options.add({"dry-run", "check everything, write nothing"});
  options.add({"force", "replace another search's files"}, &job.force);
  options.add({"quiet", "no progress"}, &quiet);
  if (!options.parse(arguments)) return Exit::done;
  const Optimization what(
      options.only("one file, please: lilytank optimize scenarios/optimize/chain5.toml"), overlays,
      sets);
  job.out = options.out("out/" + what.plan().name);
  check_directory_can_be(job.out);
  spare_read(options, files_of_search(job.out), what.source().inputs());
  check_search_directory(what.source(), job.out, job.force);
  if (options.has("dry-run")) return dry_run(what.plan(), job.out);
  std::shared_ptr<const DirectoryLock> lock;  // until the report is written
  job.lock = &lock;
  const OptimizationResult result = run_with_progress(what, job, quiet, host);
  if (result.optimum.empty()) {
    std::cerr << "no optimum: at every point that was evaluated a simulation diverged; every "
                 "value is in "
              << job.out << "\n";
    return Exit::diverged;
  }
  ReportDocument document = optimization_report(what.plan(), result);
  document.provenance = provenance("optimize", arguments, what.plan().seed, what.source().inputs());
  std::cout << printed(document, host) << std::flush;
  write_report(what.plan(), result, document, job.out, style);
  if (result.compare.empty() || options.has("no-compare")) return Exit::done;
  return compare(what, result, job, style, quiet, host);
}

}  // namespace lilytank::cli
