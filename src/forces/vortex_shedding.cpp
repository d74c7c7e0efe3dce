// Vortices that leave a module on its two sides in turn.
#include <cmath>

#include "library.hpp"
#include "lilytank/model.hpp"
#include "lilytank/random.hpp"
#include "water.hpp"

namespace lilytank {
namespace {

constexpr EffectDescription at_frequency(double frequency) {
  return {.order = 220,
          .variable = "lag",
          .amplitudes = {{"coefficient", 0.8}},
          .held = {{"frequency", frequency, 0.1, 3}},
          .scored = false,
          .mean_force = false,
          .growth = 2,
          .estimated = Estimated::slip_and_frequency};
}
class VortexShedding final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"coefficient", "1", 0, 0, 5, "lift coefficient"},
      {"frequency", "Hz", 0.43, 0, 20, "of shedding: about 0.13 relative speed / side"},
  };
  static constexpr EffectDescription kEffects[] = {at_frequency(0.3), at_frequency(0.8)};

 public:
  std::string_view name() const override { return "vortex_shedding"; }
  std::string_view summary() const override {
    return "a force across the relative flow that swings, out of step from module to module";
  }
  std::string_view equation() const override {
    return "F = coefficient 1/2 rho draught side |w| z x w cos(2 pi frequency t + phase), a random "
           "phase "
           "for each module";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }

  void add(const Model& model, const Kinematics& k, const StepContext& now,
           std::span<const double> p, std::span<Wrench> out) const override {
    if (!now.gusts) return;
    const double scale = 0.5 * p[0] * model.flow.rho * model.module.draught * model.module.side;
    for (int i = 0; i < k.modules; ++i) {
      const double cycles =
          p[1] * now.time + uniform({now.seed, Stream::phase, 0, static_cast<std::uint32_t>(i), 0});
      const double swing = rotation(2 * kPi * (cycles - std::floor(cycles))).c;
      const Vec2 w = slip_of(model, k, now, i);
      const double size = scale * w.norm() * swing;
      out[i].fx -= size * w.y(), out[i].fy += size * w.x();
    }
  }
};

}  // namespace

const ForceTerm& vortex_shedding() {
  static const VortexShedding term;
  return term;
}

}  // namespace lilytank
