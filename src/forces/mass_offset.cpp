// A centre of mass that is not in the middle.
#include "library.hpp"

namespace lilytank {
namespace {

class MassOffset final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"forward", "m", 0, -0.02, 0.02, "of the centre of mass, along the module's own +x"},
      {"left", "m", 0, -0.02, 0.02, "along the module's own +y"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 180,
       .variable = "heading",
       .amplitudes = {{"forward", 1e-3}, {"left", 1e-3}},
       .two_sided = true},
  };

 public:
  std::string_view name() const override { return "mass_offset"; }
  std::string_view summary() const override {
    return "the forces on a module turn it, as its centre of mass is not in the middle";
  }
  std::string_view equation() const override {
    return "torque -= (R(theta) (forward, left)) x F, F the sum of all forces";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }
  bool transforms() const override { return true; }
  void transform(const Model&, const Kinematics& k, const StepContext&, std::span<const double> p,
                 std::span<Wrench> sum) const override {
    for (int i = 0; i < k.modules; ++i) {
      const double x = k.c[i] * p[0] - k.s[i] * p[1], y = k.s[i] * p[0] + k.c[i] * p[1];
      sum[i].torque -= x * sum[i].fy - y * sum[i].fx;
    }
  }
};

}  // namespace

const ForceTerm& mass_offset() {
  static const MassOffset term;
  return term;
}

}  // namespace lilytank
