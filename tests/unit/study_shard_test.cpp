// Which part of a study a process takes.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "lilytank/error.hpp"
#include "lilytank/random.hpp"
#include "lilytank/study.hpp"

namespace lilytank {
namespace {

using Variables = std::map<std::string, std::string>;

Shard shard_in(const Variables& variables) {
  return shard_of_environment([&](const char* name) -> const char* {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  });
}

std::string text(const Shard& shard) {
  return std::to_string(shard.index + 1) + "/" + std::to_string(shard.count);
}

std::string refusal(const Variables& variables) {
  try {
    return text(shard_in(variables));
  } catch (const InputError& e) {
    return e.what();
  }
}

TEST(StudyShard, EveryRunIsInOneShardOfAny) {
  std::vector<std::string> ids;
  for (std::uint64_t i = 0; i < 3000; ++i) ids.push_back(hex(derived_seed(5, i)));
  for (const int n : {1, 2, 3, 5, 16}) {
    std::vector<int> sizes(static_cast<std::size_t>(n), 0);
    for (const std::string& id : ids) {
      int holders = 0;
      for (int i = 0; i < n; ++i) {
        if (!Shard{i, n, ""}.holds(id)) continue;
        ++holders, ++sizes[static_cast<std::size_t>(i)];
      }
      EXPECT_EQ(holders, 1) << id;
    }
    // Binomial: five standard deviations.
    const double mean = 3000.0 / n, deviation = std::sqrt(mean * (1 - 1.0 / n));
    for (const int size : sizes) EXPECT_NEAR(size, mean, 5 * deviation);
  }
}

TEST(StudyShard, AreWrittenFromOne) {
  EXPECT_EQ(text(shard_from("1/1")), "1/1");
  EXPECT_EQ(text(shard_from("2/5")), "2/5");
  EXPECT_EQ(shard_from("2/5").index, 1);
  for (const char* wrong : {"0/5", "6/5", "1/0", "-1/5", "1", "a/b", "1/", "/2", "1/2/3", ""}) {
    EXPECT_THROW(shard_from(wrong), InputError) << wrong;
  }
}

TEST(StudyShard, ComeFromTheEnvironment) {
  EXPECT_EQ(text(shard_in({})), "1/1");
  EXPECT_EQ(text(shard_in({{"SLURM_PROCID", "2"}, {"SLURM_NTASKS", "4"}})), "3/4");
  EXPECT_EQ(text(shard_in({{"OMPI_COMM_WORLD_RANK", "3"}, {"OMPI_COMM_WORLD_SIZE", "4"}})), "4/4");
  const Variables array{
      {"SLURM_ARRAY_TASK_ID", "7"}, {"SLURM_ARRAY_TASK_MIN", "3"}, {"SLURM_ARRAY_TASK_COUNT", "5"}};
  EXPECT_EQ(text(shard_in(array)), "5/5");
  EXPECT_EQ(shard_in(array).origin, "SLURM_ARRAY_TASK_ID");
  Variables steps = array;
  steps["SLURM_ARRAY_TASK_STEP"] = "2";
  EXPECT_EQ(text(shard_in(steps)), "3/5");
}

TEST(StudyShard, AnArrayComesBeforeItsOneProcess) {
  EXPECT_EQ(text(shard_in({{"SLURM_ARRAY_TASK_ID", "1"},
                           {"SLURM_ARRAY_TASK_COUNT", "2"},
                           {"SLURM_PROCID", "0"},
                           {"SLURM_NTASKS", "1"}})),
            "2/2");
}

TEST(StudyShard, ProcessesOfAnArraysTasksAreToldApart) {
  std::set<std::string> all;
  for (const char* task : {"0", "1"}) {
    for (const char* process : {"0", "1", "2"}) {
      all.insert(text(shard_in({{"SLURM_ARRAY_TASK_ID", task},
                                {"SLURM_ARRAY_TASK_COUNT", "2"},
                                {"SLURM_PROCID", process},
                                {"SLURM_NTASKS", "3"}})));
    }
  }
  EXPECT_EQ(all, (std::set<std::string>{"1/6", "2/6", "3/6", "4/6", "5/6", "6/6"}));
}

TEST(StudyShard, MpirunWithinAJobCountsItsOwnProcesses) {
  EXPECT_EQ(text(shard_in({{"SLURM_PROCID", "0"},
                           {"SLURM_NTASKS", "8"},
                           {"OMPI_COMM_WORLD_RANK", "5"},
                           {"OMPI_COMM_WORLD_SIZE", "8"}})),
            "6/8");
}

TEST(StudyShard, AScriptWithoutSrunIsTheWhole) {
  Variables script{{"SLURM_JOB_ID", "9"}, {"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "3"}};
  EXPECT_EQ(text(shard_in(script)), "1/1");
  script["SLURM_STEP_ID"] = "0";  // by srun
  EXPECT_EQ(text(shard_in(script)), "1/3");
}

TEST(StudyShard, AnEnvironmentWithoutSenseIsRefused) {
  EXPECT_EQ(refusal({{"SLURM_ARRAY_TASK_ID", "7"}, {"SLURM_ARRAY_TASK_COUNT", "3"}}),
            "the environment's SLURM_ARRAY_TASK_ID is part 8 of SLURM_ARRAY_TASK_COUNT=3; give "
            "--shard i/n");
  EXPECT_EQ(refusal({{"SLURM_ARRAY_TASK_ID", "7"}}),
            "SLURM_ARRAY_TASK_ID is set, but not SLURM_ARRAY_TASK_COUNT; give --shard i/n");
  EXPECT_EQ(refusal({{"SLURM_PROCID", "x"}, {"SLURM_NTASKS", "3"}}),
            "the environment's SLURM_PROCID='x' is not a whole number; give --shard i/n");
  EXPECT_EQ(refusal({{"SLURM_ARRAY_TASK_ID", "3"},
                     {"SLURM_ARRAY_TASK_COUNT", "3"},
                     {"SLURM_ARRAY_TASK_STEP", "2"}}),
            "the array's task numbers are not in equal steps; give --shard i/n");
}

TEST(StudyShard, SlurmScriptsQuoteWhatAShellWouldSplit) {
  SlurmJob job;
  job.program = "/opt/lily tank/lilytank";
  job.study = "it's.toml";
  job.sets = {"run.duration='1 h'"};
  job.name = "x", job.out = "out/x";
  job.shards = 5, job.cpus = 4, job.time = "1-12";
  const std::string script = slurm_script(job);
  EXPECT_TRUE(script.starts_with("#!/bin/bash\n"));
  for (const char* part :
       {"\n#SBATCH --array=0-4\n", "\n#SBATCH --cpus-per-task=4\n", "\n#SBATCH --time=1-12\n",
        "\n#SBATCH --requeue\n", "\n#SBATCH --signal=TERM@60\n",
        "--dependency=afterok:$job --kill-on-invalid-dep=yes", "\nexport SLURM_EXIT_ERROR=125",
        "'/opt/lily tank/lilytank' study 'it'\\''s.toml' --out out/x --set "
        "'run.duration='\\''1 h'\\''' --threads"}) {
    EXPECT_NE(script.find(part), std::string::npos) << part << "\n" << script;
  }
}

}  // namespace
}  // namespace lilytank
