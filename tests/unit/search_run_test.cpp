// Searches in a directory: stopped, killed, taken up again, refused.
#include "lilytank/search_run.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>

#include "io/file_digest.hpp"
#include "lilytank/error.hpp"
#include "support/search_functions.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

constexpr const char* kFiles[] = {"search.state", "evaluations.csv", "history.csv"};

std::unique_ptr<Search> swarm(std::uint64_t seed = 1) {
  SwarmOptions options;
  options.particles = 6, options.iterations = 5, options.noise = NoiseRule::ocba;
  options.final_evaluations = 12;
  return make_swarm(box(2), options, seed);
}

double value(const Trial& trial) {
  return trial.replicate % 17 == 3 ? NAN : noisy(sphere(trial.point), trial, 0.3, 5);
}

SearchRunOptions in(const TemporaryDirectory& directory) {
  SearchRunOptions options;
  options.dir = directory.path("search"), options.identity = "sphere", options.threads = 2;
  return options;
}

/// What an uninterrupted run leaves.
std::vector<std::string> expected() {
  const TemporaryDirectory directory;
  const auto done = run_search(swarm(), value, in(directory));
  EXPECT_EQ(done.evaluated, done.search->budget());
  std::vector<std::string> out;
  for (const char* file : kFiles) out.push_back(directory.read(std::string("search/") + file));
  return out;
}

/// search.state as it is before the first evaluation.
std::string first_checkpoint() {
  const TemporaryDirectory directory;
  SearchRunOptions options = in(directory);
  const std::atomic<bool> stop{true};
  options.stop = &stop;
  EXPECT_THROW(run_search(swarm(), value, options), Stopped);
  return directory.read("search/search.state");
}

void expect_files(const TemporaryDirectory& directory, const std::vector<std::string>& files) {
  for (std::size_t f = 0; f < files.size(); ++f) {
    EXPECT_EQ(directory.read(std::string("search/") + kFiles[f]), files[f]) << kFiles[f];
  }
}

TEST(SearchRun, ListsEveryTrialAndIteration) {
  const auto files = expected();
  const auto lines = [](const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
  };
  EXPECT_EQ(lines(files[1]), 1 + 6 * 5 * 2 + 12);
  EXPECT_TRUE(files[1].starts_with("batch,trial,replicate,x0,x1,value,checksum\n1,1,0,"));
  EXPECT_EQ(lines(files[2]), 1 + 5 + 1);  // and the final selection
  EXPECT_TRUE(files[2].starts_with("iteration,evaluations,best,median,worst,spread,x0,x1\n1,12,"));
}

// The stop signal comes after every number of evaluations there is.
TEST(SearchRun, StoppedAnywhereItEndsWithTheSameBytes) {
  const auto files = expected();
  for (int most = 5; most < 72; most += 23) {
    const TemporaryDirectory directory;
    SearchRunOptions options = in(directory);
    std::atomic<bool> stop{false};
    options.stop = &stop;
    int calls = 0;
    for (bool stopped = true; stopped; ++calls) {
      ASSERT_LT(calls, 100);
      stop = false;
      std::atomic<int> evaluated{0};
      const Objective objective = [&](const Trial& trial) {
        if (++evaluated >= most) stop = true;
        return value(trial);
      };
      try {
        run_search(swarm(), objective, options);
        stopped = false;
      } catch (const Stopped&) {
      }
    }
    EXPECT_GE(calls, 72 / (most + 2));
    expect_files(directory, files);
  }
}

// A kill leaves the checkpoint of some batch and a log cut anywhere after it.
TEST(SearchRun, KilledAnywhereItEndsWithTheSameBytes) {
  const auto files = expected();
  const std::string state = first_checkpoint();
  for (std::size_t length = 0; length < files[1].size(); length += 797) {
    const TemporaryDirectory directory;
    directory.write("search/search.state", state);
    directory.write("search/evaluations.csv", files[1].substr(0, length));
    EXPECT_NO_THROW(run_search(swarm(), value, in(directory)));
    expect_files(directory, files);
  }
}

// Killed for good, by a signal that no process can catch, at moments that nobody chose.
TEST(SearchRun, SurvivesSigkill) {
  const TemporaryDirectory directory;
  for (int kill_after = 20; kill_after <= 80; kill_after += 20) {  // ms
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      run_search(
          swarm(),
          [](const Trial& trial) {
            ::usleep(3000);
            return value(trial);
          },
          in(directory));
      ::_exit(0);
    }
    ::usleep(static_cast<useconds_t>(1000 * kill_after));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
  }
  run_search(swarm(), value, in(directory));
  expect_files(directory, expected());
}

TEST(SearchRun, ThreadsChangeNoByte) {
  const auto files = expected();
  for (const int threads : {1, 5}) {
    const TemporaryDirectory directory;
    SearchRunOptions options = in(directory);
    options.threads = threads;
    run_search(swarm(), value, options);
    expect_files(directory, files);
  }
}

TEST(SearchRun, DoneIsDone) {
  const TemporaryDirectory directory;
  run_search(swarm(), value, in(directory));
  const auto again = run_search(
      swarm(),
      [](const Trial&) {
        ADD_FAILURE() << "evaluated again";
        return 0.0;
      },
      in(directory));
  EXPECT_EQ(again.evaluated, 0);
  EXPECT_EQ(again.search->evaluations(), again.search->budget());
}

TEST(SearchRun, RefusesAnotherSearchAndReplacesItWhenForced) {
  const TemporaryDirectory directory;
  SearchRunOptions options = in(directory);
  run_search(swarm(), value, options);
  EXPECT_THROW(run_search(swarm(2), value, options), InputError);
  options.identity = "another objective";
  EXPECT_THROW(run_search(swarm(), value, options), InputError);
  options.force = true;
  EXPECT_EQ(run_search(swarm(2), value, options).evaluated, 72);
}

TEST(SearchRun, RefusesChangedFiles) {
  const auto files = expected();
  const auto refused = [](const std::string& state, const std::string& log) {
    const TemporaryDirectory directory;
    directory.write("search/search.state", state);
    directory.write("search/evaluations.csv", log);
    try {
      run_search(swarm(), value, in(directory));
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  std::string state = files[0];
  state[state.size() / 2] ^= 1;
  EXPECT_NE(refused(state, files[1]).find("search.state"), std::string::npos);
  EXPECT_NE(refused(files[0], files[1].substr(0, files[1].size() / 2)).find("evaluations.csv"),
            std::string::npos);
  std::string other = files[1];
  const std::size_t begin = other.find("\n1,1,0,") + 1, end = other.find('\n', begin);
  std::string row = other.substr(begin, other.rfind(',', end) - begin);
  row.replace(0, 5, "1,1,9");
  other.replace(begin, end - begin, with_checksum(row));
  EXPECT_NE(refused(first_checkpoint(), other).find("another search"), std::string::npos);
  EXPECT_NE(refused("x", files[1]).find("another search"), std::string::npos);
}

TEST(SearchRun, PassesOnWhatAnEvaluationThrows) {
  const TemporaryDirectory directory;
  const auto broken = [](const Trial&) -> double { throw InputError("no such file"); };
  EXPECT_THROW(run_search(swarm(), broken, in(directory)), InputError);
  EXPECT_EQ(run_search(swarm(), value, in(directory)).evaluated, 72);
}

}  // namespace
}  // namespace lilytank
