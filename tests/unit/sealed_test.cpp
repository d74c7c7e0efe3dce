// What stands in sealed envelopes can be simulated, and is not what the catalogue has.
#include "proof/sealed.hpp"

#include <gtest/gtest.h>

#include <set>

#include "lilytank/calibration.hpp"
#include "lilytank/model_parameter.hpp"
#include "proof/proof_tank.hpp"

namespace lilytank {
namespace {

TEST(Sealed, effectsHaveOtherNumbersThanTheCatalogueWithinTheirBounds) {
  const Model tank = tank_model();
  const auto effects = effect_catalogue(tank);
  const auto shapes = shape_catalogue(tank, 60);
  int others = 0;
  for (int world = 0; world < 400; ++world) {
    for (const SealedEffect& e : seal(tank, effects, shapes, 5, world).effects) {
      if (e.like < 0) continue;
      EXPECT_EQ(e.effect.name, effects[static_cast<std::size_t>(e.like)].name);
      for (const auto& [of, value] : e.effect.held) {
        const std::string path = of.path();
        if (of->kind == ParameterKind::module) {  // no number that can be varied
          EXPECT_TRUE(value >= 0 && value < tank.module.count) << value;
          continue;
        }
        EXPECT_TRUE(of->low <= value && value <= of->high) << path << " " << value;
        others += value != parameter_value(tank, path) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(others, 200);
}

TEST(Sealed, effectsOfASmallerSizeAreTheSameOnesWeaker) {
  const Model tank = tank_model();
  const auto shapes = shape_catalogue(tank, 60);
  ProofOptions options;
  options.worlds = 16;
  const std::vector<Sealed> full = requested(options, tank, shapes, 5);
  options.sizes = 0.25;
  const std::vector<Sealed> weak = requested(options, tank, shapes, 5);
  for (std::size_t w = 0; w < full.size(); ++w) {
    EXPECT_EQ(weak[w].names, full[w].names);
    for (std::size_t e = 0; e < full[w].effects.size(); ++e) {
      const std::vector<double>& of = full[w].effects[e].amplitudes;
      for (std::size_t k = 0; k < of.size(); ++k) {
        EXPECT_EQ(weak[w].effects[e].amplitudes[k], 0.25 * of[k]);
      }
    }
  }
}

// Every seed has a tank of its own, as strong as tanks are, with parameters that a calibration
// finds.
TEST(Sealed, drawnTanksDiffer) {
  const Model built_in = tank_model();
  std::set<std::string> keys;
  double strongest = 0, weakest = 9;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const DrawnTank drawn = drawn_tank(seed);
    keys.insert(key_text(drawn));
    const double strength = drawn.water.strength();
    strongest = std::max(strongest, strength), weakest = std::min(weakest, strength);
    const Model tank = tank_model(drawn);
    EXPECT_EQ(tank.flow.K_v, 1);
    for (const FitParameter& p : standard_parameters(BodyKind::lily)) {
      const double share = parameter_value(tank, p.path) / parameter_value(built_in, p.path);
      EXPECT_TRUE(share > 0.79 && share < 1.26) << p.path << " " << share;
    }
    const FlowSample here = tank.field->at(0.13, 0.02), there = built_in.field->at(0.13, 0.02);
    EXPECT_NE(here.mu_x, there.mu_x);
  }
  EXPECT_EQ(keys.size(), 40u);
  EXPECT_LT(weakest, 0.8);
  EXPECT_GT(strongest, 1.2);
  EXPECT_LT(strongest, 1.45);
  EXPECT_GT(weakest, 0.55);
}

}  // namespace
}  // namespace lilytank
