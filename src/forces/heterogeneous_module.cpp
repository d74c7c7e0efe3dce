// One module that is heavier or lighter than the rest.
#include "library.hpp"

namespace lilytank {
namespace {

constexpr Parameter kParameters[] = {
    {"extra", "1", 0, -0.9, 9, "mass and inertia beyond those of the others, as a share"},
    {"module", "1", 0, 0, 9999, "which one", true},
};

class HeterogeneousModule final : public ForceTerm {
 public:
  std::string_view name() const override { return "heterogeneous_module"; }
  std::string_view summary() const override {
    return "one module answers to all forces as a heavier or lighter one would; in contacts it is "
           "as others";
  }
  std::string_view equation() const override {
    return "F -> F / (1 + extra), torque likewise, of one module";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  bool transforms() const override { return true; }
  void transform(const Model&, const Kinematics& k, const Moment&, std::span<const double> p,
                 std::span<Wrench> sum) const override {
    const int i = static_cast<int>(p[1]);
    if (i >= k.modules) return;
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
