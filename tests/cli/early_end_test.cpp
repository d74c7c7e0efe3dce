// A run that ends by what happens in it is the beginning of the longer run, and ends at the same
// step after an interruption.
#include <gtest/gtest.h>
#include <signal.h>

#include "cli/process.hpp"
#include "cli/program.hpp"

namespace lilytank {
namespace {

class EarlyEndTest : public testing::Test {
 protected:
  EarlyEndTest() {
    lilytank_.here.write("pair.rules", kPairRules);
    lilytank_.here.write("pairs.toml",
                         "title = \"pairs\"\n[run]\nduration = 1500\n[module]\ncount = 15\n"
                         "[ruleset]\nfile = \"pair.rules\"\n[output]\nrate = 2\n");
  }

  Answer run(const std::string& out, const std::string& sets) const {
    return lilytank_("run pairs.toml --out " + out + " " + sets);
  }
  std::string read(const std::string& name) const { return lilytank_.here.read(name); }

  static std::string unquoted(const std::string& word) {
    return word.starts_with('\'') ? word.substr(1, word.size() - 2) : word;
  }
  /// Interrupts a run, resumes it, and compares its files with those of a whole one.
  void expect_same_when_resumed(const std::string& whole, const std::string& set) const {
    Process process(lilytank_.here.path(""),
                    {"run", "pairs.toml", "--out", "parts", "--set", unquoted(set)});
    const std::string poses = lilytank_.here.path("parts/trajectory.bin");
    process.await([&] {
      std::error_code gone;
      const auto size = std::filesystem::file_size(poses, gone);
      return !gone && size > 100;
    });
    const int code = process.end(SIGTERM);
    EXPECT_TRUE(code == 3 || code == 0) << code;
    const Answer rest = run("parts", "--set " + set);
    EXPECT_EQ(rest.code, 0) << rest.err;
    EXPECT_EQ(lilytank_.files("parts"), lilytank_.files(whole));
  }

  Program lilytank_;
};

TEST_F(EarlyEndTest, TheKthCopyEndsTheRunAtItsStep) {
  ASSERT_EQ(run("long", "").code, 0);
  const Answer third = run("third", "--set run.until_copies=3");
  ASSERT_EQ(third.code, 0) << third.err;
  EXPECT_NE(third.out.find("ended           3 of 7 copies completed at "), std::string::npos);
  EXPECT_NE(read("third/summary.json").find("\"ended\": \"3 of 7 copies completed at "),
            std::string::npos);
  const std::string events = read("third/events.csv");
  EXPECT_LT(events.size(), read("long/events.csv").size());
  EXPECT_TRUE(read("long/events.csv").starts_with(events));
  EXPECT_TRUE(events.ends_with(",3\n")) << "the last row is the third copy";
  // What ends early is what a run of that duration gives.
  const auto at = third.out.find("completed at ") + 13;
  const std::string time = third.out.substr(at, third.out.find(" s", at) - at);
  const Answer timed = run("timed", "--set run.duration=" + time);
  EXPECT_EQ(fingerprint_of(timed.out), fingerprint_of(third.out));
  EXPECT_EQ(read("timed/trajectory.bin"), read("third/trajectory.bin"));
  EXPECT_EQ(read("timed/metrics.csv"), read("third/metrics.csv"));
  EXPECT_EQ(run("third", "--set run.until_copies=3").out, third.out);  // finished already
  expect_same_when_resumed("third", "run.until_copies=3");
}

TEST_F(EarlyEndTest, AllPossibleCopiesEndTheRun) {
  const Answer all = run("all", "--set module.count=4 --set run.until=all_copies");
  ASSERT_EQ(all.code, 0) << all.err;
  EXPECT_NE(all.out.find("ended           2 of 2 copies completed at "), std::string::npos)
      << all.out;
}

TEST_F(EarlyEndTest, AMetricEndsTheRun) {
  const Answer few = run("few", "--set 'run.until_metric=singles <= 3'");
  ASSERT_EQ(few.code, 0) << few.err;
  EXPECT_NE(few.out.find("ended           singles <= 3 at "), std::string::npos) << few.out;
  const std::string metrics = read("few/metrics.csv");
  const std::string last = metrics.substr(metrics.rfind('\n', metrics.size() - 2) + 1);
  int column = 0;
  std::string singles;
  for (const char c : last) {
    if (c == ',')
      ++column;
    else if (column == 3)
      singles += c;
  }
  EXPECT_LE(std::stoi(singles), 3) << last;
  expect_same_when_resumed("few", "'run.until_metric=singles <= 3'");
  for (const char* wrong :
       {"singles", "singles < 3", "singles <= x", "size_16 >= 1", "single <= 2"}) {
    const Answer refused = run("x", std::string("--set 'run.until_metric=") + wrong + "'");
    EXPECT_EQ(refused.code, 2) << wrong;
    EXPECT_NE(refused.err.find("run.until_metric '"), std::string::npos) << refused.err;
  }
}

TEST_F(EarlyEndTest, TimeWithoutEventsEndsTheRun) {
  lilytank_.here.write("pair.rules", kPairRules.substr(0, kPairRules.find("part:")));
  lilytank_.here.write("pairs.toml",
                       "[run]\nduration = 3000\n[module]\ncount = 2\n"
                       "[ruleset]\nfile = \"pair.rules\"\n[output]\nrate = 2\n");
  const Answer quiet = run("quiet", "--set run.quiet_time=400");
  ASSERT_EQ(quiet.code, 0) << quiet.err;
  EXPECT_NE(quiet.out.find("ended           no event for 400 s at "), std::string::npos)
      << quiet.out;
  expect_same_when_resumed("quiet", "run.quiet_time=400");
}

TEST_F(EarlyEndTest, AConditionThatIsOffChangesNothing) {
  ASSERT_EQ(run("a", "--set run.duration=5").code, 0);
  ASSERT_EQ(run("b",
                "--set run.duration=5 --set run.until=end --set run.until_copies=0 "
                "--set run.quiet_time=0")
                .code,
            0);
  EXPECT_EQ(lilytank_.files("a"), lilytank_.files("b"));
  EXPECT_EQ(read("a/resolved.toml").find("until"), std::string::npos);
}

TEST_F(EarlyEndTest, ImpossibleConditionsAreRefused) {
  const Answer many = run("x", "--set run.until_copies=8");
  EXPECT_EQ(many.code, 2);
  EXPECT_NE(many.err.find("run.until_copies = 8, but 15 modules are enough for 7 copies"),
            std::string::npos)
      << many.err;
  const Answer none = run("x", "--set 'ruleset.file=\"\"' --set run.until=all_copies");
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.err.find("there is no ruleset.file"), std::string::npos) << none.err;
  lilytank_.here.write("study.toml",
                       "[study]\nname = \"s\"\nscenario = \"pairs.toml\"\nreplicates = 2\n");
  const Answer study = lilytank_("study study.toml --out x --set run.until_copies=3");
  EXPECT_EQ(study.code, 2);
  EXPECT_NE(study.err.find("run.until_copies ends single runs only"), std::string::npos)
      << study.err;
  EXPECT_FALSE(std::filesystem::exists(lilytank_.here.path("x")));
}

}  // namespace
}  // namespace lilytank
