// A constant torque on every module.
#include "library.hpp"

namespace lilytank {
namespace {

class SpinTorque final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"torque", "N m", 0, -0.01, 0.01, "counter-clockwise"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 170, .variable = "spin", .amplitudes = {{"torque", 1.2e-5}}, .two_sided = true},
  };

 public:
  std::string_view name() const override { return "spin_torque"; }
  std::string_view summary() const override { return "every module is turned the same way"; }
  std::string_view equation() const override { return "torque = constant"; }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }

  void add(const Model&, const Kinematics& k, const StepContext&, std::span<const double> p,
           std::span<Wrench> out) const override {
    for (int i = 0; i < k.modules; ++i) out[i].torque += p[0];
  }
};

}  // namespace

const ForceTerm& spin_torque() {
  static const SpinTorque term;
  return term;
}

}  // namespace lilytank
