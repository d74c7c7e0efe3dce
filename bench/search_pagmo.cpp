// pagmo 2's particle swarm and CMA-ES on our objectives.
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/pso_gen.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "search_contestants.hpp"

namespace lilytank::bench {
namespace {

/// Counts evaluations: each is a replicate of its own.
struct Problem {
  const SearchObjective* objective = nullptr;
  std::int64_t* evaluations = nullptr;

  pagmo::vector_double fitness(const pagmo::vector_double& x) const {
    return {objective->value({x, (*evaluations)++})};
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    pagmo::vector_double low, high;
    for (const SearchAxis& axis : objective->space) {
      low.push_back(axis.low), high.push_back(axis.high);
    }
    return {low, high};
  }
};

/// The same, and pagmo is told of the noise: it evaluates remembered points again.
struct NoisyProblem : Problem {
  void set_seed(unsigned) {}
  bool has_set_seed() const { return true; }
};

SearchOutcome outcome_of(const pagmo::population& population, std::int64_t evaluations) {
  const auto values = population.get_f();
  std::size_t best = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i][0] < values[best][0]) best = i;
  }
  return {population.get_x()[best], values[best][0], evaluations};
}

template <class Algorithm, class Noisy>
SearchContestant contestant(const std::string& name, bool swarm) {
  const auto run = [swarm](const SearchObjective& objective, const SearchCase& what,
                           std::uint64_t seed) {
    std::int64_t evaluations = 0;
    Noisy problem;
    problem.objective = &objective, problem.evaluations = &evaluations;
    const auto axes = static_cast<double>(objective.space.size());
    const int size = swarm ? what.particles : std::max(5, 4 + static_cast<int>(3 * std::log(axes)));
    const auto once = static_cast<std::int64_t>(size);
    pagmo::population population(pagmo::problem(problem), static_cast<unsigned>(size),
                                 static_cast<unsigned>(seed));
    // With its memory on, generations one by one are one run; a generation of a noisy swarm costs
    // two evaluations a particle.
    Algorithm method = [&] {
      if constexpr (std::is_same_v<Algorithm, pagmo::cmaes>) {
        return pagmo::cmaes(1, -1, -1, -1, -1, 0.3, 0, 0, true, true);
      } else {
        return pagmo::pso_gen(1, 0.7298, 2.05, 2.05, 0.5, 5, 2, 4, true);
      }
    }();
    pagmo::algorithm algorithm(method);
    algorithm.set_seed(static_cast<unsigned>(seed));
    std::int64_t cost = once;
    while (evaluations + cost <= what.budget) {
      const std::int64_t before = evaluations;
      population = algorithm.evolve(population);
      if (evaluations == before) break;
      cost = evaluations - before;
    }
    return outcome_of(population, evaluations);
  };
  return {name, run};
}

}  // namespace

std::vector<SearchContestant> pagmo_contestants() {
  return {contestant<pagmo::pso_gen, Problem>("pagmo pso_gen", true),
          contestant<pagmo::pso_gen, NoisyProblem>("pagmo pso_gen, told of noise", true),
          contestant<pagmo::cmaes, Problem>("pagmo cmaes", false)};
}

}  // namespace lilytank::bench
