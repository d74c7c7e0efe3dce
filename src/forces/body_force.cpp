// A constant push on every body.
#include "library.hpp"

namespace lilytank {
namespace {

class BodyForce final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"force_x", "N", 0, -1, 1, "push along +x"},
      {"force_y", "N", 0, -1, 1, "push along +y"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 130,
       .variable = "position",
       .amplitudes = {{"force_x", 1.5e-3}, {"force_y", 1.5e-3}},
       .two_sided = true,
       .split = split_by::kTurnedCamera},
  };

 public:
  std::string_view name() const override { return "body_force"; }
  std::string_view summary() const override { return "a constant push on every body"; }
  std::string_view equation() const override { return "F = (force_x, force_y)"; }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }

  void add(const Model&, const Kinematics&, const StepContext&, std::span<const double> p,
           std::span<Wrench> out) const override {
    for (Wrench& w : out) w.fx += p[0], w.fy += p[1];
  }
};

}  // namespace

const ForceTerm& body_force() {
  static const BodyForce term;
  return term;
}

}  // namespace lilytank
