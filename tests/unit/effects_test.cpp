// The catalogue of effects, as the force terms describe it and as reports show it.
#include "effects/effects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace lilytank {
namespace {

// Each name with the number of its variants; pairs of one range alternate.
using Names = std::vector<std::pair<std::string, int>>;

TEST(Effects, variantsOfOneNameAreToldApart) {
  std::set<std::pair<std::string, std::string>> told;
  for (const Effect& e : effect_catalogue(standard_model())) {
    EXPECT_TRUE(told.emplace(e.name, e.variant()).second) << e.name << " " << e.variant();
  }
  EXPECT_EQ(told.count({"pair_attraction", "strength, range = 0.012 m"}), 1U);
  EXPECT_EQ(told.count({"state_dependent_noise", "by_slip"}), 1U);
}

// Random draws of a diagnosis depend on the place in the catalogue: another order gives other
// results. New effects go to the end.
TEST(Effects, stayInTheirOrder) {
  const Names expected{{"pair_attraction", 1},    {"pair_repulsion", 1},
                       {"pair_attraction", 1},    {"pair_repulsion", 1},
                       {"pair_attraction", 1},    {"pair_repulsion", 1},
                       {"magnetic_dipole", 2},    {"latch_stick", 1},
                       {"lubrication", 1},        {"wake_shielding", 1},
                       {"wall_force", 2},         {"wall_layer", 1},
                       {"added_mass", 1},         {"magnus_lift", 1},
                       {"viscous_drag", 1},       {"rotational_drag", 1},
                       {"coriolis", 1},           {"body_force", 1},
                       {"flow_drift", 1},         {"local_flow", 6},
                       {"self_propulsion", 1},    {"spin_torque", 1},
                       {"mass_offset", 1},        {"heterogeneous_module", 1},
                       {"flow_pulsation", 1},     {"correlated_gusts", 4},
                       {"vortex_shedding", 2},    {"state_dependent_noise", 2},
                       {"heavy_tailed_kicks", 1}, {"lens_distortion", 1},
                       {"camera_tilt", 1},        {"contact_law", 1},
                       {"capture_distance", 1},   {"latch_failure", 1},
                       {"drag_patch", 6}};
  Names found;
  for (const Effect& e : effect_catalogue(standard_model())) {
    if (found.empty() || found.back().first != e.name) found.emplace_back(e.name, 0);
    found.back().second += 1;
  }
  EXPECT_EQ(found, expected);
}

const Parameter* named(const ForceTerm& term, std::string_view name) {
  const auto all = term.parameters();
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.name == name; });
  return at == all.end() ? nullptr : &*at;
}

TEST(Effects, areDescribedByTheirTermsParametersWithinTheBounds) {
  const std::set<std::string_view> variables{"position", "radius", "pair",   "slip", "heading",
                                             "spin",     "time",   "module", "lag"};
  for (const ForceTerm* term : force_library()) {
    for (const EffectDescription& d : term->effects()) {
      EXPECT_EQ(variables.count(d.variable), 1U) << term->name();
      EXPECT_FALSE(d.amplitudes[0].parameter.empty()) << term->name();
      for (const auto& [name, size] : d.amplitudes) {
        if (name.empty()) continue;
        const Parameter* p = named(*term, name);
        ASSERT_NE(p, nullptr) << term->name() << " " << name;
        EXPECT_TRUE(0 < size && size <= p->high) << term->name() << " " << name;
        EXPECT_EQ(p->standard, 0) << term->name() << " " << name;
        EXPECT_TRUE(!d.two_sided || p->low <= -size) << term->name() << " " << name;
      }
      for (const auto& [name, value, low, high, scanned_from] : d.held) {
        if (name.empty()) continue;
        const Parameter* p = named(*term, name);
        ASSERT_NE(p, nullptr) << term->name() << " " << name;
        EXPECT_TRUE(p->low <= value && value <= p->high) << term->name() << " " << name;
        if (low == high) continue;
        EXPECT_TRUE(p->low <= low && high <= p->high) << term->name() << " " << name;
        EXPECT_TRUE(0 < low && low <= value && value <= high) << term->name() << " " << name;
        EXPECT_TRUE(scanned_from == 0 || (low <= scanned_from && scanned_from < high));
      }
    }
  }
}

// What is measured directly needs a parameter to be put into.
TEST(Effects, thatAreEstimatedHaveTheParameterFor) {
  for (const Effect& e : effect_catalogue(standard_model())) {
    const auto kinds = [&](ParameterKind kind) {
      return std::count_if(e.held.begin(), e.held.end(),
                           [&](const HeldParameter& one) { return one.of->kind == kind; });
    };
    switch (e.estimated) {
      case Estimated::place:
        EXPECT_EQ(kinds(ParameterKind::place), 2) << e.name;
        EXPECT_EQ(e.held.size(), 3U) << e.name;
        break;
      case Estimated::gain_and_frequency:
        EXPECT_TRUE(parameter_of(*e.term, ParameterKind::phase)) << e.name;
        [[fallthrough]];
      case Estimated::slip_and_frequency:
        ASSERT_EQ(e.held.size(), 1U) << e.name;
        EXPECT_EQ(e.held[0].of->unit, "Hz") << e.name;
        break;
      case Estimated::module:
        EXPECT_TRUE(parameter_of(*e.term, ParameterKind::module)) << e.name;
        break;
      case Estimated::none:
        EXPECT_TRUE(e.scanned_from == 0 || e.held.size() == 1) << e.name;
    }
  }
}

}  // namespace
}  // namespace lilytank
