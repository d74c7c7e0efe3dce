#include "search_objectives.hpp"

#include <cmath>
#include <cstring>

#include "lilytank/math.hpp"
#include "lilytank/random.hpp"

namespace lilytank::bench {
namespace {

using Point = std::vector<double>;
constexpr int kSamples = 4000;  // for the mean over the box

/// z: the way from the lowest point, in half lengths of the box.
double raw_value(const std::string& name, const Point& z) {
  double sum = 0;
  for (std::size_t a = 0; a < z.size(); ++a) {
    const double x = z[a];
    const double share =
        z.size() > 1 ? static_cast<double>(a) / static_cast<double>(z.size() - 1) : 0;
    if (name == "ellipsoid") {
      sum += std::pow(1000, share) * x * x;
    } else if (name == "rastrigin") {
      sum += 4 * x * x + 0.4 * (1 - std::cos(2 * kPi * 2 * x));
    } else if (name == "rosenbrock") {
      if (a + 1 == z.size()) break;
      // The valley at twice this size: from (1, 1) half of it lies in the box.
      const double p = 1 + 2 * x, q = 1 + 2 * z[a + 1];
      sum += 100 * (q - p * p) * (q - p * p) + (1 - p) * (1 - p);
    } else {
      sum += x * x;
    }
  }
  return sum;
}

std::uint64_t hash_of(const Point& point) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const double x : point) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    hash = (hash ^ bits) * 0x100000001b3;
    hash ^= hash >> 29;
  }
  return hash;
}

double draw(std::uint64_t seed, int i, std::size_t axis) {
  return uniform({seed, Stream::latin, i, 0, static_cast<std::uint32_t>(axis)});
}

}  // namespace

std::vector<std::string> search_functions() {
  return {"sphere", "corner", "ellipsoid", "rosenbrock", "rastrigin"};
}

SearchObjective search_objective(const SearchCase& what, std::uint64_t seed) {
  SearchObjective out;
  out.name = what.function;
  Point lowest;
  for (int a = 0; a < what.axes; ++a) {
    out.space.push_back({"x" + std::to_string(a), 0, 1});
    const double u = draw(seed, 0, static_cast<std::size_t>(a));
    lowest.push_back(what.function == "corner" ? (u < 0.5 ? 0.0 : 1.0) : 0.2 + 0.6 * u);
  }
  const auto raw = [name = what.function, lowest](const Point& point) {
    Point z(point.size());
    for (std::size_t a = 0; a < z.size(); ++a) z[a] = 2 * (point[a] - lowest[a]);
    return raw_value(name, z);
  };
  double mean = 0;
  for (int i = 1; i <= kSamples; ++i) {
    Point point(lowest.size());
    for (std::size_t a = 0; a < point.size(); ++a) point[a] = draw(seed, i, a);
    mean += raw(point) / kSamples;
  }
  out.truth = [raw, mean](const Point& point) { return raw(point) / mean; };
  const double half = what.noise * std::sqrt(0.5);
  out.value = [truth = out.truth, half, seed](const Trial& trial) {
    if (half == 0) return truth(trial.point);
    const auto shared = normal_pair({seed, Stream::gust, trial.replicate});
    const auto own =
        normal_pair({seed ^ hash_of(trial.point), Stream::stochastic, trial.replicate});
    return truth(trial.point) + half * (shared[0] + own[0]);
  };
  return out;
}

}  // namespace lilytank::bench
