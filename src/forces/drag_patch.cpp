// A region in which the drag is stronger or weaker than elsewhere.
#include <algorithm>

#include "library.hpp"
#include "math/bulk_exp.hpp"

namespace lilytank {
namespace {

class DragPatch final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"strength", "1", 0, -1, 9, "extra drag in the middle, as a fraction of the drag elsewhere"},
      {"x", "m", 0, -5, 5, "middle", false, ParameterKind::place},
      {"y", "m", 0, -5, 5, "middle", false, ParameterKind::place},
      {"radius", "m", 0.06, 0.005, 5, "distance at which the extra drag is 1/e of that"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 290,
       .variable = "position",
       .amplitudes = {{"strength", 0.3}},
       .held = {{"x"}, {"y"}, {"radius", 0.06, 0.02, 0.2}},
       .two_sided = true,
       .split = split_by::kPumpPower,
       .estimated = Estimated::place},
  };

 public:
  std::string_view name() const override { return "drag_patch"; }
  std::string_view summary() const override {
    return "stronger or weaker drag of the water in a disc with a smooth edge, as by a film, weed "
           "or shallow water";
  }
  std::string_view equation() const override {
    return "drag (1 + strength exp(-(d / radius)^4)), d the distance from (x, y)";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }
  bool perturbs_flow() const override { return true; }
  void perturb_flow(const Model&, const Kinematics& k, const StepContext&,
                    std::span<const double> p, FlowPerturbation& water) const override {
    const double square = p[3] * p[3];
    constexpr int kBlock = 64;  // bodies at a time
    double share[kBlock];
    for (int from = 0; from < k.size(); from += kBlock) {
      const int count = std::min(kBlock, k.size() - from);
      for (int j = 0; j < count; ++j) {
        const double dx = k.x[from + j] - p[1], dy = k.y[from + j] - p[2];
        const double ratio = (dx * dx + dy * dy) / square;
        share[j] = -ratio * ratio;
      }
      bulk_exp(share, count, share);
      for (int j = 0; j < count; ++j) water.drag[from + j] *= 1 + p[0] * share[j];
    }
  }
};

}  // namespace

const ForceTerm& drag_patch() {
  static const DragPatch term;
  return term;
}

}  // namespace lilytank
