#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "cli/progress.hpp"
#include "cli/results.hpp"
#include "cli/study_verb.hpp"
#include "io/standard_input.hpp"
#include "study/study_directory.hpp"
#include "text/number.hpp"

namespace lilytank::cli {
namespace {

Shard shard_of(const VerbOptions& options) {
  if (options.has("shard")) return shard_from(options.text("shard"));
  return shard_of_environment(std::getenv);
}

int usual_threads() {
  const char* cpus = std::getenv("SLURM_CPUS_PER_TASK");
  const auto value = parse_whole(cpus == nullptr ? "" : cpus);
  return value && *value >= 1 && *value <= kMostThreads ? static_cast<int>(*value) : 0;
}

std::string shard_text(const Shard& shard) {
  return "shard " + std::to_string(shard.index + 1) + "/" + std::to_string(shard.count);
}

std::string plan_line(const StudyPlan& plan, const StudyOptions& job) {
  const auto n = static_cast<std::int64_t>(plan.settings.size());
  std::string out = "study " + plan.name + ": " + counted(n, "setting") + ", " +
                    (plan.stop ? "up to " : "") + counted(plan.replicates, "replicate") +
                    (n == 1 ? "" : " each");
  if (job.shard.count > 1) {
    out += "; " + shard_text(job.shard) + " (from " + job.shard.origin + ")";
  }
  return out + "; in " + job.out;
}

int dry_run(const StudyPlan& plan, const StudyOptions& job) {
  check_directory_of(plan, job.out, job.force);
  std::cout << "would run " << plan_line(plan, job) << "\n";
  for (std::size_t s = 0; s < plan.settings.size(); ++s) {
    int here = 0;
    for (int r = 0; r < plan.replicates; ++r) {
      here += job.shard.holds(plan.id_of(static_cast<int>(s), r)) ? 1 : 0;
    }
    std::cout << "  " << s << "  " << plan.settings[s].label << ": " << (plan.stop ? "up to " : "")
              << counted(here, "run") << " of " << shortest(plan.settings[s].duration) << " s\n";
  }
  return Exit::done;
}

StudyResult run_with_progress(const Study& study, StudyOptions job, bool quiet, const Host& host) {
  Progress progress(quiet, host);
  job.begin = [&](int runs) {
    if (quiet) return;
    std::cerr << plan_line(study.plan(), job) << "; " << counted(runs, "run") << " to do\n";
  };
  progress.watch(job);
  return run_study(study, job);
}

/// What to print, and the exit code.
int finish(const StudyPlan& plan, const StudyResult& result, const StudyOptions& job,
           const FigureStyle& style, const Host& host) {
  if (job.shard.count > 1) {
    std::cerr << shard_text(job.shard)
              << (result.waiting ? " has done what it can: " : " is done: ")
              << counted(result.runs, "run") << " now\n";
    if (result.waiting) {
      std::cerr << "the stopping rule waits for rows of other shards; run every shard again\n";
      return Exit::stopped;
    }
    if (result.complete) {
      std::cerr << "all shards are done; lilytank study merge " << job.out << " makes the table\n";
    }
    return result.failed > 0 ? Exit::diverged : Exit::done;
  }
  const StoredStudy stored = load_study(job.out);
  write_table(stored, job.out);
  std::cout << report(stored, job.out, style, host) << std::flush;
  std::cerr << "study " << plan.name << " is complete; results in " << job.out << "\n";
  return result.failed > 0 ? Exit::diverged : Exit::done;
}

int run_one(const Arguments& arguments, const Host& host) {
  VerbOptions options("study", "STUDY.toml",
                      "Runs a study, or what is missing of it: every setting of its axes, many "
                      "replicates each.\nFurther words: lilytank study merge, status, report or "
                      "slurm, each with --help.");
  StudyOptions job;
  std::vector<std::string> sets;
  bool quiet = false;
  options.add({"set", "a value for every setting, as run.duration='1 h'", "PATH=VALUE"}, &sets);
  options.add_seed("where the seeds of the replicates come from, instead of study.seed", &sets);
  options.add({"out", "directory of the results (default: out/<name>)", "DIR"});
  options.add({"shard",
               "do part i of n, 1/n to n/n (default: from Slurm's or Open MPI's environment, else "
               "all)",
               "I/N"});
  job.threads = usual_threads();
  options.add(
      {"threads", "simulations at a time (default: SLURM_CPUS_PER_TASK, or one a core)", "N"},
      &job.threads, 1, kMostThreads);
  FigureStyle style;
  add_figure_options(options, style);
  options.add({"dry-run", "check everything, write nothing"});
  options.add({"force", "replace another study's files"}, &job.force);
  options.add({"quiet", "no progress"}, &quiet);
  if (!options.parse(arguments)) return Exit::done;
  const Study study(only_argument(options, "which study? write lilytank study STUDY.toml"), sets);
  job.out = options.out("out/" + study.plan().name);
  job.shard = shard_of(options);
  spare_read(options, files_of_study(job.out), study.inputs());
  if (options.has("dry-run")) return dry_run(study.plan(), job);
  return finish(study.plan(), run_with_progress(study, job, quiet, host), job, style, host);
}

/// This program's file, so that the script finds it on other machines with the same file system.
std::string own_path() {
  std::error_code problem;
  const auto path = std::filesystem::read_symlink("/proc/self/exe", problem);
  return problem ? "lilytank" : path.string();
}

int study_slurm(const Arguments& arguments) {
  VerbOptions options("study slurm", "STUDY.toml",
                      "Prints a script for sbatch that runs a study in shards.");
  SlurmJob job;
  job.shards = 8;
  options.add({"shards", "tasks of the job array (default: 8)", "N"}, &job.shards, 1, 100000);
  options.add({"cpus", "cores a task (default: 8)", "N"}, &job.cpus, 1, 4096);
  options.add({"time", "time limit of a task, as Slurm takes it (default: 04:00:00)", "TIME"},
              &job.time);
  options.add({"set", "as for lilytank study", "PATH=VALUE"}, &job.sets);
  options.add_seed("as for lilytank study", &job.sets);
  options.add({"out", "directory of the results (default: out/<name>)", "DIR"});
  if (!options.parse(arguments)) return Exit::done;
  job.study = only_argument(options, "which study? write lilytank study slurm STUDY.toml");
  if (job.study == kStandardInput)
    options.refuse("the script names a study file; standard input has no name");
  const Study study(job.study, job.sets);
  job.program = own_path();
  job.name = study.plan().name;
  job.out = options.out("out/" + job.name);
  std::cout << slurm_script(job) << std::flush;
  return Exit::done;
}

}  // namespace

std::string only_argument(const VerbOptions& options, const std::string& what) {
  const auto& words = options.positional();
  if (words.empty()) options.refuse(what);
  if (words.size() == 1) return words[0];
  const std::vector<std::string> further{"merge", "status", "report", "slurm"};
  options.refuse("one at a time, not '" + words[0] + "' and '" + words[1] + "'" +
                 did_you_mean(words[0], further));
}

void spare_read(const VerbOptions& options, const std::vector<std::string>& files,
                const std::vector<std::string>& inputs) {
  for (const std::string& file : files) options.spare_inputs("out", file, inputs);
}

int study_verb(const Arguments& arguments, const Host& host) {
  const std::string word = arguments.empty() ? "" : arguments[0];
  const Arguments rest(arguments.begin() + (arguments.empty() ? 0 : 1), arguments.end());
  if (word == "merge") return study_merge(rest);
  if (word == "status") return study_status(rest);
  if (word == "report") return study_report(rest, host);
  if (word == "slurm") return study_slurm(rest);
  return run_one(arguments, host);
}

}  // namespace lilytank::cli
