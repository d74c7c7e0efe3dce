#include "scores/flow_uncertainty.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "lilytank/random.hpp"

namespace lilytank {
namespace {

constexpr double kMeanError = 0.02, kGustError = 0.03;
constexpr int kWaves = 12;

// A smooth random function of variance one: waves of half to twice the tank's diameter.
class Smooth {
 public:
  Smooth(std::uint64_t seed, std::int64_t run, std::uint32_t axis, double extent) {
    for (int w = 0; w < kWaves; ++w) {
      const auto draw = [&](std::uint32_t which) {
        return uniform({seed, Stream::calibrate, run * kWaves + w, axis, 20 + which});
      };
      const double turn = 2 * kPi * draw(0), waves = 0.5 + 1.5 * draw(1);
      const Rot way = rotation(turn);
      const double k = kPi * waves / extent;
      waves_[static_cast<std::size_t>(w)] = {k * way.c, k * way.s, 2 * kPi * draw(2)};
    }
  }
  /// Its values at the centres of a grid's cells, row by row.
  std::vector<double> on(const FlowField& field) const {
    const auto side = static_cast<std::size_t>(field.cells());
    const double pitch = 2 * field.extent() / field.cells();
    std::vector<double> sum(side * side);
    std::vector<Rot> along_x(side), along_y(side);
    for (const Wave& w : waves_) {
      for (std::size_t i = 0; i < side; ++i) {
        const double at = (static_cast<double>(i) + 0.5) * pitch - field.extent();
        along_x[i] = rotation(w.kx * at + w.phase), along_y[i] = rotation(w.ky * at);
      }
      for (std::size_t i = 0; i < sum.size(); ++i) {
        const Rot &a = along_x[i % side], &b = along_y[i / side];
        sum[i] += a.c * b.c - a.s * b.s;
      }
    }
    for (double& value : sum) value *= std::sqrt(2.0 / kWaves);
    return sum;
  }

 private:
  struct Wave {
    double kx = 0, ky = 0, phase = 0;
  };
  std::array<Wave, kWaves> waves_;
};

void widen(FlowSample& drawn, const FlowSample& best) {
  const auto wider = [](double& value, double about) {
    value = about + kPosteriorScale * (value - about);
  };
  wider(drawn.mu_x, best.mu_x), wider(drawn.mu_y, best.mu_y);
  wider(drawn.sigma_x, best.sigma_x), wider(drawn.sigma_y, best.sigma_y);
  drawn.sigma_x = std::max(drawn.sigma_x, 0.0), drawn.sigma_y = std::max(drawn.sigma_y, 0.0);
}

}  // namespace

std::shared_ptr<const FlowField> perturbed_flow(const FlowMaps& maps, std::uint64_t field_seed,
                                                std::uint64_t seed, std::int64_t run) {
  const FlowField& field = *maps.best();
  std::vector<FlowSample> samples = maps.draw(field_seed, run)->samples();
  for (std::size_t i = 0; i < samples.size(); ++i) widen(samples[i], field.samples()[i]);
  double square = 0;
  for (const FlowSample& s : field.samples()) square += s.mu_x * s.mu_x + s.mu_y * s.mu_y;
  const double size = kMeanError * std::sqrt(0.5 * square / static_cast<double>(samples.size()));
  const auto smooth = [&](std::uint32_t axis) {
    return Smooth(seed, run, axis, field.extent()).on(field);
  };
  const std::vector<double> x = smooth(0), y = smooth(1), gusts = smooth(2);
  const double common = kGustError * normal_pair({seed, Stream::calibrate, run, 3, 19})[0];
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].mu_x += size * x[i], samples[i].mu_y += size * y[i];
    const double factor = std::max(0.2, 1 + common + kGustError * gusts[i]);
    samples[i].sigma_x *= factor, samples[i].sigma_y *= factor;
  }
  return std::make_shared<const FlowField>(field.cells(), field.extent(), std::move(samples),
                                           field.measured(), field.interpolation());
}

}  // namespace lilytank
