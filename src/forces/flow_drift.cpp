// Pumps that fade or gain.
#include <cmath>

#include "library.hpp"

namespace lilytank {
namespace {

class FlowDrift final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"rate", "1/s", 0, -0.1, 0.1, "relative growth of the flow a second"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 140, .variable = "time", .amplitudes = {{"rate", 5e-4}}, .two_sided = true},
  };

 public:
  std::string_view name() const override { return "flow_drift"; }
  std::string_view summary() const override { return "the whole flow grows or fades in time"; }
  std::string_view equation() const override {
    return "u *= max(0, 1 + rate t), mean and standard deviation";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }
  bool perturbs_flow() const override { return true; }
  bool sets_gain() const override { return true; }
  void perturb_flow(const Model&, const Kinematics&, const StepContext& now,
                    std::span<const double> p, FlowPerturbation& water) const override {
    water.gain *= std::fmax(0, 1 + p[0] * now.time);
  }
};

}  // namespace

const ForceTerm& flow_drift() {
  static const FlowDrift term;
  return term;
}

}  // namespace lilytank
