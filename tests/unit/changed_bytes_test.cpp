// A byte that changes in a directory of results, or an end that is cut off, is named by whoever
// reads it, or changes nothing that comes out.
#include <gtest/gtest.h>

#include "lilytank/run.hpp"
#include "lilytank/search_run.hpp"
#include "support/search_functions.hpp"
#include "support/study_rig.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;
using Files = std::map<std::string, std::string>;

Files files_in(const TemporaryDirectory& here, const std::string& dir) {
  Files out;
  for (const auto& entry : fs::recursive_directory_iterator(here.path(dir))) {
    if (!entry.is_regular_file()) continue;
    const std::string name = entry.path().lexically_relative(here.path(dir)).string();
    out[name] = here.read(dir + "/" + name);
  }
  return out;
}

void put_back(const TemporaryDirectory& here, const std::string& dir, const Files& files) {
  fs::remove_all(here.path(dir));
  for (const auto& [name, content] : files) here.write(dir + "/" + name, content);
}

/// The files as they were, where something was written since.
void restore(const TemporaryDirectory& here, const std::string& dir, const Files& files) {
  for (const auto& [name, content] : files_in(here, dir)) {
    const auto found = files.find(name);
    if (found == files.end()) fs::remove(here.path(dir + "/" + name));
    if (found != files.end() && found->second != content)
      here.write(dir + "/" + name, found->second);
  }
  for (const auto& [name, content] : files) {
    if (!here.has(dir + "/" + name)) here.write(dir + "/" + name, content);
  }
}

/// Every byte of a file changed by itself, in a low or in a high bit, and cuts of its end. Of a
/// long file only some 400 bytes, spread evenly: resolved.toml, whose every byte is in the hash
/// that is compared.
std::vector<std::string> changes_of(const std::string& content) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < content.size(); i += 1 + content.size() / 4000 * 10) {
    std::string changed = content;
    changed[i] = static_cast<char>(changed[i] ^ (i % 2 == 0 ? 1 : 0x10));
    out.push_back(std::move(changed));
  }
  for (std::size_t length = 0; length < content.size(); length += 1 + content.size() / 30) {
    out.push_back(content.substr(0, length));
  }
  return out;
}

/// Changes every file of `dir` in every way, gives the directory to `read`, and expects a refusal
/// that is one line and names a file of the directory, or the files of `expected`.
void expect_named_or_harmless(const TemporaryDirectory& here, const std::string& dir,
                              const Files& stored, const Files& expected,
                              const std::function<void()>& read) {
  for (const auto& [name, content] : stored) {
    int believed = 0;
    put_back(here, dir, stored);
    for (const std::string& changed : changes_of(content)) {
      restore(here, dir, stored);
      here.write(dir + "/" + name, changed);
      try {
        read();
        Files left = files_in(here, dir);
        for (const auto& [file, text] : expected) {
          if (left[file] == text || (file == name && left[file] == changed)) continue;
          if (++believed < 4) ADD_FAILURE() << name << " was changed, and " << file << " differs";
        }
      } catch (const InputError& e) {
        const std::string what = e.what();
        EXPECT_EQ(what.find('\n'), std::string::npos) << what;
        EXPECT_NE(what.find(here.path(dir)), std::string::npos) << what;
      }
    }
    EXPECT_EQ(believed, 0) << name;
  }
}

class ChangedBytes : public testing::Test {
 protected:
  Scenario scenario(const std::string& format) const {
    return load_scenario({rig_.here.path("pair.toml")},
                         {"run.duration=1", "output.rate=4", "module.count=3",
                          "output.metrics_interval=0.5", "output.trajectory=\"" + format + "\""});
  }
  Files finished(const Scenario& scenario) const {
    fs::remove_all(rig_.here.path("run"));
    RunOptions options;
    options.out = rig_.here.path("run");
    run(scenario, options);
    return files_in(rig_.here, "run");
  }

  test::StudyRig rig_;
};

TEST_F(ChangedBytes, OfAFinishedRunAreNeverAnalysed) {
  for (const std::string format : {"binary", "csv"}) {
    const Files files = finished(scenario(format));
    const auto numbers = [&] {
      const StoredRun run = load_run(rig_.here.path("run"));
      return std::tuple(run.trajectory.time, run.trajectory.x, run.trajectory.y,
                        run.trajectory.theta, run.metrics_time, run.metrics_copies);
    };
    const auto expected = numbers();
    expect_named_or_harmless(rig_.here, "run", files, {}, [&] { EXPECT_EQ(numbers(), expected); });
  }
}

TEST_F(ChangedBytes, OfAFinishedRunAreNamedOrRestored) {
  for (const std::string format : {"binary", "csv"}) {
    const Scenario of = scenario(format);
    const Files files = finished(of);
    RunOptions options;
    options.out = rig_.here.path("run");
    expect_named_or_harmless(rig_.here, "run", files, files, [&] {
      EXPECT_TRUE(run(of, options).already_complete);
      for (const auto& [name, content] : files) EXPECT_EQ(rig_.here.read("run/" + name), content);
    });
    for (const auto& [name, content] : files) {
      put_back(rig_.here, "run", files);
      fs::remove(rig_.here.path("run/" + name));
      try {
        run(of, options);
        EXPECT_EQ(rig_.here.read("run/" + name), content) << name << " is missing and not restored";
      } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("run"), std::string::npos) << name;
      }
    }
  }
}

TEST_F(ChangedBytes, OfAStoppedRunNeverReachTheResumedOne) {
  for (const std::string format : {"binary", "csv"}) {
    const Scenario of = scenario(format);
    const Files expected = finished(of);
    fs::remove_all(rig_.here.path("run"));
    RunOptions options;
    options.out = rig_.here.path("run");
    const std::atomic<bool> stop = true;  // after the first frame
    options.stop = &stop;
    EXPECT_THROW(run(of, options), Stopped);
    const Files stored = files_in(rig_.here, "run");
    RunOptions resumed;
    resumed.out = rig_.here.path("run");
    expect_named_or_harmless(rig_.here, "run", stored, expected, [&] { run(of, resumed); });
  }
}

TEST_F(ChangedBytes, OfAStudyNeverReachItsTable) {
  const Study study = rig_.study(
      "[study]\nscenario = \"pair.toml\"\nreplicates = 2\n"
      "[[axis]]\nname = \"rules\"\noverlays = [\"sticky.toml\", \"loose.toml\"]\n",
      {"run.duration=0.5"});
  const std::string dir = rig_.here.path("out");
  StudyOptions options;
  options.out = dir;
  const auto go = [&] {
    run_study(study, options);
    write_table(load_study(dir, study.plan()), dir);
  };
  go();
  const Files files = files_in(rig_.here, "out");
  expect_named_or_harmless(rig_.here, "out", files, {{"table.csv", files.at("table.csv")}}, go);
}

TEST_F(ChangedBytes, OfASearchNeverReachItsResult) {
  SwarmOptions swarm;
  swarm.particles = 3, swarm.iterations = 2, swarm.noise = NoiseRule::none;
  const auto value = [](const Trial& trial) { return sphere(trial.point); };
  SearchRunOptions options;
  options.dir = rig_.here.path("search"), options.identity = "sphere", options.threads = 1;
  const auto go = [&] { run_search(make_swarm(box(2), swarm, 1), value, options); };
  go();
  const Files files = files_in(rig_.here, "search");
  const Files expected{{"evaluations.csv", files.at("evaluations.csv")}};
  expect_named_or_harmless(rig_.here, "search", files, expected, go);
}

}  // namespace
}  // namespace lilytank
