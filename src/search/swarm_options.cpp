#include "search/swarm_options.hpp"

#include <array>
#include <cmath>

#include "search/space.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr int kMostParticles = 100'000, kMostIterations = 1'000'000, kMostEvaluations = 10'000;
constexpr int kMostFinal = 100'000'000;

template <class T>
struct Named {
  const char* word;
  T value;
};
constexpr std::array<Named<Neighbourhood>, 3> kNeighbourhoods{
    {{"global", Neighbourhood::global},
     {"ring", Neighbourhood::ring},
     {"von-neumann", Neighbourhood::von_neumann}}};
constexpr std::array<Named<NoiseRule>, 3> kNoiseRules{
    {{"none", NoiseRule::none}, {"reevaluate", NoiseRule::reevaluate}, {"ocba", NoiseRule::ocba}}};
constexpr std::array<Named<AtBound>, 3> kAtBounds{
    {{"stop", AtBound::stop}, {"reflect", AtBound::reflect}, {"keep", AtBound::keep}}};

template <class T, std::size_t N>
T named(const std::array<Named<T>, N>& all, const std::string& word, const std::string& what) {
  std::vector<std::string> words;
  for (const auto& one : all) {
    if (word == one.word) return one.value;
    words.emplace_back(one.word);
  }
  std::string list;
  for (const std::string& known : words) list += (list.empty() ? "" : ", ") + known;
  throw InputError("unknown " + what + " '" + word + "'" + did_you_mean(word, words) +
                   "; there are: " + list);
}

template <class T, std::size_t N>
std::string word_of(const std::array<Named<T>, N>& all, T value) {
  for (const auto& one : all) {
    if (value == one.value) return one.word;
  }
  return "";
}

void check_whole(const std::string& name, int value, int low, int high) {
  if (value >= low && value <= high) return;
  throw InputError("a swarm's " + name + " must be from " + std::to_string(low) + " to " +
                   std::to_string(high) + ", not " + std::to_string(value));
}

void check_number(const std::string& name, double value) {
  if (std::isfinite(value)) return;
  throw InputError("a swarm's " + name + " must be finite, not " + shortest(value));
}

}  // namespace

Neighbourhood neighbourhood_named(const std::string& word) {
  return named(kNeighbourhoods, word, "neighbourhood");
}
NoiseRule noise_rule_named(const std::string& word) {
  return named(kNoiseRules, word, "noise rule");
}
std::string name_of(Neighbourhood neighbourhood) {
  return word_of(kNeighbourhoods, neighbourhood);
}
std::string name_of(NoiseRule rule) {
  return word_of(kNoiseRules, rule);
}

void check_swarm_options(const SwarmOptions& o, const SearchSpace& space) {
  check_whole("particles", o.particles, 2, kMostParticles);
  check_whole("iterations", o.iterations, 1, kMostIterations);
  const bool again = o.noise != NoiseRule::none;
  check_whole("evaluations" + (again ? " with the noise rule " + name_of(o.noise) : ""),
              o.evaluations, again ? 2 : 1, kMostEvaluations);
  check_whole("stages", o.ocba_stages, 1, kMostEvaluations);
  if (o.final_evaluations != 0)
    check_whole("final evaluations", o.final_evaluations, 4, kMostFinal);
  check_number("inertia", o.inertia);
  check_number("personal weight", o.personal);
  check_number("neighbour weight", o.neighbour);
  if (!std::isfinite(o.velocity_limit) || !(o.velocity_limit > 0)) {
    throw InputError("a swarm's velocity limit must be finite and above 0, not " +
                     shortest(o.velocity_limit));
  }
  if (o.starts.size() > static_cast<std::size_t>(o.particles)) {
    throw InputError(std::to_string(o.starts.size()) + " starting points for " +
                     std::to_string(o.particles) + " particles");
  }
  for (std::size_t i = 0; i < o.starts.size(); ++i) {
    check_point(space, o.starts[i], "starting point " + std::to_string(i + 1));
  }
}

void save_swarm_options(StateWriter& out, const SwarmOptions& o) {
  out.whole("particles", o.particles);
  out.whole("iterations", o.iterations);
  const double weights[] = {o.inertia, o.personal, o.neighbour, o.velocity_limit};
  out.numbers("weights", weights);
  out.word("neighbourhood", name_of(o.neighbourhood));
  out.word("bound", word_of(kAtBounds, o.at_bound));
  out.whole("evaluations", o.evaluations);
  out.word("noise", name_of(o.noise));
  out.whole("stages", o.ocba_stages);
  out.whole("final", o.final_evaluations);
  out.whole("common", o.common_random_numbers ? 1 : 0);
  out.whole("starts", static_cast<std::int64_t>(o.starts.size()));
  for (const auto& start : o.starts) out.numbers("start", start);
}

SwarmOptions load_swarm_options(StateReader& in, const SearchSpace& space) {
  SwarmOptions o;
  o.particles = static_cast<int>(in.whole("particles", 2, kMostParticles));
  o.iterations = static_cast<int>(in.whole("iterations", 1, kMostIterations));
  const auto weights = in.numbers("weights", 4);
  o.inertia = weights[0], o.personal = weights[1], o.neighbour = weights[2];
  o.velocity_limit = weights[3];
  o.neighbourhood = neighbourhood_named(in.word("neighbourhood"));
  o.at_bound = named(kAtBounds, in.word("bound"), "behaviour at a bound");
  o.evaluations = static_cast<int>(in.whole("evaluations", 1, kMostEvaluations));
  o.noise = noise_rule_named(in.word("noise"));
  o.ocba_stages = static_cast<int>(in.whole("stages", 1, kMostEvaluations));
  o.final_evaluations = static_cast<int>(in.whole("final", 0, kMostFinal));
  o.common_random_numbers = in.whole("common", 0, 1) == 1;
  o.starts.resize(static_cast<std::size_t>(in.whole("starts", 0, o.particles)));
  for (auto& start : o.starts) start = in.numbers("start", space.size());
  check_swarm_options(o, space);
  return o;
}

}  // namespace lilytank
