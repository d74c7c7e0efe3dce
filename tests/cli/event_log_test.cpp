// The modules' event log beside a recording: how it is named, read and refused.
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/program.hpp"

namespace lilytank {
namespace {

// Two Lilies face to face for two seconds, and a log of what they reported.
void write_latched_experiment(const Program& lilytank, const std::string& log) {
  std::string rows = "frame,time,id,x,y,theta\n";
  for (int f = 0; f < 20; ++f) {
    const std::string when = std::to_string(f) + "," + std::to_string(0.1 * f);
    rows += when + ",0,0.0," + std::to_string(0.001 * f) + ",0\n";
    rows += when + ",1,0.035," + std::to_string(0.001 * f) + ",0\n";
  }
  lilytank.here.write("l.csv", rows);
  lilytank.here.write("log.csv", log);
  lilytank.here.write("e.toml",
                      "[module]\nside = 0.035\n[[recording]]\nfile = \"l.csv\"\n"
                      "events = \"log.csv\"\n");
}

TEST(eventLog, isCountedWithTheBondsThatPosesShow) {
  const Program lilytank;
  write_latched_experiment(lilytank, "time,kind,module_a,module_b\n0.1,latch,7,9\n0.4,link,9,7\n");
  const Answer a = lilytank("recording info e.toml");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_NE(a.out.find("  bonds     1 seen, on average 0.5 per module, 1 in the first frame\n"),
            std::string::npos)
      << a.out;
  EXPECT_NE(a.out.find("  events    2 in log.csv\n"), std::string::npos) << a.out;
  const Answer json = lilytank("recording info e.toml --json");
  EXPECT_NE(json.out.find("\"events\": 2"), std::string::npos) << json.out;
}

TEST(eventLog, isRefusedWithFileLineAndColumn) {
  const std::string head = "time,kind,module_a,module_b\n";
  const struct {
    std::string log, message;
  } cases[] = {
      {head + "0.1,latched,0,1\n", "log.csv:2:5: "},
      {head + "0.1,latch,1,1\n", "is module_a itself"},
      {head + "0.5,latch,0,1\n0.4,link,0,1\n", "log.csv:3:1: "},
      {head + "soon,latch,0,1\n", "log.csv:2:1: "},
      {"when,what\n", "log.csv:1"},
  };
  for (const auto& c : cases) {
    const Program lilytank;
    write_latched_experiment(lilytank, c.log);
    const Answer a = lilytank("diagnose e.toml --out x");
    EXPECT_EQ(a.code, 2) << c.log << a.err;
    EXPECT_NE(a.err.find(c.message), std::string::npos) << a.err;
    EXPECT_EQ(std::count(a.err.begin(), a.err.end(), '\n'), 1) << a.err;
  }
  const Program lilytank;
  write_latched_experiment(lilytank, head);
  lilytank.here.write("f.toml", "[[recording]]\nfile = \"l.csv\"\nevents = \"lgo.csv\"\n");
  const Answer a = lilytank("diagnose f.toml --out x");
  EXPECT_EQ(a.code, 2);
  EXPECT_NE(a.err.find("f.toml:3:10: cannot read 'lgo.csv'"), std::string::npos) << a.err;
}

}  // namespace
}  // namespace lilytank
