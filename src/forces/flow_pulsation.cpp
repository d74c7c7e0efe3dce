// Pumps that pulsate.
#include <cmath>

#include "library.hpp"

namespace lilytank {
namespace {

class FlowPulsation final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"share", "1", 0, 0, 1, "amplitude, as a fraction of the flow"},
      {"frequency", "Hz", 0.9, 0, 20, "of the pulsation"},
      {"phase", "rad", 0, -6.2832, 6.2832, "at time 0", false, ParameterKind::phase},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 200,
       .variable = "time",
       .amplitudes = {{"share", 0.15}},
       .held = {{"frequency", 0.9}},
       .scored = false,
       .mean_force = false,
       .growth = 2,
       .estimated = Estimated::gain_and_frequency},
  };

 public:
  std::string_view name() const override { return "flow_pulsation"; }
  std::string_view summary() const override { return "the whole flow rises and falls in time"; }
  std::string_view equation() const override {
    return "u *= 1 + share cos(2 pi frequency t + phase), mean and standard deviation";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }
  bool perturbs_flow() const override { return true; }
  bool sets_gain() const override { return true; }
  void perturb_flow(const Model&, const Kinematics&, const StepContext& now,
                    std::span<const double> p, FlowPerturbation& water) const override {
    const double cycles = p[1] * now.time;
    const double angle = 2 * kPi * (cycles - std::floor(cycles)) + p[2];
    water.gain *= 1 + p[0] * rotation(angle).c;
  }
};

}  // namespace

const ForceTerm& flow_pulsation() {
  static const FlowPulsation term;
  return term;
}

}  // namespace lilytank
