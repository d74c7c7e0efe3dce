// Drag on the spin of a module.
#include "library.hpp"
#include "lilytank/model.hpp"
#include "water.hpp"

namespace lilytank {
namespace {

class RotationalDrag final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"coefficient", "N m s", 0, -0.01, 0.01, "torque by spin relative to the water"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 110, .variable = "spin", .amplitudes = {{"coefficient", 5e-6}}, .two_sided = true},
  };

 public:
  std::string_view name() const override { return "rotational_drag"; }
  std::string_view summary() const override { return "the water turns a module along with itself"; }
  std::string_view equation() const override {
    return "torque = coefficient (curl u / 2 - omega), u the mean flow with its perturbations";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }

  void add(const Model& model, const Kinematics& k, const StepContext& now,
           std::span<const double> p, std::span<Wrench> out) const override {
    for (int i = 0; i < k.modules; ++i) {
      double turning = gradient_at(model, now, k.x[i], k.y[i]).curl() / 2;
      if (!now.turning.empty()) turning += now.turning[i];
      out[i].torque += p[0] * (turning - k.omega[i]);
    }
  }
};

}  // namespace

const ForceTerm& rotational_drag() {
  static const RotationalDrag term;
  return term;
}

}  // namespace lilytank
