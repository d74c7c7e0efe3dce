// Eddies that live for a while and are felt by all bodies near them.
#include <cmath>

#include "library.hpp"
#include "lilytank/model.hpp"
#include "lilytank/random.hpp"

namespace lilytank {
namespace {

constexpr Parameter kParameters[] = {
    {"deviation", "m/s", 0, 0, 2, "of the eddies' velocity per axis"},
    {"time", "s", 0.5, 0.01, 100, "over which they fade by e"},
    {"length", "m", 0.06, 0.005, 10, "over which the velocity of neighbours is alike"},
    {"share", "1", 0, 0, 1, "of the variance of the flow's own gusts that are such eddies"},
};

constexpr int kWaves = 32;

// One wave of the eddies: u = amplitude (-sin a, cos a) cos(k . x + w t + phase), k along a, so the
// flow is free of divergence. Normal k gives a correlation exp(-r^2 / (2 length^2)) of the stream
// function's gradient, Cauchy-distributed w one of exp(-t / time) [random Fourier features].
struct Wave {
  double kx, ky;  // 1/m
  double w;       // 1/s
  double phase;   // rad
  double ax, ay;  // direction of the velocity, times sqrt(2 / waves)
};

Wave wave_of(std::uint64_t seed, std::uint32_t m, double time, double length) {
  const auto z = normal_pair({seed, Stream::eddies, 0, m, 0});
  const double turn = uniform({seed, Stream::eddies, 0, m, 1}) - 0.5;
  const double phase = 2 * kPi * uniform({seed, Stream::eddies, 0, m, 2});
  const double size = std::sqrt(z[0] * z[0] + z[1] * z[1]);
  const Rot half = rotation(kPi * turn);
  // Both axes have half of the square of the amplitude each, on average over directions.
  const double share = size > 0 ? std::sqrt(4.0 / kWaves) / size : 0;
  return {z[0] / length, z[1] / length, half.s / half.c / time, phase, -z[1] * share, z[0] * share};
}

// cos of an angle of any size.
double cosine(double angle) {
  const double turns = angle / (2 * kPi);
  return rotation(2 * kPi * (turns - std::floor(turns))).c;
}

class CorrelatedGusts final : public ForceTerm {
 public:
  std::string_view name() const override { return "correlated_gusts"; }
  std::string_view summary() const override {
    return "eddies: gusts that last, and that bodies near each other share";
  }
  std::string_view equation() const override {
    return "u += (deviation + K_v sqrt(share) sigma) e, sigma the flow's own deviation, which is "
           "left with sqrt(1 - share) of itself; e a random flow without divergence, of deviation "
           "1 per axis, correlated over `time` (exponentially) and `length`: a sum of 32 waves";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  bool stirs() const override { return true; }
  void stir(const Model& model, const Kinematics& k, const Moment& now, std::span<const double> p,
            Stirring& water) const override {
    if (!now.gusts || (p[0] == 0 && p[3] == 0)) return;
    Wave waves[kWaves];
    for (std::uint32_t m = 0; m < kWaves; ++m) waves[m] = wave_of(now.seed, m, p[1], p[2]);
    const double own = std::sqrt(p[3]) * model.flow.K_v * water.gain;
    for (int i = 0; i < k.size(); ++i) {
      double ex = 0, ey = 0;
      for (const Wave& wave : waves) {
        const double swing =
            cosine(wave.kx * k.x[i] + wave.ky * k.y[i] + wave.w * now.time + wave.phase);
        ex += swing * wave.ax, ey += swing * wave.ay;
      }
      const FlowSample f = p[3] > 0 ? field_now(model, now).at(k.x[i], k.y[i]) : FlowSample{};
      water.ux[i] += (p[0] + own * f.sigma_x) * ex, water.uy[i] += (p[0] + own * f.sigma_y) * ey;
    }
    water.gust_gain *= std::sqrt(1 - p[3]);
  }
};

}  // namespace

const ForceTerm& correlated_gusts() {
  static const CorrelatedGusts term;
  return term;
}

}  // namespace lilytank
