// Which search finds the better parameters of an experiment with the same number of simulations?
//
//   calibration_searches EXPERIMENT.toml [--objective=msd] [--budget=1880] [--seeds=5]
//                        [--fresh=100] [--set=PATH=VALUE ...]
//
// For each search and seed the mean of the objective over fresh pieces of simulation, the same for
// all, at the point that it ends with; then the mean over the seeds with its standard error.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "lilytank/calibration.hpp"
#include "lilytank/study.hpp"
#include "text/number.hpp"

namespace lilytank::bench {
namespace {

constexpr std::int64_t kFresh = 1'000'000'000;  // replicates that no search asks for

struct Options {
  std::vector<std::string> files, sets;
  CalibrationOptions calibration;
  int budget = 1880, seeds = 5, fresh = 100;
};

Options options_from(int count, char** words) {
  Options out;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const std::string value = word.substr(std::min(word.find('=') + 1, word.size()));
    const int number = static_cast<int>(parse_whole(value).value_or(1));
    if (word.starts_with("--objective=")) {
      out.calibration.objective = objective_named(value);
    } else if (word.starts_with("--budget=")) {
      out.budget = number;
    } else if (word.starts_with("--seeds=")) {
      out.seeds = number;
    } else if (word.starts_with("--fresh=")) {
      out.fresh = number;
    } else if (word.starts_with("--set=")) {
      out.sets.push_back(value);
    } else {
      out.files.push_back(word);
    }
  }
  return out;
}

struct Contestant {
  std::string name;
  std::unique_ptr<Search> (*make)(const SearchSpace&, int budget, std::uint64_t seed);
};

std::unique_ptr<Search> swarm(const SearchSpace& space, int budget, std::uint64_t seed,
                              Neighbourhood neighbourhood, NoiseRule noise) {
  SwarmOptions o = swarm_preset("paper-lilies");
  o.neighbourhood = neighbourhood, o.noise = noise;
  o.iterations = std::max(1, budget / (o.particles * o.evaluations));
  return make_swarm(space, o, seed);
}

const std::vector<Contestant>& contestants() {
  static const std::vector<Contestant> all{
      {"swarm, global, re-evaluated (paper)",
       [](const SearchSpace& s, int budget, std::uint64_t seed) {
         return swarm(s, budget, seed, Neighbourhood::global, NoiseRule::reevaluate);
       }},
      {"swarm, global, OCBA",
       [](const SearchSpace& s, int budget, std::uint64_t seed) {
         return swarm(s, budget, seed, Neighbourhood::global, NoiseRule::ocba);
       }},
      {"swarm, ring, OCBA",
       [](const SearchSpace& s, int budget, std::uint64_t seed) {
         return swarm(s, budget, seed, Neighbourhood::ring, NoiseRule::ocba);
       }},
      {"CMA-ES",
       [](const SearchSpace& s, int budget, std::uint64_t seed) {
         CmaEsOptions o;
         o.budget = budget, o.final_evaluations = std::clamp(budget / 10, 4, 100);
         return make_cma_es(s, o, seed);
       }},
  };
  return all;
}

std::vector<double> values_of(const CalibrationSearch& objective,
                              const std::vector<Trial>& trials) {
  std::vector<double> out(trials.size());
  for_each_world(static_cast<int>(trials.size()), 0, [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    out[k] = objective.value(trials[k]);
  });
  return out;
}

double mean_at(const CalibrationSearch& objective, const std::vector<double>& point, int fresh) {
  std::vector<Trial> trials;
  for (int k = 0; k < fresh; ++k) trials.push_back({point, kFresh + k});
  double sum = 0;
  for (const double value : values_of(objective, trials)) sum += value;
  return sum / fresh;
}

void compare(const Options& options) {
  const Experiment experiment = load_experiment(options.files, options.sets);
  const CalibrationSearch objective(experiment, options.calibration);
  std::printf("%-38s %9s  %s\n", "search", "mean", "standard error, and each seed");
  for (const Contestant& contestant : contestants()) {
    std::vector<double> ends;
    for (int seed = 1; seed <= options.seeds; ++seed) {
      const auto search =
          contestant.make(objective.space(), options.budget, static_cast<std::uint64_t>(seed));
      for (auto trials = search->ask(); !trials.empty(); trials = search->ask()) {
        search->tell(values_of(objective, trials));
      }
      ends.push_back(mean_at(objective, search->best().point, options.fresh));
    }
    double mean = 0, square = 0;
    for (const double v : ends) mean += v / options.seeds;
    for (const double v : ends) square += (v - mean) * (v - mean);
    const double error = std::sqrt(square / options.seeds / std::max(1, options.seeds - 1));
    std::printf("%-38s %9.4g  %.2g:", contestant.name.c_str(), mean, error);
    for (const double v : ends) std::printf(" %.4g", v);
    std::printf("\n");
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace lilytank::bench

int main(int argc, char** argv) {
  try {
    lilytank::bench::compare(lilytank::bench::options_from(argc, argv));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
