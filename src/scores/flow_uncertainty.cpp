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
  double at(double x, double y) const {
    double sum = 0;
    for (const Wave& w : waves_) sum += rotation(w.kx * x + w.ky * y + w.phase).c;
    return sum * std::sqrt(2.0 / kWaves);
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
  const Smooth x(seed, run, 0, field.extent()), y(seed, run, 1, field.extent()),
      gusts(seed, run, 2, field.extent());
  const double common = kGustError * normal_pair({seed, Stream::calibrate, run, 3, 19})[0];
  const double pitch = 2 * field.extent() / field.cells();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto cells = static_cast<std::size_t>(field.cells());
    const double px = (static_cast<double>(i % cells) + 0.5) * pitch - field.extent();
    const double py = (static_cast<double>(i / cells) + 0.5) * pitch - field.extent();
    samples[i].mu_x += size * x.at(px, py), samples[i].mu_y += size * y.at(px, py);
    const double factor = std::max(0.2, 1 + common + kGustError * gusts.at(px, py));
    samples[i].sigma_x *= factor, samples[i].sigma_y *= factor;
  }
  return std::make_shared<const FlowField>(field.cells(), field.extent(), std::move(samples),
                                           field.measured(), field.interpolation());
}

}  // namespace lilytank
