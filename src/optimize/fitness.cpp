#include <algorithm>

#include "lilytank/error.hpp"
#include "lilytank/optimize.hpp"

namespace lilytank {
namespace {

double eq10(const std::vector<double>& completion, int reached, int possible, double horizon) {
  double sum = (possible - reached) * horizon, before = 0;
  for (int k = 0; k < reached; ++k) {
    sum += std::min(completion[static_cast<std::size_t>(k)] - before, horizon);
    before = completion[static_cast<std::size_t>(k)];
  }
  return sum;
}

double missing_area(const std::vector<double>& completion, int reached, int possible,
                    double horizon) {
  double area = (possible - reached) * horizon;
  for (int k = 0; k < reached; ++k) area += completion[static_cast<std::size_t>(k)];
  return area;
}

}  // namespace

double fitness_of(const FitnessRule& rule, const std::vector<double>& completion, int possible,
                  double horizon) {
  const int reached = std::min(static_cast<int>(completion.size()), possible);
  const bool full = reached == possible;
  const double end = full ? completion[static_cast<std::size_t>(possible - 1)] : horizon;
  switch (rule.fitness) {
    case Fitness::eq10:
      return eq10(completion, reached, possible, horizon);
    case Fitness::yield_area:
      return missing_area(completion, reached, possible, horizon);
    case Fitness::full_yield_time:
      return end;
    case Fitness::full_yield_probability:
      return full ? 0 : 1;
    case Fitness::rate_and_yield:
      break;
  }
  return rule.yield_weight * (1 - static_cast<double>(reached) / possible) -
         rule.rate_weight * reached / end;
}

std::vector<std::string> fitness_names() {
  return {"eq10", "yield_area", "full_yield_time", "full_yield_probability", "rate_and_yield"};
}

std::string name_of(Fitness fitness) {
  return fitness_names()[static_cast<std::size_t>(fitness)];
}

std::string fitness_unit(Fitness fitness) {
  if (fitness == Fitness::yield_area) return "copies s";
  return fitness == Fitness::eq10 || fitness == Fitness::full_yield_time ? "s" : "1";
}

}  // namespace lilytank
