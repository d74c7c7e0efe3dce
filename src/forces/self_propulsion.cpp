// A push that is fixed in the module.
#include "library.hpp"

namespace lilytank {
namespace {

class SelfPropulsion final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"force_x", "N", 0, -1, 1, "along the module's own +x"},
      {"force_y", "N", 0, -1, 1, "along the module's own +y"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 160,
       .variable = "heading",
       .amplitudes = {{"force_x", 1e-3}, {"force_y", 1e-3}},
       .two_sided = true},
  };

 public:
  std::string_view name() const override { return "self_propulsion"; }
  std::string_view summary() const override {
    return "every module pushes itself in a direction of its own frame";
  }
  std::string_view equation() const override { return "F = R(theta) (force_x, force_y)"; }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }

  void add(const Model&, const Kinematics& k, const StepContext&, std::span<const double> p,
           std::span<Wrench> out) const override {
    for (int i = 0; i < k.modules; ++i) {
      out[i].fx += k.c[i] * p[0] - k.s[i] * p[1];
      out[i].fy += k.s[i] * p[0] + k.c[i] * p[1];
    }
  }
};

}  // namespace

const ForceTerm& self_propulsion() {
  static const SelfPropulsion term;
  return term;
}

}  // namespace lilytank
