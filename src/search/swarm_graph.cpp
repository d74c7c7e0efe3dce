// Who looks at whom in a swarm, and the paper's swarms by name.
#include <algorithm>

#include "lilytank/error.hpp"
#include "lilytank/search.hpp"

namespace lilytank {
namespace {

/// Distances around the circle of particles at which a particle has neighbours.
std::vector<int> steps_of(Neighbourhood neighbourhood, int particles) {
  if (neighbourhood == Neighbourhood::ring) return {1};
  // Row by row, the end of a row beside the start of the next: any number of particles will do.
  int columns = 1;
  while ((columns + 1) * (columns + 1) <= particles) ++columns;
  return {1, columns};
}

}  // namespace

std::vector<int> neighbours_of(Neighbourhood neighbourhood, int particles, int i) {
  std::vector<int> out;
  if (neighbourhood == Neighbourhood::global) {
    for (int j = 0; j < particles; ++j) out.push_back(j);
    return out;
  }
  out.push_back(i);
  for (const int step : steps_of(neighbourhood, particles)) {
    out.push_back((i + step) % particles);
    out.push_back((i + particles - step % particles) % particles);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<std::string> swarm_presets() {
  return {"paper-balls", "paper-lilies", "paper-rulesets"};
}

SwarmOptions swarm_preset(const std::string& name) {
  SwarmOptions options;  // the weights are the paper's already
  options.at_bound = AtBound::keep, options.velocity_limit = 0.15;  // as the authors' code
  if (name == "paper-balls" || name == "paper-lilies") {
    options.particles = 47, options.iterations = name == "paper-balls" ? 30 : 100;
    options.evaluations = 2, options.noise = NoiseRule::reevaluate;
    return options;
  }
  if (name == "paper-rulesets") {
    options.particles = 15, options.iterations = 20;
    options.evaluations = 2, options.noise = NoiseRule::none;
    return options;
  }
  const std::vector<std::string> known = swarm_presets();
  throw InputError("unknown preset '" + name + "'" + did_you_mean(name, known) +
                   "; there are: paper-balls, paper-lilies, paper-rulesets");
}

}  // namespace lilytank
