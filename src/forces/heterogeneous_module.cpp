// One module that is heavier or lighter than the rest.
#include <string>

#include "library.hpp"
#include "lilytank/model.hpp"

namespace lilytank {
namespace {

class HeterogeneousModule final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"extra", "1", 0, -0.9, 9, "mass and inertia beyond those of the others, as a fraction"},
      {"module", "1", 0, 0, 9999, "which one", true, ParameterKind::module},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 190,
       .variable = "module",
       .amplitudes = {{"extra", 0.4}},
       .scored = false,
       .mean_force = false,
       .growth = 2,
       .estimated = Estimated::module},
  };

 public:
  std::string_view name() const override { return "heterogeneous_module"; }
  std::string_view summary() const override {
    return "one module answers to all forces as a heavier or lighter one would; in contacts, and "
           "latched to others, it is as they are";
  }
  std::string_view equation() const override {
    return "F -> F / (1 + extra), torque likewise, of one module";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }
  std::string objection(const Model& model, std::span<const double> p) const override {
    if (p[0] == 0 || p[1] < model.module.count) return "";
    return "module: there are only " + std::to_string(model.module.count) + ", counted from 0";
  }
  bool transforms() const override { return true; }
  void transform(const Model&, const Kinematics& k, const StepContext&, std::span<const double> p,
                 std::span<Wrench> sum) const override {
    const int i = static_cast<int>(p[1]);
    // Of an assembly only the sum of forces counts: inner ones must go on cancelling each other.
    if (i >= k.modules || k.covered[i] != 0) return;
    const double share = 1 / (1 + p[0]);
    sum[i].fx *= share, sum[i].fy *= share, sum[i].torque *= share;
  }
};

}  // namespace

const ForceTerm& heterogeneous_module() {
  static const HeterogeneousModule term;
  return term;
}

}  // namespace lilytank
