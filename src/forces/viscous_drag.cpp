// Drag in proportion to the slip.
#include "library.hpp"
#include "lilytank/model.hpp"
#include "water.hpp"

namespace lilytank {
namespace {

class ViscousDrag final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"coefficient", "N s/m", 0, -10, 10, "force by relative speed"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 100,
       .variable = "slip",
       .amplitudes = {{"coefficient", 0.03}},
       .two_sided = true,
       .split = split_by::kPumpPower,
       .growth = 2},
  };

 public:
  std::string_view name() const override { return "viscous_drag"; }
  std::string_view summary() const override {
    return "drag on a module in proportion to its velocity relative to the water";
  }
  std::string_view equation() const override {
    return "F = coefficient w, w the mean velocity of the water relative to the module";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }

  void add(const Model& model, const Kinematics& k, const StepContext& now,
           std::span<const double> p, std::span<Wrench> out) const override {
    for (int i = 0; i < k.modules; ++i) {
      const Vec2 w = slip_of(model, k, now, i);
      out[i].fx += p[0] * w.x(), out[i].fy += p[0] * w.y();
    }
  }
};

}  // namespace

const ForceTerm& viscous_drag() {
  static const ViscousDrag term;
  return term;
}

}  // namespace lilytank
