#include <algorithm>
#include <array>
#include <cmath>

#include "smoothing/motion_model.hpp"

namespace lilytank {
namespace {

// What is searched over, as decimal logarithms: [0] acceleration and [1] jolts against the noise,
// by what they move a body in a frame; [2] memory in frames.
using Point = std::array<double, 3>;
constexpr Point kLow{-7, -6, 0.3}, kHigh{6, 6, 3};

Point held(Point p) {
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = std::clamp(p[i], kLow[i], kHigh[i]);
  return p;
}

class Likelihood {
 public:
  Likelihood(const std::vector<Axes>& pieces, double interval, double noise)
      : pieces_(pieces), interval_(interval), noise_(noise) {}

  // -2 log L a sample, but for a constant. Where the noise is not given, the best one for the
  // point is taken: all variances then only scale with it. Every `stride`-th piece is looked at.
  double operator()(const Point& p, std::size_t stride = 1) const {
    const Innovations sums = innovations(p, stride);
    const auto n = static_cast<double>(sums.count);
    if (noise_ > 0) return (sums.squares + sums.log_variance) / n;
    return 1 + std::log(sums.squares / n) + sums.log_variance / n;
  }
  MotionModel model(const Point& p) const {
    const Innovations sums = innovations(p, 1);
    const auto n = static_cast<double>(sums.count);
    MotionModel m = scaled(p, noise_ > 0 ? noise_ : std::sqrt(sums.squares / n));
    constexpr double kLogTwoPi = 1.8378770664093453;
    m.log_likelihood = -0.5 * n * ((*this)(p) + kLogTwoPi);
    m.samples = sums.count;
    return m;
  }

 private:
  MotionModel scaled(const Point& p, double noise) const {
    MotionModel m;
    m.noise = noise;
    m.acceleration = noise * std::pow(10.0, p[0]) / (interval_ * interval_);
    m.jolts = noise * std::pow(10.0, p[1]) / std::pow(interval_, 1.5);
    m.memory = interval_ * std::pow(10.0, p[2]);
    return m;
  }
  Innovations innovations(const Point& p, std::size_t stride) const {
    const MotionModel m = scaled(p, noise_ > 0 ? noise_ : 1);
    Innovations sums;
    for (std::size_t i = 0; i < pieces_.size(); i += stride) {
      add_innovations(pieces_[i], m, interval_, sums);
    }
    return sums;
  }
  const std::vector<Axes>& pieces_;
  double interval_, noise_;
};

struct Vertex {
  Point at{};
  double value = 0;
  bool operator<(const Vertex& other) const { return value < other.value; }
};

// The best points of a grid, each among those of its own kind: without jolts, with jolts only, with
// both. The likelihood has a maximum in each, and a search does not find from one to another.
std::array<Point, 3> best_on_grid(const Likelihood& likelihood, std::size_t stride) {
  std::array<Vertex, 3> best{Vertex{{}, HUGE_VAL}, Vertex{{}, HUGE_VAL}, Vertex{{}, HUGE_VAL}};
  constexpr double kFaint = -3;
  for (const double memory : {0.6, 1.3, 2.2}) {
    for (double acceleration = kLow[0]; acceleration <= kHigh[0]; acceleration += 1.3) {
      for (const double jolts : {kLow[1], -2.0, -1.0, 0.0, 1.0, 2.5, 4.0}) {
        Vertex& kind = best[jolts < kFaint ? 0 : acceleration < kFaint ? 1 : 2];
        const Point p{acceleration, jolts, memory};
        kind = std::min(kind, Vertex{p, likelihood(p, stride)});
      }
    }
  }
  return {best[0].at, best[1].at, best[2].at};
}

// Nelder and Mead's simplex search [Comput. J. 7, 1965], held within the bounds.
class Simplex {
 public:
  Simplex(const Likelihood& likelihood, const Point& start, std::size_t stride)
      : likelihood_(likelihood), stride_(stride) {
    corners_[0] = vertex(start);
    for (std::size_t i = 0; i < start.size(); ++i) {
      Point p = start;
      p[i] += p[i] + 0.5 > kHigh[i] ? -0.5 : 0.5;
      corners_[i + 1] = vertex(p);
    }
  }
  Vertex minimum() {
    constexpr int kRounds = 150;
    for (int round = 0; round < kRounds; ++round) {
      std::sort(corners_.begin(), corners_.end());
      if (corners_.back().value - corners_[0].value < 1e-7 && size() < 0.02) break;
      replace_worst();
    }
    return *std::min_element(corners_.begin(), corners_.end());
  }

 private:
  Vertex vertex(const Point& p) const { return {held(p), likelihood_(held(p), stride_)}; }
  double size() const {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += std::fabs(corners_[3].at[i] - corners_[0].at[i]);
    return sum;
  }
  // The point on the line from the middle of the better corners to the worst, k times as far.
  Vertex along(double k) const {
    Point p{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double middle = (corners_[0].at[i] + corners_[1].at[i] + corners_[2].at[i]) / 3;
      p[i] = middle + k * (corners_[3].at[i] - middle);
    }
    return vertex(p);
  }
  void replace_worst() {
    Vertex& worst = corners_[3];
    const Vertex mirrored = along(-1);
    if (mirrored < corners_[0]) {
      worst = std::min(along(-2), mirrored);
    } else if (mirrored < corners_[2]) {
      worst = mirrored;
    } else {
      const Vertex nearer = along(mirrored < worst ? -0.5 : 0.5);
      if (nearer < std::min(mirrored, worst)) {
        worst = nearer;
      } else {
        shrink();
      }
    }
  }
  void shrink() {
    for (std::size_t c = 1; c < corners_.size(); ++c) {
      Point p{};
      for (std::size_t i = 0; i < 3; ++i) p[i] = (corners_[c].at[i] + corners_[0].at[i]) / 2;
      corners_[c] = vertex(p);
    }
  }
  const Likelihood& likelihood_;
  std::size_t stride_;
  std::array<Vertex, 4> corners_;
};

}  // namespace

MotionModel fit_motion(const std::vector<Axes>& pieces, double interval, double noise) {
  Innovations any;
  for (const Axes& piece : pieces) {
    add_innovations(piece, {1, 1 / (interval * interval), interval}, interval, any);
  }
  // Nothing seen, or nothing that ever moves: no variance to divide between motion and noise.
  if (any.count < 8 || !(any.squares > 0)) return {noise, 0, 2 * interval};
  const Likelihood likelihood(pieces, interval, noise);
  const std::size_t stride = pieces.size() >= 8 ? 4 : 1;
  Vertex best{{}, HUGE_VAL};
  for (const Point& start : best_on_grid(likelihood, stride)) {
    best = std::min(best, Simplex(likelihood, start, stride).minimum());
  }
  // From there over all pieces; anew, which also gets out of a simplex that fell flat.
  return likelihood.model(Simplex(likelihood, best.at, 1).minimum().at);
}

}  // namespace lilytank
