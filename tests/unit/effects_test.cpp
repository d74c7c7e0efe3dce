// The catalogue of effects, as reports tell of it.
#include "diagnose/effects.hpp"

#include <gtest/gtest.h>

#include <set>

namespace lilytank {
namespace {

TEST(Effects, variantsOfOneNameAreToldApart) {
  std::set<std::pair<std::string, std::string>> told;
  for (const Effect& e : effect_catalogue(standard_model())) {
    EXPECT_TRUE(told.emplace(e.name, e.variant()).second) << e.name << " " << e.variant();
  }
  EXPECT_EQ(told.count({"pair_attraction", "strength, range = 0.012 m"}), 1U);
  EXPECT_EQ(told.count({"state_dependent_noise", "by_slip"}), 1U);
}

}  // namespace
}  // namespace lilytank
