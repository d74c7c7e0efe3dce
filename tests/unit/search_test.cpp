// Particle swarms: what they find, and that they can be stopped anywhere.
#include "lilytank/search.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lilytank/error.hpp"
#include "support/search_functions.hpp"

namespace lilytank {
namespace {

const SearchSpace kPlane = box(2);

void run(Search& search) {
  carry_through(search, [](const Trial& t) { return sphere(t.point); });
}

TEST(Swarm, FindsTheLowestPointOfASphere) {
  for (const NoiseRule rule : {NoiseRule::none, NoiseRule::reevaluate, NoiseRule::ocba}) {
    SwarmOptions options;
    options.noise = rule;
    const auto search = make_swarm(kPlane, options, 1);
    run(*search);
    EXPECT_EQ(search->evaluations(), search->budget());
    EXPECT_LT(sphere(search->best().point), 1e-3) << name_of(rule);
  }
}

TEST(Swarm, GoesOnFromItsText) {
  const auto search = make_swarm(kPlane, {}, 1);
  run(*search);
  EXPECT_EQ(restore_search(search->save(), "saved")->save(), search->save());
}

TEST(CmaEs, FindsTheLowestPoints) {
  const std::pair<const char*, double (*)(const Point&)> functions[] = {
      {"sphere", sphere}, {"ellipsoid", ellipsoid}, {"rosenbrock", rosenbrock}};
  for (const auto& [name, function] : functions) {
    CmaEsOptions options;
    options.budget = 6000, options.handle_uncertainty = false, options.final_evaluations = 0;
    const auto search = make_cma_es(box(5), options, 1);
    carry_through(*search, [&, f = function](const Trial& t) { return f(t.point); });
    EXPECT_LT(search->best().mean, 1e-8) << name;
  }
}

}  // namespace
}  // namespace lilytank
