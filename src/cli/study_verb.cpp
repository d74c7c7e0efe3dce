#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "cli/dry_run.hpp"
#include "cli/progress.hpp"
#include "cli/study_verb.hpp"
#include "study/study_directory.hpp"
#include "text/number.hpp"

namespace lilytank::cli {
namespace {

Shard shard_of(const VerbOptions& options) {
  if (options.has("shard")) return shard_from(options.text("shard"));
  return shard_of_environment(std::getenv);
}

int threads_of(const VerbOptions& options) {
  if (options.has("threads")) return static_cast<int>(options.whole("threads", 0, 1, kMostThreads));
  const char* cpus = std::getenv("SLURM_CPUS_PER_TASK");
  const auto value = parse_whole(cpus == nullptr ? "" : cpus);
  return value && *value >= 1 && *value <= kMostThreads ? static_cast<int>(*value) : 0;
}

std::string shard_text(const Shard& shard) {
  return "shard " + std::to_string(shard.index + 1) + "/" + std::to_string(shard.count);
}

std::string plan_line(const StudyPlan& plan, const StudyOptions& job) {
  const auto n = plan.settings.size();
  std::string out = "study " + plan.name + ": " + std::to_string(n) +
                    (n == 1 ? " setting, " : " settings, ") + (plan.stop ? "up to " : "") +
                    std::to_string(plan.replicates) +
                    (plan.replicates == 1 ? " replicate" : " replicates") + (n == 1 ? "" : " each");
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
              << here << (here == 1 ? " run of " : " runs of ")
              << shortest(plan.settings[s].duration) << " s\n";
  }
  return Exit::done;
}

StudyResult run_with_progress(const Study& study, StudyOptions job, bool quiet) {
  Progress progress(quiet);
  job.begin = [&](int runs) {
    if (quiet) return;
    std::cerr << plan_line(study.plan(), job) << "; " << runs << (runs == 1 ? " run" : " runs")
              << " to do\n";
  };
  progress.watch(job);
  return run_study(study, job);
}

/// What to tell, and the exit code.
int finish(const StudyPlan& plan, const StudyResult& result, const StudyOptions& job) {
  if (job.shard.count > 1) {
    std::cerr << shard_text(job.shard)
              << (result.waiting ? " has done what it can: " : " is done: ") << result.runs
              << (result.runs == 1 ? " run" : " runs") << " now\n";
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
  std::cout << report(stored, job.out) << std::flush;
  std::cerr << "study " << plan.name << " is complete; results in " << job.out << "\n";
  return result.failed > 0 ? Exit::diverged : Exit::done;
}

int run_one(const Arguments& arguments) {
  VerbOptions options("study", "STUDY.toml",
                      "Runs a study, or what is missing of it: every setting of its axes, many "
                      "replicates each.\nFurther words: lilytank study merge, status, report or "
                      "slurm, each with --help.");
  options.add()("set", "a value for every setting, as run.duration='1 h'",
                cxxopts::value<std::vector<std::string>>(),
                "PATH=VALUE")("out", "directory of the results (default: out/<name>)",
                              cxxopts::value<std::string>(), "DIR")(
      "shard",
      "do part i of n, 1/n to n/n (default: from Slurm's or Open MPI's environment, else all)",
      cxxopts::value<std::string>(),
      "I/N")("threads", "simulations at a time (default: SLURM_CPUS_PER_TASK, or one a core)",
             cxxopts::value<std::string>(), "N")("dry-run", "check everything, write nothing")(
      "force", "replace another study's files")("quiet", "no progress");
  if (!options.parse(arguments)) return Exit::done;
  const Study study(only_argument(options, "which study? write lilytank study STUDY.toml"),
                    options.list("set"));
  StudyOptions job;
  job.out = study_directory(options, study.plan().name);
  job.shard = shard_of(options);
  job.threads = threads_of(options);
  job.force = options.has("force");
  spare_read(options, files_of_study(job.out), study.inputs());
  if (options.has("dry-run")) return dry_run(study.plan(), job);
  return finish(study.plan(), run_with_progress(study, job, options.has("quiet")), job);
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

std::string study_directory(const VerbOptions& options, const std::string& name) {
  const std::string out = options.text("out", (std::filesystem::path("out") / name).string());
  if (out.empty()) options.refuse("--out is empty");
  return out;
}

void spare_read(const VerbOptions& options, const std::vector<std::string>& files,
                const std::vector<std::string>& inputs) {
  for (const std::string& file : files) options.spare_inputs("out", file, inputs);
}

int study_verb(const Arguments& arguments) {
  const std::string word = arguments.empty() ? "" : arguments[0];
  const Arguments rest(arguments.begin() + (arguments.empty() ? 0 : 1), arguments.end());
  if (word == "merge") return study_merge(rest);
  if (word == "status") return study_status(rest);
  if (word == "report") return study_report(rest);
  if (word == "slurm") return study_slurm(rest);
  return run_one(arguments);
}

}  // namespace lilytank::cli
