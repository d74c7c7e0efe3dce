// Our CMA-ES beside pagmo 2's, where that is installed: as many evaluations to the same accuracy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "support/search_functions.hpp"

namespace lilytank {
namespace {

using Function = double (*)(const Point&);
constexpr int kAxes = 5, kBudget = 20000;
constexpr double kAccuracy = 1e-8;

struct Problem {
  Function function = nullptr;
  pagmo::vector_double fitness(const pagmo::vector_double& x) const { return {function(x)}; }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(kAxes, -5), pagmo::vector_double(kAxes, 5)};
  }
};

/// Evaluations until the accuracy is reached.
double own_evaluations(Function function, unsigned seed) {
  CmaEsOptions o;
  o.budget = kBudget, o.handle_uncertainty = false, o.final_evaluations = 0;
  const auto search = make_cma_es(box(kAxes), o, seed);
  carry_through(*search, [&](const Trial& t) { return function(t.point); });
  for (const IterationRecord& record : search->history()) {
    if (record.best < kAccuracy) return static_cast<double>(record.evaluations);
  }
  return kBudget;
}

double pagmo_evaluations(Function function, unsigned seed) {
  Problem problem;
  problem.function = function;
  pagmo::algorithm algorithm(pagmo::cmaes(1, -1, -1, -1, -1, 0.3, 0, 0, true, true));
  algorithm.set_seed(seed);
  pagmo::population population(pagmo::problem(problem), 8, seed);
  while (population.get_problem().get_fevals() < kBudget) {
    population = algorithm.evolve(population);
    if (population.champion_f()[0] < kAccuracy) break;
  }
  return static_cast<double>(population.get_problem().get_fevals());
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// Both are the same algorithm but for the negative weights and the sides of the box: the medians
// over 15 starts differ by less than a half.
TEST(CmaEsBesidePagmo, NeedsAsManyEvaluations) {
  const std::pair<const char*, Function> functions[] = {
      {"sphere", sphere}, {"ellipsoid", ellipsoid}, {"rosenbrock", rosenbrock}};
  for (const auto& [name, function] : functions) {
    std::vector<double> own, theirs;
    for (unsigned seed = 1; seed <= 15; ++seed) {
      own.push_back(own_evaluations(function, seed));
      theirs.push_back(pagmo_evaluations(function, seed));
    }
    EXPECT_LT(median(own), 1.5 * median(theirs)) << name;
    EXPECT_LT(median(own), kBudget) << name;
    RecordProperty(std::string(name) + "_own", std::to_string(median(own)));
    RecordProperty(std::string(name) + "_pagmo", std::to_string(median(theirs)));
  }
}

}  // namespace
}  // namespace lilytank
