// Water that must leave or enter the gap between two modules.
#include "library.hpp"
#include "lilytank/model.hpp"
#include "pairs.hpp"

namespace lilytank {
namespace {

class Lubrication final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"coefficient", "N s/m", 0, 0, 10, "force by closing speed at contact"},
      {"range", "m", 0.004, 0.0005, 0.05, "gap over which the force falls by e"},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 40,
       .variable = "pair",
       .amplitudes = {{"coefficient", 0.15}},
       .split = split_by::kLoneModule},
  };

 public:
  std::string_view name() const override { return "lubrication"; }
  std::string_view summary() const override {
    return "water in the gap between two modules resists closing and opening it";
  }
  std::string_view equation() const override {
    return "F = -coefficient exp(-g / range) dg/dt along the normal of the nearest face; nothing "
           "beyond "
           "g = 8 range";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }

  void add(const Model& model, const Kinematics& k, const StepContext&, std::span<const double> p,
           std::span<Wrench> out) const override {
    const double far = 1.42 * model.module.side + 8 * p[1];
    for_near_pairs(k, far, [&](const NearPair& pair) {
      const auto i = pair.i, j = pair.j;
      const SquareGap at = square_gap(k, pair, model.module.side);
      if (at.gap > 8 * p[1]) return;
      const double qx = at.px - pair.dx, qy = at.py - pair.dy;
      const double opening = (k.vx[j] - k.omega[j] * qy - k.vx[i] + k.omega[i] * at.py) * at.nx +
                             (k.vy[j] + k.omega[j] * qx - k.vy[i] - k.omega[i] * at.px) * at.ny;
      const double size = p[0] * opening * exp_portable(-std::fmax(0, at.gap) / p[1]);
      pull_faces(pair, at, size, out);
    });
  }
};

}  // namespace

const ForceTerm& lubrication() {
  static const Lubrication term;
  return term;
}

}  // namespace lilytank
