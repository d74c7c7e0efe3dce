// The boundary layer at the wall.
#include <cmath>

#include "library.hpp"
#include "lilytank/model.hpp"
#include "water.hpp"

namespace lilytank {
namespace {

constexpr double kNothing = 1e-9;  // a share of the layer that nobody could see: far from the wall

class WallLayer final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"share", "1", 0, 0, 1, "share of the mean flow that is missing at the wall"},
      {"thickness", "m", 0.01, 0.001, 0.1,
       "distance from the wall over which the layer falls by e"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 70,
       .variable = "radius",
       .amplitudes = {{"share", 0.6}},
       .held = {{"thickness", 0.02, 0.005, 0.08}},
       .split = split_by::kOtherBodies},
  };

 public:
  std::string_view name() const override { return "wall_layer"; }
  std::string_view summary() const override {
    return "the water is slower near the wall than the flow field says";
  }
  std::string_view equation() const override {
    return "u -= share exp(-(R - r) / thickness) K_v mu(x), r the distance from the tank's centre";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }
  bool perturbs_flow() const override { return true; }
  void perturb_flow(const Model& model, const Kinematics& k, const StepContext& now,
                    std::span<const double> p, FlowPerturbation& water) const override {
    for (int i = 0; i < k.size(); ++i) {
      const double r = std::sqrt(k.x[i] * k.x[i] + k.y[i] * k.y[i]);
      const double depth = std::fmax(0, model.tank.radius - r);
      const double fall = exp_portable(-depth / p[1]), share = p[0] * fall;
      if (!(fall > kNothing)) continue;
      const Vec2 flow = mean_flow(model, now, k.x[i], k.y[i]);
      water.ux[i] -= share * flow.x(), water.uy[i] -= share * flow.y();
      // Half the curl of what is missing: the flow's own, and the layer's fall across the stream.
      const double around = r > 0 ? (k.x[i] * flow.y() - k.y[i] * flow.x()) / r : 0;
      const double curl = gradient_at(model, now, k.x[i], k.y[i]).curl() + around / p[1];
      water.turning[i] -= 0.5 * share * curl;
    }
  }
};

}  // namespace

const ForceTerm& wall_layer() {
  static const WallLayer term;
  return term;
}

}  // namespace lilytank
