// A stream that the flow field does not know.
#include <algorithm>

#include "library.hpp"
#include "math/bulk_exp.hpp"

namespace lilytank {
namespace {

class LocalFlow final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"speed_x", "m/s", 0, -2, 2, "of the added stream in its middle"},
      {"speed_y", "m/s", 0, -2, 2, "of the added stream in its middle"},
      {"x", "m", 0, -5, 5, "middle", false, ParameterKind::place},
      {"y", "m", 0, -5, 5, "middle", false, ParameterKind::place},
      {"width", "m", 0.05, 0.005, 5, "standard deviation of its Gaussian profile"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 150,
       .variable = "position",
       .amplitudes = {{"speed_x", 0.06}, {"speed_y", 0.06}},
       .held = {{"x"}, {"y"}, {"width", 0.06, 0.02, 0.2}},
       .two_sided = true,
       .split = split_by::kOtherBodies,
       .estimated = Estimated::place},
  };

 public:
  std::string_view name() const override { return "local_flow"; }
  std::string_view summary() const override {
    return "a stream in one place beside those of the flow field";
  }
  std::string_view equation() const override {
    return "u += (speed_x, speed_y) exp(-d^2 / (2 width^2)), d the distance from (x, y)";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }
  bool perturbs_flow() const override { return true; }
  void perturb_flow(const Model&, const Kinematics& k, const StepContext&,
                    std::span<const double> p, FlowPerturbation& water) const override {
    const double width = 2 * p[4] * p[4];
    constexpr int kBlock = 64;  // bodies at a time
    double share[kBlock];
    for (int from = 0; from < k.size(); from += kBlock) {
      const int count = std::min(kBlock, k.size() - from);
      for (int j = 0; j < count; ++j) {
        const double dx = k.x[from + j] - p[2], dy = k.y[from + j] - p[3];
        share[j] = -(dx * dx + dy * dy) / width;
      }
      bulk_exp(share, count, share);
      for (int j = 0; j < count; ++j) {
        const int i = from + j;
        const double dx = k.x[i] - p[2], dy = k.y[i] - p[3];
        water.ux[i] += p[0] * share[j], water.uy[i] += p[1] * share[j];
        water.turning[i] += share[j] * (dy * p[0] - dx * p[1]) / width;
      }
    }
  }
};

}  // namespace

const ForceTerm& local_flow() {
  static const LocalFlow term;
  return term;
}

}  // namespace lilytank
