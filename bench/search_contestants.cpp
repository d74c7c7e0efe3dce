#include "search_contestants.hpp"

#include <algorithm>

namespace lilytank::bench {
namespace {

SearchOutcome carry_through(std::unique_ptr<Search> search, const SearchObjective& objective) {
  for (auto trials = search->ask(); !trials.empty(); trials = search->ask()) {
    std::vector<double> values;
    for (const Trial& trial : trials) values.push_back(objective.value(trial));
    search->tell(values);
  }
  const Incumbent best = search->best();
  return {best.point, best.mean, search->evaluations()};
}

/// `final_share`: of the budget, for the final selection.
SearchContestant swarm(const std::string& name, const SwarmOptions& options,
                       double final_share = 0) {
  const auto run = [=](const SearchObjective& objective, const SearchCase& what,
                       std::uint64_t seed) {
    SwarmOptions o = options;
    const auto budget = static_cast<int>(what.budget);
    o.particles = what.particles;
    o.final_evaluations = static_cast<int>(final_share * budget);
    o.iterations = std::max(1, (budget - o.final_evaluations) / (o.particles * o.evaluations));
    return carry_through(make_swarm(objective.space, o, seed), objective);
  };
  return {name, run};
}

SearchContestant cma_es(const std::string& name, const CmaEsOptions& options, double final_share) {
  const auto run = [=](const SearchObjective& objective, const SearchCase& what,
                       std::uint64_t seed) {
    CmaEsOptions o = options;
    o.budget = what.budget;
    o.final_evaluations = static_cast<int>(final_share * static_cast<double>(what.budget));
    return carry_through(make_cma_es(objective.space, o, seed), objective);
  };
  return {name, run};
}

/// Every neighbourhood and noise rule, and what the final selection adds to the best rule.
std::vector<SearchContestant> swarms() {
  std::vector<SearchContestant> out;
  for (const auto whom : {Neighbourhood::global, Neighbourhood::ring, Neighbourhood::von_neumann}) {
    SwarmOptions o;
    o.neighbourhood = whom;
    const std::string name = "swarm " + name_of(whom) + " ";
    for (const auto rule : {NoiseRule::none, NoiseRule::reevaluate, NoiseRule::ocba}) {
      o.noise = rule;
      out.push_back(swarm(name + name_of(rule), o));
    }
    out.push_back(swarm(name + "ocba, final", o, 0.1));
  }
  return out;
}

/// The paper's own, other weights, common random numbers.
std::vector<SearchContestant> variants() {
  std::vector<SearchContestant> out;
  out.push_back(swarm("paper, averaged twice", swarm_preset("paper-rulesets")));
  out.push_back(swarm("paper, bests re-evaluated", swarm_preset("paper-lilies")));
  SwarmOptions o;
  o.common_random_numbers = true;
  out.push_back(swarm("swarm global ocba, final, common", o, 0.1));
  // Clerc and Kennedy's weights [IEEE Trans. Evolutionary Computation 6 (1), 2002].
  o = {}, o.inertia = 0.7298, o.personal = o.neighbour = 1.49618;
  out.push_back(swarm("swarm global ocba, final, w 0.7298", o, 0.1));
  return out;
}

}  // namespace

std::vector<SearchContestant> own_contestants() {
  std::vector<SearchContestant> out = swarms();
  for (const SearchContestant& c : variants()) out.push_back(c);
  CmaEsOptions o;
  o.handle_uncertainty = false;
  out.push_back(cma_es("cma-es x1", o, 0));
  out.push_back(cma_es("cma-es x1, final", o, 0.1));
  o.evaluations = 2;
  out.push_back(cma_es("cma-es x2, final", o, 0.1));
  o = {};
  out.push_back(cma_es("cma-es uncertainty, final", o, 0.1));
  o.common_random_numbers = true;
  out.push_back(cma_es("cma-es uncertainty, final, common", o, 0.1));
  return out;
}

}  // namespace lilytank::bench
