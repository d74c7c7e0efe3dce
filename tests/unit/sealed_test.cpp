// What stands in sealed envelopes can be simulated, and is not what the catalogue has.
#include "diagnose/sealed.hpp"

#include <gtest/gtest.h>

#include "lilytank/model_parameter.hpp"

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
      for (const auto& [path, value] : e.effect.shape) {
        if (path == "forces.heterogeneous_module.module") {  // no number that can be varied
          EXPECT_TRUE(value >= 0 && value < tank.module.count) << value;
          continue;
        }
        const ModelParameter of = model_parameter(path);
        EXPECT_TRUE(of.low <= value && value <= of.high) << path << " " << value;
        others += value != parameter_value(tank, path) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(others, 200);
}

}  // namespace
}  // namespace lilytank
