#include "diagnose/slack.hpp"

#include <array>
#include <cmath>

#include "lilytank/random.hpp"

namespace lilytank {
namespace {

constexpr double kMean = 0.015, kGusts = 0.02;
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

}  // namespace

std::shared_ptr<const FlowField> loosened(const FlowField& field, std::uint64_t seed,
                                          std::int64_t run) {
  std::vector<FlowSample> samples = field.samples();
  double square = 0;
  for (const FlowSample& s : samples) square += s.mu_x * s.mu_x + s.mu_y * s.mu_y;
  const double size = kMean * std::sqrt(0.5 * square / static_cast<double>(samples.size()));
  const Smooth x(seed, run, 0, field.extent()), y(seed, run, 1, field.extent()),
      gusts(seed, run, 2, field.extent());
  const double common = kGusts * normal_pair({seed, Stream::calibrate, run, 3, 19})[0];
  const double pitch = 2 * field.extent() / field.cells();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto cells = static_cast<std::size_t>(field.cells());
    const double px = (static_cast<double>(i % cells) + 0.5) * pitch - field.extent();
    const double py = (static_cast<double>(i / cells) + 0.5) * pitch - field.extent();
    samples[i].mu_x += size * x.at(px, py), samples[i].mu_y += size * y.at(px, py);
    const double factor = std::max(0.2, 1 + common + kGusts * gusts.at(px, py));
    samples[i].sigma_x *= factor, samples[i].sigma_y *= factor;
  }
  return std::make_shared<const FlowField>(field.cells(), field.extent(), std::move(samples),
                                           field.measured(), field.interpolation());
}

}  // namespace lilytank
