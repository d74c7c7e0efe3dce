// Signals and kills at any moment: the same command goes on and ends in the same bytes. The moment
// depends on the machine, the result must not; nothing is asserted about time.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <thread>

#include "cli/process.hpp"
#include "cli/program.hpp"
#include "lilytank/run.hpp"

namespace lilytank {
namespace {

using Texts = std::vector<std::string>;

class InterruptionTest : public testing::Test {
 protected:
  InterruptionTest() {
    lilytank_.here.write("pair.rules", kPairRules);
    lilytank_.here.write("long.toml",
                         "title = \"long\"\n[run]\nduration = 1500\n[module]\ncount = 15\n"
                         "[ruleset]\nfile = \"pair.rules\"\n[output]\nrate = 2\n");
  }

  std::string path(const std::string& name) const { return lilytank_.here.path(name); }
  std::uintmax_t size(const std::string& name) const {
    std::error_code gone;
    const auto n = std::filesystem::file_size(path(name), gone);
    return gone ? 0 : n;
  }

  Process start(const Texts& arguments) const { return {path(""), arguments}; }

  /// Waits until a file is longer than `bytes` or the process has ended.
  void await(const Process& process, const std::string& file, std::uintmax_t bytes) const {
    process.await([&] { return size(file) > bytes; });
  }

  Program lilytank_;
};

TEST_F(InterruptionTest, TermStopsAndTheSameCommandGoesOn) {
  for (const std::string format : {"binary", "csv"}) {
    const std::string set = " --set output.trajectory=" + format;
    const std::string poses = format == "csv" ? "/trajectory.csv" : "/trajectory.bin";
    const Answer whole = lilytank_("run long.toml --out whole-" + format + set);
    ASSERT_EQ(whole.code, 0) << whole.err;
    const std::string out = "parts-" + format;
    Process run = start({"run", "long.toml", "--out", out, "--set", "output.trajectory=" + format});
    await(run, out + poses, 100);
    const int code = run.end(SIGTERM);
    EXPECT_TRUE(code == 3 || code == 0) << code;
    const Answer rest = lilytank_("run long.toml --out " + out + set);
    EXPECT_EQ(rest.code, 0) << rest.err;
    EXPECT_EQ(rest.out, whole.out);
    EXPECT_EQ(lilytank_.files(out), lilytank_.files("whole-" + format));
  }
}

TEST_F(InterruptionTest, KillsAtAnyMomentDoNoHarm) {
  const Answer whole = lilytank_("run long.toml --out whole");
  ASSERT_EQ(whole.code, 0) << whole.err;
  const Texts command{"run", "long.toml", "--out", "parts"};
  // Kills or ends the run once `file` is longer than `bytes`.
  const auto cut = [&](const std::string& file, std::uintmax_t bytes, int signal) {
    Process run = start(command);
    await(run, file, bytes);
    return run.end(signal);
  };
  start(command).end(SIGKILL);                           // most likely before there is anything
  EXPECT_NE(cut("parts/resolved.toml", 0, SIGKILL), 3);  // begun, no checkpoint
  cut("parts/trajectory.bin", 1000, SIGTERM);            // leaves a checkpoint
  for (int i = 0; i < 3; ++i)
    cut("parts/trajectory.bin", size("parts/trajectory.bin"), SIGKILL);  // beyond the checkpoint
  const Answer rest = lilytank_("run long.toml --out parts");
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(rest.out, whole.out);
  EXPECT_EQ(lilytank_.files("parts"), lilytank_.files("whole"));
}

// Many checkpoints, each one cut off by a kill at some moment of writing.
TEST_F(InterruptionTest, KillsBetweenFrequentCheckpointsDoNoHarm) {
  const Scenario scenario = load_scenario({path("long.toml")}, {});
  RunOptions options;
  options.out = path("whole");
  run(scenario, options);
  options.out = path("parts");
  options.checkpoint_seconds = 0;
  for (int i = 0; i < 5; ++i) {
    const std::string before = lilytank_.here.read("parts/checkpoint.bin");
    Process child([&] { run(scenario, options); });
    child.await([&] { return lilytank_.here.read("parts/checkpoint.bin") != before; });
    std::this_thread::sleep_for(std::chrono::milliseconds(7 * i));
    const bool complete = child.has_ended();
    child.end(SIGKILL);
    EXPECT_NE(lilytank_.here.read("parts/checkpoint.bin"), before);
    if (complete) break;  // a very fast machine
  }
  options.checkpoint_seconds = 20;
  const RunResult rest = run(scenario, options);
  EXPECT_TRUE(rest.resumed || rest.already_complete);
  auto parts = lilytank_.files("parts");
  std::erase_if(parts, [](const auto& file) {  // of the last kill, if nothing was left to write
    return file.first.starts_with(".lilytank-");
  });
  EXPECT_EQ(parts, lilytank_.files("whole"));
}

#ifdef LILYTANK_HAS_RENDER
TEST_F(InterruptionTest, WhatAKilledFilmLeftGoesWithTheNextOne) {
  if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "films need ffmpeg";
  ASSERT_EQ(lilytank_("run long.toml --set run.duration=30 --out a --quiet").code, 0);
  const auto left = [&] {
    std::vector<std::string> names = lilytank_.names("a");
    std::erase_if(names, [](const std::string& name) { return !name.starts_with(".lilytank-"); });
    return names.size();
  };
  Process film = start({"render", "a", "--size", "1080", "--speed", "0.1"});
  film.await([&] { return left() == 1; });
  EXPECT_EQ(film.end(SIGKILL), -SIGKILL);
  EXPECT_EQ(left(), 1u);
  EXPECT_FALSE(lilytank_.here.has("a/video.mp4"));
  const Answer next = lilytank_("render a --size 120 --speed 60 --quiet");
  EXPECT_EQ(next.code, 0) << next.err;
  EXPECT_EQ(left(), 0u);
}
#endif

TEST_F(InterruptionTest, OneProcessADirectory) {
  Process first = start({"run", "long.toml", "--out", "a", "--set", "run.duration=1e7"});
  await(first, "a/resolved.toml", 0);
  const Answer second = lilytank_("run long.toml --out a --set run.duration=1e7");
  first.end(SIGKILL);
  EXPECT_EQ(second.code, 2);
  EXPECT_EQ(second.err, "another process is at work in 'a'\n");
}

TEST_F(InterruptionTest, AStoppedRunSaysHowToGoOn) {
  const Scenario scenario = load_scenario({path("long.toml")}, {});
  std::atomic<bool> stop{true};
  RunOptions options;
  options.out = path("a");
  options.stop = &stop;
  try {
    run(scenario, options);
    ADD_FAILURE() << "was not stopped";
  } catch (const Stopped& stopped) {
    EXPECT_TRUE(std::string(stopped.what()).starts_with("stopped at 0 s of 1500 s; "))
        << stopped.what();
  }
  EXPECT_FALSE(lilytank_.here.has("a/summary.txt"));
  stop = false;
  const RunResult rest = run(scenario, options);
  EXPECT_EQ(rest.status, RunStatus::ok);
  EXPECT_TRUE(rest.resumed);
  EXPECT_EQ(rest.time, 1500);
  const RunResult again = run(scenario, options);
  EXPECT_TRUE(again.already_complete);
  EXPECT_EQ(again.fingerprint, rest.fingerprint);
  EXPECT_EQ(again.completion_times, rest.completion_times);
  RunOptions nowhere;
  EXPECT_EQ(run(scenario, nowhere).fingerprint, rest.fingerprint);
}

TEST_F(InterruptionTest, ACutFileIsNoticed) {
  const Scenario scenario = load_scenario({path("long.toml")}, {"run.duration=20"});
  std::atomic<bool> stop{true};
  RunOptions options;
  options.out = path("a");
  options.stop = &stop;
  EXPECT_THROW(run(scenario, options), Stopped);
  std::filesystem::resize_file(path("a/events.csv"), 3);
  EXPECT_THROW(run(scenario, options), InputError);
}

TEST_F(InterruptionTest, StoredRunsLoadWhileUnfinished) {
  const Scenario scenario = load_scenario({path("long.toml")}, {"run.duration=20"});
  RunOptions options;
  options.out = path("a");
  const RunResult result = run(scenario, options);
  const StoredRun stored = load_run(path("a"));
  EXPECT_EQ(stored.scenario.identity, scenario.identity);
  EXPECT_EQ(stored.trajectory.frames(), 41);  // two a second and the start
  EXPECT_EQ(stored.trajectory.time.back(), 20);
  EXPECT_EQ(stored.metrics_time, (std::vector<double>{0, 10, 20}));
  EXPECT_EQ(stored.metrics_copies.back(), result.copies);
  std::filesystem::remove(path("a/summary.txt"));
  std::filesystem::remove(path("a/checkpoint.bin"));
  EXPECT_EQ(load_run(path("a")).trajectory.frames(), 41);
}

}  // namespace
}  // namespace lilytank
