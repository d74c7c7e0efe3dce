// A random force that depends on where and how a body moves.
#include <cmath>

#include "library.hpp"
#include "lilytank/model.hpp"
#include "lilytank/random.hpp"
#include "water.hpp"

namespace lilytank {
namespace {

constexpr EffectDescription by(std::string_view parameter, double size, std::string_view variable) {
  return {.order = 230,
          .variable = variable,
          .amplitudes = {{parameter, size}},
          .scored = false,
          .mean_force = false,
          .growth = 2};
}
class StateDependentNoise final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"by_radius", "N", 0, 0, 1,
       "standard deviation per axis at the wall, growing in proportion to the radius"},
      {"by_slip", "N s/m", 0, 0, 10, "standard deviation per axis and unit of relative speed"},
  };
  static constexpr EffectDescription kEffects[] = {by("by_radius", 0.012, "radius"),
                                                   by("by_slip", 0.06, "slip")};

 public:
  std::string_view name() const override { return "state_dependent_noise"; }
  std::string_view summary() const override {
    return "a random force that grows with the distance from the tank's centre, or with the slip";
  }
  std::string_view equation() const override {
    return "F = (by_radius r / R + by_slip |w|) sqrt(25 ms / dt) N(0,1) per axis, drawn for each "
           "module "
           "and step";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }

  void add(const Model& model, const Kinematics& k, const StepContext& now,
           std::span<const double> p, std::span<Wrench> out) const override {
    if (!now.gusts) return;
    const double draws = std::sqrt(static_cast<double>(model.steps_per_tick));
    for (int i = 0; i < k.modules; ++i) {
      const double r = std::sqrt(k.x[i] * k.x[i] + k.y[i] * k.y[i]);
      const double slip = p[1] == 0 ? 0 : slip_of(model, k, now, i).norm();
      const double sigma = draws * (p[0] * r / model.tank.radius + p[1] * slip);
      const auto z =
          normal_pair({now.seed, Stream::state_noise, now.step, static_cast<std::uint32_t>(i), 0});
      out[i].fx += sigma * z[0], out[i].fy += sigma * z[1];
    }
  }
};

}  // namespace

const ForceTerm& state_dependent_noise() {
  static const StateDependentNoise term;
  return term;
}

}  // namespace lilytank
