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
  options.add()("shards", "tasks of the job array (default: 8)", cxxopts::value<std::string>(),
                "N")("cpus", "cores a task (default: 8)", cxxopts::value<std::string>(), "N")(
      "time", "time limit of a task, as Slurm takes it (default: 04:00:00)",
      cxxopts::value<std::string>(),
      "TIME")("set", "as for lilytank study", cxxopts::value<std::vector<std::string>>(),
              "PATH=VALUE")("out", "directory of the results (default: out/<name>)",
                            cxxopts::value<std::string>(), "DIR");
  if (!options.parse(arguments)) return Exit::done;
  SlurmJob job;
  job.study = only_argument(options, "which study? write lilytank study slurm STUDY.toml");
  job.sets = options.list("set");
  const Study study(job.study, job.sets);
  job.program = own_path();
  job.name = study.plan().name;
  job.out = study_directory(options, job.name);
  job.shards = static_cast<int>(options.whole("shards", 8, 1, 100000));
  job.cpus = static_cast<int>(options.whole("cpus", 8, 1, 4096));
  job.time = options.text("time", job.time);
  std::cout << slurm_script(job) << std::flush;
  return Exit::done;
}

}  // namespace lilytank::cli
