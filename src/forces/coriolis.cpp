// A deflection at right angles to the motion.
#include "library.hpp"
#include "lilytank/model.hpp"

namespace lilytank {
namespace {

class Coriolis final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"rate", "1/s", 0, -10, 10, "acceleration to the left by speed"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 120,
       .variable = "slip",
       .amplitudes = {{"rate", 0.4}},
       .two_sided = true,
       .split = split_by::kTurnedCamera},
  };

 public:
  std::string_view name() const override { return "coriolis"; }
  std::string_view summary() const override {
    return "every body is deflected at right angles to its velocity, as in a frame that turns";
  }
  std::string_view equation() const override { return "F = m rate z x v"; }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }

  void add(const Model& model, const Kinematics& k, const StepContext&, std::span<const double> p,
           std::span<Wrench> out) const override {
    for (int i = 0; i < k.size(); ++i) {
      const double m = i < k.modules ? model.module.mass : model.ball.mass;
      out[i].fx -= m * p[0] * k.vy[i];
      out[i].fy += m * p[0] * k.vx[i];
    }
  }
};

}  // namespace

const ForceTerm& coriolis() {
  static const Coriolis term;
  return term;
}

}  // namespace lilytank
