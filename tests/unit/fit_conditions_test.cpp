// The begin of the overlays that calibrate and diagnose write.
#include <gtest/gtest.h>

#include <map>

#include "calibrate/fit_conditions.hpp"
#include "lilytank/start.hpp"

namespace lilytank {
namespace {

using Values = std::map<std::string, double>;

Values conditions(const Model& model, BodyKind body, const std::vector<std::string>& fitted) {
  const FitConditions all = fit_conditions(model, body, fitted);
  return {all.begin(), all.end()};
}

TEST(FitConditions, AreTheBodiesTheTankAndTheStep) {
  Model m = standard_model();
  m.tank.radius = 0.25, m.module.draught = 0.025, m.ball.mass = 0.012;
  const Values lilies = conditions(m, BodyKind::lily, {});
  EXPECT_EQ(lilies.at("tank.radius"), 0.25);
  EXPECT_EQ(lilies.at("module.draught"), 0.025);
  EXPECT_EQ(lilies.at("run.dt"), 0.025);
  EXPECT_EQ(lilies.count("ball.mass"), 0u);
  const Values balls = conditions(m, BodyKind::ball, {});
  EXPECT_EQ(balls.at("ball.mass"), 0.012);
  EXPECT_EQ(balls.count("module.mass"), 0u);
}

// TOML refuses a key that is there twice: the overlay goes on with the estimates.
TEST(FitConditions, LeaveFittedKeysOut) {
  const Values values =
      conditions(standard_model(), BodyKind::lily, {"contact.friction", "module.mass"});
  EXPECT_EQ(values.count("contact.friction"), 0u);
  EXPECT_EQ(values.count("module.mass"), 0u);
  EXPECT_EQ(values.count("contact.restitution"), 1u);
}

TEST(FitConditions, StandInAnOverlayAfterItsComment) {
  const std::string text = begun_overlay("One.\n  Two.", {{"run.dt", 0.025}}, true).text();
  EXPECT_EQ(text, "# One.\n#   Two.\nrun.dt = 0.025\nflow.file = \"flow.csv\"\n");
}

}  // namespace
}  // namespace lilytank
