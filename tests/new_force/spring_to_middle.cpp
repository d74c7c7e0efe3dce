// A pull towards the middle of the tank, as somebody might add it.
#include "library.hpp"

namespace lilytank {
namespace {

class SpringToMiddle final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"stiffness", "N/m", 0, 0, 1, "force by distance from the middle"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.variable = "radius", .amplitudes = {{"stiffness", 0.02}}},
  };

 public:
  std::string_view name() const override { return "spring_to_middle"; }
  std::string_view summary() const override { return "a pull towards the middle of the tank"; }
  std::string_view equation() const override { return "F = -stiffness (x, y)"; }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }

  void add(const Model&, const Kinematics& k, const StepContext&, std::span<const double> p,
           std::span<Wrench> out) const override {
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].fx -= p[0] * k.x[i], out[i].fy -= p[0] * k.y[i];
    }
  }
};

}  // namespace

const ForceTerm& spring_to_middle() {
  static const SpringToMiddle term;
  return term;
}

}  // namespace lilytank
