// The wake behind a module.
#include <algorithm>
#include <cmath>

#include "library.hpp"
#include "lilytank/model.hpp"
#include "water.hpp"

namespace lilytank {
namespace {

constexpr double kWide = 5;            // deviations beyond which the wake is nothing
constexpr int kShieldedTogether = 64;  // modules in the wake that are looked at together

// The moment without what terms have added to the water so far.
StepContext still(StepContext now) {
  now.ux = now.uy = now.turning = {};
  return now;
}

// What the modules [first, last) miss: of the water as it was, so that no order of modules counts.
void shield(const Model& model, const Kinematics& k, const StepContext& now,
            std::span<const double> p, int first, int last, FlowPerturbation& water) {
  const double far = 4 * p[1] + model.module.side, wide = kWide * p[2];
  double left[kShieldedTogether];  // of the relative flow at each
  std::fill(left, left + kShieldedTogether, 1.0);
  for (int front = 0; front < k.modules; ++front) {
    const Vec2 slip = slip_of(model, k, now, front);
    const double size = slip.norm();
    if (size == 0) continue;
    const double cx = slip.x() / size, cy = slip.y() / size;
    for (int behind = first; behind < last; ++behind) {
      const double dx = k.x[behind] - k.x[front], dy = k.y[behind] - k.y[front];
      const double s = dx * cx + dy * cy, y = dx * cy - dy * cx;
      if (s <= 0 || std::fabs(y) > wide || s * s + y * y >= far * far) continue;
      const double lost = p[0] * exp_portable(-s / p[1] - y * y / (2 * p[2] * p[2]));
      const double deficit = std::fmin(lost, left[behind - first]);
      left[behind - first] -= deficit;
      const Vec2 own = slip_of(model, k, now, behind);
      water.ux[behind] -= deficit * own.x(), water.uy[behind] -= deficit * own.y();
    }
  }
}

class WakeShielding final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"share", "1", 0, 0, 1, "share of the relative flow that is missing right behind a module"},
      {"length", "m", 0.08, 0.01, 0.5,
       "distance downstream over which the wake decays by a factor e"},
      {"width", "m", 0.02, 0.005, 0.2, "standard deviation of the wake across the stream"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 50,
       .variable = "pair",
       .amplitudes = {{"share", 0.4}},
       .split = split_by::kLoneModule},
  };

 public:
  std::string_view name() const override { return "wake_shielding"; }
  std::string_view summary() const override {
    return "a module in the wake of another meets a weaker flow";
  }
  std::string_view equation() const override {
    return "u_i += share exp(-s / length - y^2 / (2 width^2)) (v_i - u_i), s > 0 and y the place "
           "of i along and across the relative flow at j; of many j together no more than all of "
           "it";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }
  bool perturbs_flow() const override { return true; }
  void perturb_flow(const Model& model, const Kinematics& k, const StepContext& now,
                    std::span<const double> p, FlowPerturbation& water) const override {
    for (int first = 0; first < k.modules; first += kShieldedTogether) {
      shield(model, k, still(now), p, first, std::min(first + kShieldedTogether, k.modules), water);
    }
  }
};

}  // namespace

const ForceTerm& wake_shielding() {
  static const WakeShielding term;
  return term;
}

}  // namespace lilytank
