// The begin of the overlays that calibrate and diagnose write.
#include <gtest/gtest.h>

#include "calibrate/fit_conditions.hpp"
#include "lilytank/start.hpp"

namespace lilytank {
namespace {

bool has(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

TEST(FitConditions, AreTheBodiesTheTankAndTheStep) {
  Model m = standard_model();
  m.tank.radius = 0.25, m.module.draught = 0.025, m.ball.mass = 0.012;
  const std::string lilies = fit_conditions(m, BodyKind::lily, {});
  for (const char* line : {"tank.radius = 0.25", "module.draught = 0.025", "run.dt = 0.025"}) {
    EXPECT_TRUE(has(lilies, line)) << line << "\n" << lilies;
  }
  EXPECT_EQ(lilies.find("ball."), std::string::npos);
  const std::string balls = fit_conditions(m, BodyKind::ball, {});
  EXPECT_TRUE(has(balls, "ball.mass = 0.012")) << balls;
  EXPECT_EQ(balls.find("module."), std::string::npos);
}

// TOML refuses a key that is there twice: the overlay goes on with the estimates.
TEST(FitConditions, LeaveFittedKeysOut) {
  const std::string text =
      fit_conditions(standard_model(), BodyKind::lily, {"contact.friction", "module.mass"});
  EXPECT_EQ(text.find("contact.friction ="), std::string::npos);
  EXPECT_EQ(text.find("module.mass"), std::string::npos);
  EXPECT_NE(text.find("contact.restitution ="), std::string::npos);
}

}  // namespace
}  // namespace lilytank
