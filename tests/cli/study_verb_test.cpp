// Studies end to end: one table, whatever the threads, the shards, their order and interruptions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "cli/process.hpp"
#include "cli/program.hpp"
#include "lilytank/random.hpp"
#include "support/study_rig.hpp"

namespace lilytank {
namespace {

/// A variable of the environment for as long as this lives.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) { ::setenv(name, value, 1); }
  ~Variable() { ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

class StudyVerbTest : public testing::Test {
 protected:
  StudyVerbTest() {
    for (const char* name : {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_PROCID",
                             "SLURM_NTASKS", "OMPI_COMM_WORLD_RANK", "SLURM_CPUS_PER_TASK"}) {
      ::unsetenv(name);  // the tests may themselves run within a job
    }
    lilytank_.here.write("pair.rules", kPairRules);
    lilytank_.here.write("pair.toml", test::kPairScenario);
    lilytank_.here.write("sticky.toml", "[rules]\npart.p = 0\n");
    lilytank_.here.write("study.toml", head("tiny") + "replicates = 6\n" + kAxes);
    lilytank_.here.write("rounds.toml", head("rounds") + kAxes +
                                            "[stop]\nmetric = \"copies\"\nhalf_width = 0.5\n"
                                            "min = 4\nmax = 16\nround = 3\n");
  }

  static std::string head(const std::string& name) {
    return "[study]\nname = \"" + name + "\"\nscenario = \"pair.toml\"\nseed = 4\n";
  }
  std::string table(const std::string& dir) const {
    return lilytank_.here.read(dir + "/table.csv");
  }
  /// The table of a study that nothing disturbed.
  std::string undisturbed(const std::string& study, const std::string& dir = "whole") const {
    const Answer whole = lilytank_("study " + study + " --threads 1 --quiet --out " + dir);
    EXPECT_EQ(whole.code, 0) << whole.err;
    return table(dir);
  }

  /// Finished rows in a directory, of a study that may be running: other files come and go.
  std::size_t rows(const std::string& dir) const {
    if (!lilytank_.here.has(dir)) return 0;
    std::size_t lines = 0;
    for (const auto& entry : std::filesystem::directory_iterator(lilytank_.here.path(dir))) {
      const std::string name = entry.path().filename().string();
      if (!name.starts_with("rows-")) continue;
      const std::string content = lilytank_.here.read(dir + "/" + name);
      const auto n = std::count(content.begin(), content.end(), '\n');
      lines += static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, n - 1));
    }
    return lines;
  }

  static inline const std::string kAxes =
      "[[axis]]\npath = \"module.count\"\nvalues = [4, 6]\n"
      "[[axis]]\npath = \"rules.part.p\"\nvalues = [0.02, 0.5]\n";
  Program lilytank_;
};

TEST_F(StudyVerbTest, EndToEnd) {
  const Answer dry = lilytank_("study study.toml --dry-run");
  EXPECT_EQ(dry.code, 0) << dry.err;
  EXPECT_NE(dry.out.find("4 settings, 6 replicates each; in out/tiny"), std::string::npos);
  EXPECT_FALSE(lilytank_.here.has("out"));

  const Answer first = lilytank_("study study.toml");
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("count=4, part.p=0.02"), std::string::npos) << first.out;
  EXPECT_NE(first.err.find("study tiny is complete; results in out/tiny"), std::string::npos);
  for (const char* name : {"study.toml", "rows-0001.csv", "table.csv", "summary.txt"}) {
    EXPECT_TRUE(lilytank_.here.has(std::string("out/tiny/") + name)) << name;
  }
  const std::string whole = table("out/tiny");
  EXPECT_EQ(std::count(whole.begin(), whole.end(), '\n'), 25);
  const auto files = lilytank_.files("out");

  const Answer again = lilytank_("study study.toml");  // nothing left to do
  EXPECT_EQ(again.code, 0);
  EXPECT_EQ(again.out, first.out);
  EXPECT_EQ(lilytank_.files("out"), files);

  const Answer status = lilytank_("study status study.toml");
  EXPECT_EQ(status.code, 0) << status.err;
  EXPECT_NE(status.out.find("4 settings, 24 of 24 runs, 0 diverged: complete"), std::string::npos)
      << status.out;
  EXPECT_EQ(lilytank_("study status out/tiny").out, status.out);
  const std::string json = lilytank_("study status out/tiny --json").out;
  EXPECT_TRUE(json.starts_with("{\n  \"name\": \"tiny\",\n  \"complete\": true,")) << json;
  EXPECT_NE(json.find("\"done\": 6,\n      \"wanted\": 6,"), std::string::npos) << json;
  EXPECT_EQ(lilytank_("study report out/tiny").out, first.out);
  EXPECT_EQ(lilytank_("study merge out/tiny").code, 0);
  EXPECT_EQ(lilytank_.files("out"), files);
}

TEST_F(StudyVerbTest, AnyNumberOfThreadsMakesTheSameTable) {
  const std::string whole = undisturbed("study.toml");
  for (int threads = 2; threads <= 8; ++threads) {
    const std::string n = std::to_string(threads);
    const Answer run = lilytank_("study study.toml --quiet --out t" + n + " --threads " + n);
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(table("t" + n), whole) << n;
  }
}

TEST_F(StudyVerbTest, ShardsInAnyOrderMakeTheSameTable) {
  const std::string whole = undisturbed("study.toml");
  const std::vector<std::vector<std::string>> orders{
      {"1/1"}, {"2/2", "1/2"}, {"4/5", "1/5", "5/5", "3/5", "2/5"}, {"1/5", "2/2", "3/5", "1/2"}};
  for (std::size_t i = 0; i < orders.size(); ++i) {
    const std::string dir = "s" + std::to_string(i);
    for (const std::string& shard : orders[i]) {
      const Answer run = lilytank_("study study.toml --out " + dir + " --shard " + shard);
      EXPECT_EQ(run.code, 0) << run.err;
    }
    EXPECT_EQ(rows(dir), 24u);  // nothing twice
    std::filesystem::remove(lilytank_.here.path(dir + "/table.csv"));
    const Answer merge = lilytank_("study merge " + dir);
    EXPECT_EQ(merge.code, 0) << merge.err;
    EXPECT_EQ(table(dir), whole);
  }
}

TEST_F(StudyVerbTest, AnUnfinishedStudyIsCalledSo) {
  EXPECT_EQ(lilytank_("study study.toml --out a --shard 2/2 --quiet").code, 0);
  const std::size_t n = rows("a");
  const Answer merge = lilytank_("study merge a");
  EXPECT_EQ(merge.code, 3);
  EXPECT_NE(merge.err.find("4 settings, " + std::to_string(n) + " of 24 runs"), std::string::npos)
      << merge.err;
  const Answer status = lilytank_("study status a");
  EXPECT_EQ(status.code, 0);
  EXPECT_EQ(status.out.find("complete"), std::string::npos);
}

TEST_F(StudyVerbTest, ShardsComeFromTheEnvironment) {
  const std::string whole = undisturbed("study.toml");
  for (const char* task : {"3", "5", "4"}) {
    const Variable id("SLURM_ARRAY_TASK_ID", task), least("SLURM_ARRAY_TASK_MIN", "3");
    const Variable count("SLURM_ARRAY_TASK_COUNT", "3"), cpus("SLURM_CPUS_PER_TASK", "2");
    const Answer run = lilytank_("study study.toml --out a");
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_NE(run.err.find("(from SLURM_ARRAY_TASK_ID)"), std::string::npos) << run.err;
  }
  EXPECT_EQ(rows("a"), 24u);
  EXPECT_EQ(lilytank_("study merge a").code, 0);
  EXPECT_EQ(table("a"), whole);
}

TEST_F(StudyVerbTest, AStoppingRuleMakesTheSameTableInShards) {
  const std::string whole = undisturbed("rounds.toml");
  EXPECT_GE(std::count(whole.begin(), whole.end(), '\n'), 17);
  EXPECT_LT(std::count(whole.begin(), whole.end(), '\n'), 65);
  EXPECT_EQ(lilytank_("study rounds.toml --quiet --out t --threads 5").code, 0);
  EXPECT_EQ(table("t"), whole);
  // A shard goes as far as the rows of the others let it, says so, and is run again.
  bool waited = false;
  for (int pass = 0; pass < 20; ++pass) {
    int done = 0;
    for (const char* shard : {"2/3", "3/3", "1/3"}) {
      const Answer run =
          lilytank_(std::string("study rounds.toml --quiet --out s --shard ") + shard);
      ASSERT_TRUE(run.code == 0 || run.code == 3) << run.err;
      if (run.code == 3) {
        waited = true;
        EXPECT_NE(run.err.find("the stopping rule waits for rows of other shards"),
                  std::string::npos);
      }
      done += run.code == 0;
    }
    if (done == 3) break;
  }
  EXPECT_TRUE(waited);
  EXPECT_EQ(lilytank_("study merge s").code, 0);
  EXPECT_EQ(table("s"), whole);
}

TEST_F(StudyVerbTest, KillsAtAnyMomentDoNoHarm) {
  const std::string set = " --set run.duration=60";
  ASSERT_EQ(lilytank_("study study.toml --quiet --out whole" + set).code, 0);
  for (std::uint32_t i = 0; i < 20; ++i) {
    // One more row than before, or none, and then some ms: any moment of a run or of writing.
    const std::size_t before = rows("parts");
    Process study(lilytank_.here.path(), {"study", "study.toml", "--out", "parts", "--set",
                                          "run.duration=60", "--threads", "2"});
    const auto draw = [&](std::uint32_t use) {
      return uniform({17, Stream::start_pose, 0, i, use});
    };
    if (i % 4 != 0) study.await([&] { return rows("parts") > before; });
    std::this_thread::sleep_for(std::chrono::microseconds(static_cast<int>(20000 * draw(0))));
    study.end(SIGKILL);
  }
  const Answer rest = lilytank_("study study.toml --quiet --out parts" + set);
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(table("parts"), table("whole"));
  EXPECT_EQ(lilytank_.here.read("parts/summary.txt"), lilytank_.here.read("whole/summary.txt"));
}

TEST_F(StudyVerbTest, TermStopsAndTheSameCommandGoesOn) {
  const std::string whole = undisturbed("study.toml --set run.duration=60");
  for (const int signal : {SIGTERM, SIGINT}) {
    const std::string dir = signal == SIGTERM ? "term" : "int";
    // The second setting of a long duration would take hours.
    lilytank_.here.write("long.toml", head("tiny") + "replicates = 6\n" +
                                          "[[axis]]\npath = \"run.duration\"\nvalues = [5, 1e7]\n");
    Process study(lilytank_.here.path(), {"study", "long.toml", "--out", dir, "--threads", "2"});
    study.await([&] { return rows(dir) >= 1; });
    EXPECT_EQ(study.end(signal), 3);
    const std::size_t kept = rows(dir);
    EXPECT_GE(kept, 1u);
    EXPECT_LE(kept, 6u);
    EXPECT_EQ(lilytank_("study status " + dir).code, 0);
    EXPECT_FALSE(lilytank_.here.has(dir + "/table.csv"));
  }
  Process study(lilytank_.here.path(), {"study", "study.toml", "--out", "parts", "--set",
                                        "run.duration=60", "--threads", "2"});
  study.await([&] { return rows("parts") >= 2; });
  const int code = study.end(SIGTERM);
  EXPECT_TRUE(code == 3 || code == 0) << code;
  const Answer rest = lilytank_("study study.toml --quiet --out parts --set run.duration=60");
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(table("parts"), whole);
}

TEST_F(StudyVerbTest, DivergedWorldsAreRowsAndTheExitCodeSaysSo) {
  const std::string command =
      "study study.toml --out a --set module.mass='0.1 g' --set forces.body_force.force_x=1";
  const Answer first = lilytank_(command);
  EXPECT_EQ(first.code, 1) << first.err;
  EXPECT_NE(table("a").find("diverged at 0 s (step 0): module "), std::string::npos);
  const Answer again = lilytank_(command);
  EXPECT_EQ(again.code, 1);
  EXPECT_EQ(again.out, first.out);
  EXPECT_EQ(rows("a"), 24u);
}

// LILYTANK_MANY_STARTS=200 for a long test.
TEST_F(StudyVerbTest, AnyNumberOfProcessesDoOneStudy) {
  const std::string whole = undisturbed("study.toml");
  const char* many = std::getenv("LILYTANK_MANY_STARTS");
  std::vector<std::unique_ptr<Process>> processes;
  for (int k = 0; k < (many == nullptr ? 12 : std::atoi(many)); ++k) {
    processes.push_back(std::make_unique<Process>(
        lilytank_.here.path(),
        std::vector<std::string>{"study", "study.toml", "--out", "a", "--quiet", "--threads", "1"},
        lilytank_.here.path("says-" + std::to_string(k))));
  }
  for (std::size_t k = 0; k < processes.size(); ++k) {
    processes[k]->await([] { return false; });
    EXPECT_EQ(processes[k]->end(0), 0) << lilytank_.here.read("says-" + std::to_string(k));
  }
  EXPECT_EQ(table("a"), whole);
  for (const std::string& name : lilytank_.names("a")) EXPECT_FALSE(name.starts_with(".")) << name;
}

TEST_F(StudyVerbTest, OfDifferentStudiesBegunTogetherOneOwnsTheDirectory) {
  lilytank_.here.write("other.toml", head("other") + "replicates = 2\n");
  for (int k = 0; k < 6; ++k) {
    const std::string out = "d" + std::to_string(k), force = k % 2 == 0 ? "--quiet" : "--force";
    const auto words = [&](const std::string& study) {
      return std::vector<std::string>{"study", study, "--out", out, "--threads", "1", force};
    };
    Process first(lilytank_.here.path(), words("study.toml"), lilytank_.here.path(out + "-1"));
    Process second(lilytank_.here.path(), words("other.toml"), lilytank_.here.path(out + "-2"));
    first.await([] { return false; }), second.await([] { return false; });
    const int codes[] = {first.end(0), second.end(0)};
    const std::string says = lilytank_.here.read(out + "-1") + lilytank_.here.read(out + "-2");
    // With --force the later one may come when the earlier one is done.
    if (k % 2 == 0) {
      EXPECT_EQ(codes[0] + codes[1], 2) << says;
    }
    EXPECT_TRUE(codes[0] == 0 || codes[1] == 0) << says;
    EXPECT_EQ(lilytank_("study status " + out).code, 0) << says;
  }
}

TEST_F(StudyVerbTest, SlurmScriptsAreReady) {
  const Answer script = lilytank_("study slurm study.toml --shards 5 --cpus 2 --time 00:10:00");
  EXPECT_EQ(script.code, 0) << script.err;
  for (const char* part : {"#SBATCH --array=0-4\n", "#SBATCH --cpus-per-task=2\n",
                           "#SBATCH --requeue\n", "#SBATCH --signal=TERM@60\n", "study study.toml",
                           "--out out/tiny", "study merge out/tiny"}) {
    EXPECT_NE(script.out.find(part), std::string::npos) << part;
  }
  lilytank_.here.write("study.sbatch", script.out);
  EXPECT_EQ(std::system(("bash -n '" + lilytank_.here.path("study.sbatch") + "'").c_str()), 0);
  EXPECT_FALSE(lilytank_.here.has("out"));
}

TEST_F(StudyVerbTest, WhatIsNobodysIsNotReplaced) {
  const std::string choose = "; choose another --out, or --force to replace it\n";
  for (const std::string name : {"table.csv", "summary.txt", "yield.png", "survival_12.svg"}) {
    lilytank_.here.write(name + ".d/" + name, "mine\n");
    const Answer a = lilytank_("study study.toml --out " + name + ".d");
    EXPECT_EQ(a.code, 2);
    EXPECT_EQ(a.err,
              "'" + name + ".d' holds a file '" + name + "' that is not of a study" + choose);
    EXPECT_EQ(lilytank_.names(name + ".d"), std::vector<std::string>{name});
  }
  ASSERT_EQ(lilytank_("run pair.toml --out r --quiet").code, 0);
  const auto before = lilytank_.files("r");
  const Answer a = lilytank_("study study.toml --out r");
  EXPECT_EQ(a.code, 2);
  EXPECT_EQ(a.err, "'r' holds a run" + choose);
  EXPECT_EQ(lilytank_.files("r"), before);
  EXPECT_EQ(lilytank_("study study.toml --out r --quiet --force").code, 0);
  EXPECT_EQ(lilytank_("study study.toml --out r --quiet").code, 0);  // it is the study's now
}

TEST_F(StudyVerbTest, WhatIsReadIsSpared) {
  lilytank_.here.write("w/survival.csv", kPairRules);
  lilytank_.here.write("under.toml", "base = \"pair.toml\"\nruleset.file = \"w/survival.csv\"\n");
  lilytank_.here.write("over.toml", "[study]\nscenario = \"under.toml\"\nreplicates = 2\n");
  for (const char* force : {"", " --force"}) {
    const Answer a = lilytank_(std::string("study over.toml --out w") + force);
    EXPECT_EQ(a.code, 2);
    EXPECT_EQ(a.err,
              "lilytank study: --out would overwrite 'w/survival.csv', which is read; choose "
              "another name\n");
  }
  EXPECT_EQ(lilytank_.names("w"), std::vector<std::string>{"survival.csv"});
}

TEST_F(StudyVerbTest, ForceLeavesNothingOfAnother) {
  lilytank_.here.write("counts.toml", head("counts") + "replicates = 2\n" +
                                          "[[axis]]\npath = \"module.count\"\nvalues = [4, 6]\n");
  ASSERT_EQ(lilytank_("study counts.toml --out a --quiet").code, 0);
  std::vector<std::string> only{"a/survival.csv"};  // that a shard does not make anew
#ifdef LILYTANK_HAS_RENDER
  only = {"a/survival_3.png", "a/mean_time.svg"};
#endif
  for (const std::string& name : only) EXPECT_TRUE(lilytank_.here.has(name)) << name;
  lilytank_.here.write("a/notes.txt", "mine\n");
  lilytank_.here.write("a/survival_of_the_fittest.png", "mine\n");
  const std::string two = "study study.toml --out a --quiet --set run.duration=2 --force";
  lilytank_.here.write("study.toml", head("two") + "replicates = 2\n" +
                                         "[[axis]]\npath = \"rules.part.p\"\n"
                                         "values = [0.1, 0.2]\nlabels = [\"a\", \"b\"]\n");
  EXPECT_EQ(lilytank_(two + " --shard 1/2").code, 0);
  for (const std::string& name : only) EXPECT_FALSE(lilytank_.here.has(name)) << name;
  EXPECT_TRUE(lilytank_.here.has("a/notes.txt"));
  EXPECT_TRUE(lilytank_.here.has("a/survival_of_the_fittest.png"));
}

TEST_F(StudyVerbTest, Mistakes) {
  undisturbed("study.toml", "taken");
  lilytank_.here.write("file", "");
  const auto before = lilytank_.files();
  const std::vector<std::pair<std::string, std::string>> mistakes{
      {"study", "lilytank study: which study? write lilytank study STUDY.toml"},
      {"study mrege taken",
       "lilytank study: one at a time, not 'mrege' and 'taken' - did you mean 'merge'?"},
      {"study none.toml", "cannot read 'none.toml': No such file or directory"},
      {"study study.toml --shrad 1/2",
       "lilytank study: unknown option '--shrad' - did you mean '--shard'?"},
      {"study study.toml --shard 0/2", "--shard 0/2: shards are 1/n to n/n, with n up to 1000000"},
      {"study study.toml --shard 2", "--shard 2 is not of the form i/n, as 2/5"},
      {"study study.toml --threads 0", "lilytank study: --threads 0 is outside 1 .. 4096"},
      {"study study.toml --set module.count=3",
       "--set module.count=3: 'module.count' is an axis of the study, see study.toml:6:1"},
      {"study study.toml --out file", "'file' is a file; the results need a directory"},
      {"study study.toml --out taken --set run.duration=7",
       "'taken' holds another study ('tiny', 4 settings, other scenarios, axes or seed); choose "
       "another --out, or --force to replace it"},
      {"study merge",
       "lilytank study merge: which study? write the directory of its results, or "
       "its STUDY.toml"},
      {"study merge none", "cannot read 'none': No such file or directory"},
      {"study merge .", "'./study.toml' was not written by a study's run: is it a study file?"},
      {"study study.toml --force --out .",
       "'./study.toml' is not of a study's results and would be overwritten; choose another "
       "--out"},
      {"study slurm study.toml --time soon",
       "lilytank study slurm: --time soon is not of Slurm's form, as 04:00:00 or 1-12"},
  };
  for (const auto& [arguments, message] : mistakes) {
    const Answer outcome = lilytank_(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(outcome.err, message + "\n") << arguments;
    EXPECT_EQ(lilytank_.files(), before) << arguments;
  }
}

}  // namespace
}  // namespace lilytank
