// A ready script for Slurm.
#include <filesystem>
#include <iostream>

#include "cli/study_verb.hpp"

namespace lilytank::cli {
namespace {

/// This program's file, so that the script finds it on other machines with the same file system.
std::string own_path() {
  std::error_code problem;
  const auto path = std::filesystem::read_symlink("/proc/self/exe", problem);
  return problem ? "lilytank" : path.string();
}

}  // namespace

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
  options.add({"out", "directory of the results (default: out/<name>)", "DIR"});
  if (!options.parse(arguments)) return Exit::done;
  job.study = only_argument(options, "which study? write lilytank study slurm STUDY.toml");
  const Study study(job.study, job.sets);
  job.program = own_path();
  job.name = study.plan().name;
  job.out = options.out("out/" + job.name);
  std::cout << slurm_script(job) << std::flush;
  return Exit::done;
}

}  // namespace lilytank::cli
