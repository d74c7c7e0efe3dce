// The meniscus between a module and the wall.
#include <cmath>

#include "library.hpp"
#include "lilytank/model.hpp"

namespace lilytank {
namespace {

constexpr EffectDescription near_wall(double range, double strength) {
  return {.order = 60,
          .variable = "radius",
          .amplitudes = {{"strength", strength}},
          .held = {{"range", range, 0.002, 0.05}},
          .two_sided = true,
          .split = split_by::kOtherBodies};
}
class WallForce final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"strength", "N", 0, -0.1, 0.1, "force towards the wall at contact"},
      {"range", "m", 0.004, 0.0005, 0.1, "gap over which the force falls by e"},
  };
  static constexpr EffectDescription kEffects[] = {near_wall(0.005, 0.01), near_wall(0.02, 5e-3)};

 public:
  std::string_view name() const override { return "wall_force"; }
  std::string_view summary() const override {
    return "the wall attracts or repels modules that are near it";
  }
  std::string_view equation() const override {
    return "F = strength exp(-g / range) outwards, g = max(0, R - r - side / 2), r the distance "
           "from the "
           "tank's centre";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }

  void add(const Model& model, const Kinematics& k, const StepContext&, std::span<const double> p,
           std::span<Wrench> out) const override {
    for (int i = 0; i < k.modules; ++i) {
      const double r = std::sqrt(k.x[i] * k.x[i] + k.y[i] * k.y[i]);
      const double gap = std::fmax(0, model.tank.radius - r - model.module.side / 2);
      if (r == 0 || gap > 8 * p[1]) continue;
      const double size = p[0] * exp_portable(-gap / p[1]) / r;
      out[i].fx += size * k.x[i], out[i].fy += size * k.y[i];
    }
  }
};

}  // namespace

const ForceTerm& wall_force() {
  static const WallForce term;
  return term;
}

}  // namespace lilytank
