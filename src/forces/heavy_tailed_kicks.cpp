// Rare hard knocks.
#include "library.hpp"
#include "lilytank/model.hpp"
#include "lilytank/random.hpp"

namespace lilytank {
namespace {

class HeavyTailedKicks final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"impulse", "N s", 0, 0, 0.1, "standard deviation of an impulse per axis"},
      {"rate", "1/s", 0.2, 0, 40, "knocks a second and module"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 240,
       .variable = "lag",
       .amplitudes = {{"impulse", 1.5e-3}},
       .scored = false,
       .mean_force = false,
       .growth = 2},
  };

 public:
  std::string_view name() const override { return "heavy_tailed_kicks"; }
  std::string_view summary() const override {
    return "modules are knocked at random, rarely and hard";
  }
  std::string_view equation() const override {
    return "in each interval of 25 ms with probability rate 25 ms: F = impulse / 25 ms N(0,1) per "
           "axis";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }

  void add(const Model&, const Kinematics& k, const StepContext& now, std::span<const double> p,
           std::span<Wrench> out) const override {
    if (!now.gusts) return;
    for (int i = 0; i < k.modules; ++i) {
      const Draw draw{now.seed, Stream::kick, now.gust, static_cast<std::uint32_t>(i), 0};
      if (uniform(draw) >= p[1] * kTick) continue;
      const auto z =
          normal_pair({now.seed, Stream::kick, now.gust, static_cast<std::uint32_t>(i), 1});
      out[i].fx += p[0] / kTick * z[0], out[i].fy += p[0] / kTick * z[1];
    }
  }
};

}  // namespace

const ForceTerm& heavy_tailed_kicks() {
  static const HeavyTailedKicks term;
  return term;
}

}  // namespace lilytank
