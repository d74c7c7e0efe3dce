#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/motion_model.hpp"

namespace lilytank {
namespace {

// What is searched over: acceleration against noise, and memory against the interval, as decimal
// logarithms.
struct Point {
  double ratio = 0, memory = 0;
};
constexpr double kRatioLow = -7, kRatioHigh = 6, kMemoryLow = -0.5, kMemoryHigh = 3;

Point held(Point p) {
  return {std::clamp(p.ratio, kRatioLow, kRatioHigh),
          std::clamp(p.memory, kMemoryLow, kMemoryHigh)};
}

class Likelihood {
 public:
  Likelihood(const std::vector<Axes>& pieces, double interval, double noise)
      : pieces_(pieces), interval_(interval), noise_(noise) {}

  // -2 log L a sample, but for a constant. Where the noise is not given, the best one for the
  // point is taken: all variances then only scale with it.
  double operator()(const Point& p) {
    const MotionModel unit = scaled(p, noise_ > 0 ? noise_ : 1);
    Innovations sums;
    for (const Axes& piece : pieces_) add_innovations(piece, unit, interval_, sums);
    const auto n = static_cast<double>(sums.count);
    count_ = sums.count;
    const double square = sums.squares / n;
    if (noise_ > 0) return square + sums.log_variance / n;
    return 1 + std::log(square) + sums.log_variance / n;
  }
  MotionModel model(const Point& p) {
    double noise = noise_;
    if (!(noise > 0)) {
      Innovations sums;
      for (const Axes& piece : pieces_) add_innovations(piece, scaled(p, 1), interval_, sums);
      noise = std::sqrt(sums.squares / static_cast<double>(sums.count));
    }
    MotionModel m = scaled(p, noise);
    m.log_likelihood = -0.5 * static_cast<double>(count_) * ((*this)(p) + std::log(2 * kPi));
    m.samples = count_;
    return m;
  }

 private:
  static constexpr double kPi = 3.14159265358979323846;
  MotionModel scaled(const Point& p, double noise) const {
    MotionModel m;
    m.noise = noise;
    m.acceleration = noise * std::pow(10.0, p.ratio) / (interval_ * interval_);
    m.memory = interval_ * std::pow(10.0, p.memory);
    return m;
  }
  const std::vector<Axes>& pieces_;
  double interval_, noise_;
  std::int64_t count_ = 0;
};

struct Vertex {
  Point at;
  double value = 0;
};

Vertex best_on_grid(Likelihood& likelihood) {
  Vertex best{{}, HUGE_VAL};
  for (double memory = kMemoryLow; memory <= kMemoryHigh; memory += 1) {
    for (double ratio = kRatioLow; ratio <= kRatioHigh; ratio += 1.3) {
      const Point p{ratio, memory};
      const double value = likelihood(p);
      if (value < best.value) best = {p, value};
    }
  }
  return best;
}

// Nelder and Mead's simplex search in two dimensions.
Point refined(Likelihood& likelihood, const Vertex& start) {
  const auto at = [&](Point p) {
    p = held(p);
    return Vertex{p, likelihood(p)};
  };
  const auto step = [](double v, double by, double high) {
    return v + by > high ? v - by : v + by;
  };
  std::array<Vertex, 3> s{start, at({step(start.at.ratio, 0.5, kRatioHigh), start.at.memory}),
                          at({start.at.ratio, step(start.at.memory, 0.4, kMemoryHigh)})};
  for (int round = 0; round < 60; ++round) {
    std::sort(s.begin(), s.end(), [](auto& a, auto& b) { return a.value < b.value; });
    const auto size =
        std::fabs(s[2].at.ratio - s[0].at.ratio) + std::fabs(s[2].at.memory - s[0].at.memory);
    if (s[2].value - s[0].value < 1e-7 && size < 1e-2) break;
    const Point middle{(s[0].at.ratio + s[1].at.ratio) / 2, (s[0].at.memory + s[1].at.memory) / 2};
    const auto along = [&](double k) {
      return at({middle.ratio + k * (s[2].at.ratio - middle.ratio),
                 middle.memory + k * (s[2].at.memory - middle.memory)});
    };
    const Vertex mirrored = along(-1);
    if (mirrored.value < s[0].value) {
      const Vertex further = along(-2);
      s[2] = further.value < mirrored.value ? further : mirrored;
    } else if (mirrored.value < s[1].value) {
      s[2] = mirrored;
    } else {
      const Vertex nearer = along(mirrored.value < s[2].value ? -0.5 : 0.5);
      if (nearer.value < std::min(mirrored.value, s[2].value)) {
        s[2] = nearer;
      } else {
        for (int i = 1; i < 3; ++i) {
          s[i] = at({(s[i].at.ratio + s[0].at.ratio) / 2, (s[i].at.memory + s[0].at.memory) / 2});
        }
      }
    }
  }
  return std::min_element(s.begin(), s.end(), [](auto& a, auto& b) { return a.value < b.value; })
      ->at;
}

}  // namespace

MotionModel fit_motion(const std::vector<Axes>& pieces, double interval, double noise) {
  Innovations any;
  for (const Axes& piece : pieces) {
    add_innovations(piece, {1, 1 / (interval * interval), interval}, interval, any);
  }
  // Nothing seen, or nothing that ever moves: no variance to divide between motion and noise.
  if (any.count < 8 || !(any.squares > 0)) return {noise, 0, interval, 0, 0};
  Likelihood likelihood(pieces, interval, noise);
  return likelihood.model(refined(likelihood, best_on_grid(likelihood)));
}

}  // namespace lilytank
