// Lift on a module that spins in a stream.
#include "library.hpp"
#include "lilytank/model.hpp"
#include "water.hpp"

namespace lilytank {
namespace {

class MagnusLift final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"coefficient", "1", 0, -5, 5, "share of the lift of an ideal cylinder of the module's area"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 90, .variable = "spin", .amplitudes = {{"coefficient", 0.3}}, .two_sided = true},
  };

 public:
  std::string_view name() const override { return "magnus_lift"; }
  std::string_view summary() const override {
    return "lift across the relative flow on a spinning module";
  }
  std::string_view equation() const override {
    return "F = -coefficient rho draught (2 side^2 omega) z x w, w the water's velocity relative "
           "to the "
           "module (Kutta and Joukowski)";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }

  void add(const Model& model, const Kinematics& k, const StepContext& now,
           std::span<const double> p, std::span<Wrench> out) const override {
    const double side = model.module.side;
    const double scale = p[0] * model.flow.rho * model.module.draught * 2 * side * side;
    for (int i = 0; i < k.modules; ++i) {
      const Vec2 w = slip_of(model, k, now, i);
      out[i].fx += scale * k.omega[i] * w.y();
      out[i].fy -= scale * k.omega[i] * w.x();
    }
  }
};

}  // namespace

const ForceTerm& magnus_lift() {
  static const MagnusLift term;
  return term;
}

}  // namespace lilytank
