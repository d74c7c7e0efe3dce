// Functions whose lowest points are known, for tests of searches.
#pragma once
#include <cmath>
#include <functional>
#include <vector>

#include "lilytank/random.hpp"
#include "lilytank/search.hpp"

namespace lilytank {

using Point = std::vector<double>;

/// All axes from -5 to 5.
inline SearchSpace box(int axes) {
  SearchSpace space;
  for (int a = 0; a < axes; ++a) space.push_back({"x" + std::to_string(a), -5, 5});
  return space;
}

/// Lowest, 0, at 1 on every axis.
inline double sphere(const Point& p) {
  double sum = 0;
  for (const double x : p) sum += (x - 1) * (x - 1);
  return sum;
}

/// Axes of very different weights; lowest, 0, at 1 on every axis.
inline double ellipsoid(const Point& p) {
  double sum = 0;
  for (std::size_t a = 0; a < p.size(); ++a) {
    sum += std::pow(1e6, static_cast<double>(a) / static_cast<double>(p.size() - 1)) * (p[a] - 1) *
           (p[a] - 1);
  }
  return sum;
}

/// A bent valley; lowest, 0, at 1 on every axis.
inline double rosenbrock(const Point& p) {
  double sum = 0;
  for (std::size_t a = 0; a + 1 < p.size(); ++a) {
    const double off = p[a + 1] - p[a] * p[a];
    sum += 100 * off * off + (1 - p[a]) * (1 - p[a]);
  }
  return sum;
}

/// Many valleys, one about every whole number; lowest, 0, at 1 on every axis.
inline double rastrigin(const Point& p) {
  double sum = 0;
  for (const double x : p) {
    sum += (x - 1) * (x - 1) + 10 - 10 * std::cos(2 * 3.14159265358979323846 * (x - 1));
  }
  return sum;
}

/// `function` with normal noise that is a function of the trial's replicate.
inline double noisy(double value, const Trial& trial, double deviation, std::uint64_t seed) {
  return value + deviation * normal_pair({seed, Stream::start_pose, trial.replicate})[0];
}

/// Carries a search to its end.
inline void carry_through(Search& search, const std::function<double(const Trial&)>& value) {
  for (auto trials = search.ask(); !trials.empty(); trials = search.ask()) {
    std::vector<double> values;
    for (const Trial& trial : trials) values.push_back(value(trial));
    search.tell(values);
  }
}

}  // namespace lilytank
