// What a run left is read as far as the run came, and no less.
#include <gtest/gtest.h>

#include "lilytank/run.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

class LoadRun : public testing::Test {
 protected:
  LoadRun() {
    here_.write("long.toml", "[module]\ncount = 15\n[output]\nrate = 2\nmetrics_interval = 10\n");
  }
  std::string path(const std::string& name) const { return here_.path(name); }

  TemporaryDirectory here_;
};

// What a finished run wrote is read whole or not at all; what a killed one wrote is read up to its
// last whole frame.
TEST_F(LoadRun, CutPosesAreNotTakenForTheWholeRun) {
  const auto complaint = [&](const std::string& dir) -> std::string {
    try {
      load_run(path(dir));
    } catch (const InputError& e) {
      const std::string what = e.what();
      EXPECT_EQ(what.find('\n'), std::string::npos);
      return what.substr(what.rfind('/') + 1);
    }
    return "(accepted)";
  };
  for (const std::string format : {"csv", "binary"}) {
    const std::string dir = "a" + format;
    const Scenario scenario = load_scenario(
        {path("long.toml")}, {"run.duration=20", "output.trajectory=\"" + format + "\""});
    RunOptions options;
    options.out = path(dir);
    run(scenario, options);
    const std::string name = format == "csv" ? "trajectory.csv" : "trajectory.bin";
    const std::string file = path(dir + "/" + name);
    const auto size = std::filesystem::file_size(file);
    ASSERT_EQ(complaint(dir), "(accepted)");
    std::filesystem::resize_file(file, size - 5);
    EXPECT_EQ(complaint(dir), name + ": the file is cut: " + std::to_string(size - 5) + " of " +
                                  std::to_string(size) +
                                  " bytes; run the scenario again with --force");
    here_.write(dir + "/checkpoint.bin", "of another version");
    EXPECT_EQ(complaint(dir), name +
                                  ": the file is cut: it ends at 19.5 s, and the run's summary "
                                  "says that it came to 20 s");
    std::filesystem::remove(path(dir + "/checkpoint.bin"));
    std::filesystem::remove(path(dir + "/summary.json"));
    EXPECT_EQ(load_run(path(dir)).trajectory.frames(), 40);
    // Within the first frame.
    std::filesystem::resize_file(file, 150);
    EXPECT_EQ(complaint(dir), name + ": there is no frame in it yet");
  }
}

TEST_F(LoadRun, CutMetricsAreNotTakenForTheWholeRun) {
  const Scenario scenario = load_scenario({path("long.toml")}, {"run.duration=20"});
  RunOptions options;
  options.out = path("a");
  run(scenario, options);
  const std::string file = path("a/metrics.csv");
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1);
  EXPECT_THROW(load_run(path("a")), InputError);
}

TEST_F(LoadRun, MetricsWithoutTheirFirstColumnsAreRefused) {
  RunOptions options;
  options.out = path("a");
  run(load_scenario({path("long.toml")}, {"run.duration=20"}), options);
  here_.write("a/checkpoint.bin", "of another version");
  here_.write("a/metrics.csv", "time\n0\n");
  try {
    load_run(path("a"));
    ADD_FAILURE() << "accepted";
  } catch (const InputError& e) {
    const std::string what = e.what();
    EXPECT_TRUE(
        what.ends_with("metrics.csv:1:1: the first line does not begin with \"time,copies,\""))
        << what;
  }
}

}  // namespace
}  // namespace lilytank
