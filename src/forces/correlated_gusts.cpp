// Eddies that live for a while and are felt by all bodies near them.
#include <algorithm>
#include <cmath>

#include "eddies_kernel.hpp"
#include "library.hpp"
#include "lilytank/model.hpp"
#include "lilytank/random.hpp"

namespace lilytank {
namespace {

constexpr EffectDescription of_scale(double time, double length) {
  return {.order = 210,
          .variable = "lag",
          .amplitudes = {{"share", 0.15}},
          .held = {{"time", time, 0.08, 3}, {"length", length, 0.01, 0.25}},
          .scored = false,
          .mean_force = false};
}

// Waves u = amplitude (-sin a, cos a) cos(k . x + w t + phase), k along a, so the flow is free of
// divergence. Normal k gives a correlation exp(-r^2 / (2 length^2)) of the stream function's
// gradient, Cauchy-distributed w one of exp(-t / time) [random Fourier features].
EddyWaves waves_of(std::uint64_t seed, double time, double length, double now, double half_side) {
  EddyWaves out;
  const auto wide = static_cast<float>(1 / (2 * kPi * length));
  const double turns = now / (2 * kPi * time);
  for (int first = 0; first < kWaves; first += kBulkBodies) {
    const Draw draw{seed, Stream::eddies, 0, static_cast<std::uint32_t>(first), 0};
    alignas(64) float z[4 * kBulkBodies];
    alignas(64) std::uint32_t phase[kBulkBodies];
    bulk_normals(draw, 4, z);
    bulk_words({seed, Stream::eddies, 0, static_cast<std::uint32_t>(first), 1}, phase);
    for (int i = 0; i < kBulkBodies; ++i) {
      const int m = first + i;
      const float x = z[i], y = z[kBulkBodies + i];
      // Both axes have half of the square of the amplitude each, on average over directions.
      const float size = std::sqrt(x * x + y * y);
      const float share = size > 0 ? std::sqrt(4.0f / kWaves) / size : 0.0f;
      out.kx[m] = wide * x, out.ky[m] = wide * y, out.ax[m] = -share * y, out.ay[m] = share * x;
      // A ratio of normals is Cauchy-distributed. In double precision: it turns for hours.
      const double over = static_cast<double>(z[2 * kBulkBodies + i]);
      const double under = static_cast<double>(z[3 * kBulkBodies + i]);
      // Both are 0 where the uniform number that they come from is nearest to 1.
      const double ratio = under != 0 ? over / under : 0;
      const double offset = ratio * turns + 0x1p-32 * phase[i];
      out.offset[m] = static_cast<float>(offset - std::floor(offset + 0.5));
    }
  }
  find_differences(static_cast<float>(half_side), out);
  return out;
}

class CorrelatedGusts final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"deviation", "m/s", 0, 0, 2, "standard deviation of the eddies' velocity per axis"},
      {"time", "s", 0.5, 0.01, 100, "over which they fade by e"},
      {"length", "m", 0.06, 0.005, 10, "over which the velocity of neighbours is alike"},
      {"share", "1", 0, 0, 1, "of the variance of the flow's own gusts that are such eddies"},
  };
  static constexpr EffectDescription kEffects[] = {of_scale(0.25, 0.03), of_scale(0.25, 0.08),
                                                   of_scale(1, 0.03), of_scale(1, 0.08)};

 public:
  std::string_view name() const override { return "correlated_gusts"; }
  std::string_view summary() const override {
    return "eddies: gusts that last, and that bodies near each other share";
  }
  std::string_view equation() const override {
    return "u += (deviation + K_v sqrt(share) sigma) e, sigma the flow's own deviation, which is "
           "left with sqrt(1 - share) of itself; e a random flow without divergence, of deviation "
           "1 per axis, correlated over `time` (exponentially) and `length`: a sum of 32 waves, "
           "whose curl turns modules along";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }
  bool perturbs_flow() const override { return true; }
  void perturb_flow(const Model& model, const Kinematics& k, const StepContext& now,
                    std::span<const double> p, FlowPerturbation& water) const override {
    if (!now.gusts || (p[0] == 0 && p[3] == 0)) return;
    const EddyWaves waves = waves_of(now.seed, p[1], p[2], now.time, model.module.side / 2);
    const double own = std::sqrt(p[3]) * model.flow.K_v * water.gain;
    for (int first = 0; first < k.size(); first += kBulkBodies) {
      const int count = std::min(kBulkBodies, k.size() - first);
      EddyBlock e{};
      for (int i = 0; i < count; ++i) {
        e.x[i] = static_cast<float>(k.x[first + i]), e.y[i] = static_cast<float>(k.y[first + i]);
      }
      sum_eddies(waves, e);
      for (int j = 0; j < count; ++j) {
        const int i = first + j;
        const FlowSample f = p[3] > 0 ? field_now(model, now).at(k.x[i], k.y[i]) : FlowSample{};
        const double along_x = p[0] + own * f.sigma_x, along_y = p[0] + own * f.sigma_y;
        water.ux[i] += along_x * static_cast<double>(e.ux[j]);
        water.uy[i] += along_y * static_cast<double>(e.uy[j]);
        water.turning[i] += 0.5 * (along_y * static_cast<double>(e.y_by_x[j]) -
                                   along_x * static_cast<double>(e.x_by_y[j]));
      }
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
