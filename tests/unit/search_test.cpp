// Particle swarms: what they find, and that they can be stopped anywhere.
#include "lilytank/search.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lilytank/error.hpp"

namespace lilytank {
namespace {

const SearchSpace kPlane{{"x", -5, 5}, {"y", -5, 5}};

double sphere(const std::vector<double>& p) {
  double sum = 0;
  for (const double x : p) sum += (x - 1) * (x - 1);
  return sum;
}

void run(Search& search) {
  for (auto trials = search.ask(); !trials.empty(); trials = search.ask()) {
    std::vector<double> values;
    for (const Trial& t : trials) values.push_back(sphere(t.point));
    search.tell(values);
  }
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

}  // namespace
}  // namespace lilytank
