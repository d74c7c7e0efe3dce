// Water that must be moved along with a module.
#include "library.hpp"
#include "lilytank/model.hpp"
#include "water.hpp"

namespace lilytank {
namespace {

// A larger one gathers all modules in the middle, where the effect of a small one cannot be
// learned.
class AddedMass final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"coefficient", "1", 0, 0, 5, "added mass, as a fraction of the displaced water's mass"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 80,
       .variable = "slip",
       .amplitudes = {{"coefficient", 0.25}},
       .split = split_by::kOtherBodies,
       .growth = 2},
  };

 public:
  std::string_view name() const override { return "added_mass"; }
  std::string_view summary() const override {
    return "a module moves water along with itself, which makes it heavier, and is carried by the "
           "flow's "
           "own acceleration";
  }
  std::string_view equation() const override {
    return "F -> (F + m_a (u . grad) u) m / (m + m_a), m_a = coefficient rho side^2 draught, u the "
           "mean "
           "flow; torque likewise with m_a side^2 / 6";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }
  bool transforms() const override { return true; }
  void transform(const Model& model, const Kinematics& k, const StepContext& now,
                 std::span<const double> p, std::span<Wrench> sum) const override {
    const ModuleParameters& module = model.module;
    const double extra = p[0] * model.flow.rho * module.side * module.side * module.draught;
    const double share = module.mass / (module.mass + extra);
    for (int i = 0; i < k.modules && extra > 0; ++i) {
      const Vec2 u = mean_flow(model, now, k.x[i], k.y[i]);
      const FlowGradient g = gradient_at(model, now, k.x[i], k.y[i]);
      const Vec2 acceleration = u.x() * g.by_x + u.y() * g.by_y;
      sum[i].fx = share * (sum[i].fx + extra * acceleration.x());
      sum[i].fy = share * (sum[i].fy + extra * acceleration.y());
      sum[i].torque *= share;
    }
  }
};

}  // namespace

const ForceTerm& added_mass() {
  static const AddedMass term;
  return term;
}

}  // namespace lilytank
