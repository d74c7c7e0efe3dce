// The strongest frequency of a motion: where fits of rotations and oscillations start.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bodies/model.hpp"
#include "statistics/median.hpp"

namespace lilytank::bodies {
namespace {

// Velocities of one body, from sample to sample, without their mean.
struct VelocitySeries {
  std::vector<double> time, x, y;
};

VelocitySeries velocities_of(const BodyRun& run, std::size_t body, std::size_t dimensions) {
  constexpr std::size_t kLongest = 1500;
  VelocitySeries out;
  const std::size_t row = run.coordinates(), i = body * dimensions;
  for (std::size_t k = 1; k < std::min(run.samples(), kLongest); ++k) {
    const double* now = &run.position[k * row + i];
    const double* before = now - row;
    const double T = run.time[k] - run.time[k - 1];
    const double x = (now[0] - before[0]) / T;
    const double y = dimensions == 2 ? (now[1] - before[1]) / T : 0;
    if (!std::isfinite(x + y)) continue;
    out.time.push_back(run.time[k] - T / 2), out.x.push_back(x), out.y.push_back(y);
  }
  for (std::vector<double>* v : {&out.x, &out.y}) {
    double mean = 0;
    for (const double one : *v) mean += one / static_cast<double>(v->size());
    for (double& one : *v) one -= mean;
  }
  return out;
}

}  // namespace

double strongest_rate(const std::vector<const BodyRun*>& runs, int dimensions) {
  constexpr int kMostRates = 2000;
  std::vector<VelocitySeries> all;
  std::vector<double> steps;
  double duration = 0;
  for (const BodyRun* run : runs) {
    for (std::size_t k = 1; k < run->samples(); ++k) {
      steps.push_back(run->time[k] - run->time[k - 1]);
    }
    for (std::size_t b = 0; b < run->bodies.size(); ++b) {
      all.push_back(velocities_of(*run, b, static_cast<std::size_t>(dimensions)));
      if (!all.back().time.empty())
        duration = std::max(duration, all.back().time.back() - all.back().time.front());
    }
  }
  if (!(duration > 0)) return 0;
  const double least = std::numbers::pi / duration;
  const int rates =
      std::min(kMostRates, static_cast<int>(std::numbers::pi / median(std::move(steps)) / least));
  double best = 0, strongest = 0;
  for (int j = 1; j <= rates; ++j) {
    double clockwise = 0, anticlockwise = 0;
    for (const VelocitySeries& v : all) {
      double xc = 0, xs = 0, yc = 0, ys = 0;
      for (std::size_t k = 0; k < v.time.size(); ++k) {
        const double c = std::cos(j * least * v.time[k]), s = std::sin(j * least * v.time[k]);
        xc += v.x[k] * c, xs += v.x[k] * s, yc += v.y[k] * c, ys += v.y[k] * s;
      }
      // Of v_x + i v_y by exp(i w t) and exp(-i w t).
      clockwise += (xc - ys) * (xc - ys) + (xs + yc) * (xs + yc);
      anticlockwise += (xc + ys) * (xc + ys) + (xs - yc) * (xs - yc);
    }
    if (clockwise > strongest) strongest = clockwise, best = j * least;
    if (anticlockwise > strongest) strongest = anticlockwise, best = -j * least;
  }
  return best;
}

}  // namespace lilytank::bodies
