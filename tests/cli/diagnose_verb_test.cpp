// lilytank diagnose and prove from outside: what they refuse, and how.
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/program.hpp"

namespace lilytank {
namespace {

const std::string kTank = std::string(LILYTANK_SOURCE_DIR) + "/scenarios/experiments/tank.toml";

TEST(diagnoseVerb, refusesWithOneLine) {
  const Program lilytank;
  lilytank.here.write("latched.toml",
                      "[[recording]]\nfile = \"l.csv\"\nbody = \"lily\"\nlatches = \"on\"\n");
  lilytank.here.write("balls.toml", "[[recording]]\nfile = \"b.csv\"\nbody = \"ball\"\n");
  lilytank.here.write("l.csv", "frame,time,id,x,y,theta\n0,0,0,0,0,0\n1,0.1,0,0,0,0\n");
  lilytank.here.write("b.csv", "frame,time,id,x,y\n0,0,0,0,0\n1,0.1,0,0,0\n");
  const struct {
    std::string words, message;
  } cases[] = {
      {"diagnose", "of what? write lilytank diagnose EXPERIMENT.toml"},
      {"diagnose nowhere.toml", "nowhere.toml"},
      {"diagnose latched.toml", "was recorded with latches on"},
      {"diagnose balls.toml", "has no recording of body = \"lily\" that is not held out"},
      {"diagnose " + kTank + " --budget none", "--budget"},
      {"prove nowhere", "--out is for a new proof"},
      {"prove --worlds 0", "--worlds"},
  };
  for (const auto& c : cases) {
    const Answer a = lilytank(c.words + " --out x");
    EXPECT_EQ(a.code, 2) << c.words << "\n" << a.err;
    EXPECT_NE(a.err.find(c.message), std::string::npos) << c.words << "\n" << a.err;
    EXPECT_EQ(std::count(a.err.begin(), a.err.end(), '\n'), 1) << a.err;
    EXPECT_FALSE(lilytank.here.has("x")) << c.words;
  }
  const Answer unfinished = lilytank("prove nowhere");
  EXPECT_EQ(unfinished.code, 2);
  EXPECT_EQ(unfinished.err, "nowhere holds no finished proof: there is no key.txt\n");
}

}  // namespace
}  // namespace lilytank
