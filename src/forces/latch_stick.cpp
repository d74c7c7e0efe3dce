// Residual adhesion of latches that touch.
#include "library.hpp"
#include "lilytank/model.hpp"
#include "pairs.hpp"

namespace lilytank {
namespace {

class LatchStick final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"strength", "N", 0, 0, 1, "force at contact"},
      {"range", "m", 0.0002, 0.00005, 0.005, "gap over which the force falls by e"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 30,
       .variable = "pair",
       .amplitudes = {{"strength", 0.02}},
       .split = split_by::kLatches},
  };

 public:
  std::string_view name() const override { return "latch_stick"; }
  std::string_view summary() const override { return "modules that touch cling together"; }
  std::string_view equation() const override {
    return "F = strength exp(-g / range) along the normal of the nearest face, where the squares "
           "face "
           "each other, g the gap; nothing beyond 8 range";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }

  void add(const Model& model, const Kinematics& k, const StepContext&, std::span<const double> p,
           std::span<Wrench> out) const override {
    const double far = 1.42 * model.module.side + 8 * p[1];
    for_near_pairs(k, far, [&](const NearPair& pair) {
      const SquareGap at = square_gap(k, pair, model.module.side);
      if (at.gap > 8 * p[1]) return;
      const double size = p[0] * exp_portable(-std::fmax(0, at.gap) / p[1]);
      pull_faces(pair, at, size, out);
    });
  }
};

}  // namespace

const ForceTerm& latch_stick() {
  static const LatchStick term;
  return term;
}

}  // namespace lilytank
