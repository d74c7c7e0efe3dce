// The program among small files, and what it refuses there.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "cli/program.hpp"
#include "support/study_rig.hpp"

namespace lilytank {

class RefusalTest : public testing::Test {
 protected:
  RefusalTest() {
    lilytank_.here.write("tiny.toml", kTiny);
    lilytank_.here.write("pair.rules", test::kPairRulesText);
    lilytank_.here.write("pair.toml", test::kPairScenario);
  }
  /// One line, exit code 2, no file other than before.
  void refused(const std::string& arguments, const std::string& message) const {
    const auto before = lilytank_.files();
    const Answer a = lilytank_(arguments);
    EXPECT_EQ(a.code, 2) << arguments;
    EXPECT_EQ(a.out, "") << arguments;
    EXPECT_EQ(a.err, message + "\n") << arguments;
    EXPECT_EQ(lilytank_.files(), before) << arguments;
  }
  Program lilytank_;
};

}  // namespace lilytank
