// Magnets of modules that act at a distance.
#include "library.hpp"
#include "lilytank/model.hpp"
#include "pairs.hpp"

namespace lilytank {
namespace {

// With the dipole along the module's axis (the default) and across.
class MagneticDipole final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"strength", "N", 0, 0, 1, "pull of two dipoles on one axis whose centres are a side apart"},
      {"angle", "rad", 0, -6.2832, 6.2832, "direction of the dipole in the module's frame", false,
       ParameterKind::direction},
  };
  static constexpr EffectDescription kEffects[] = {
      {.order = 20,
       .variable = "pair",
       .amplitudes = {{"strength", 0.012}},
       .split = split_by::kLoneModule},
      {.order = 20,
       .variable = "pair",
       .amplitudes = {{"strength", 0.012}},
       .held = {{"angle", kPi / 2}},
       .split = split_by::kLoneModule},
  };

 public:
  std::string_view name() const override { return "magnetic_dipole"; }
  std::string_view summary() const override {
    return "in-plane magnetic dipoles fixed in the modules attract, repel and turn each other";
  }
  std::string_view equation() const override {
    return "F = strength/2 (side/r)^4 [(m1.n) m2 + (m2.n) m1 + (m1.m2) n - 5 (m1.n)(m2.n) n] on 2, "
           "-F on "
           "1; torque m x B, m unit vectors, n from 1 to 2; nothing beyond 10 sides";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override { return kEffects; }

  void add(const Model& model, const Kinematics& k, const StepContext&, std::span<const double> p,
           std::span<Wrench> out) const override {
    const Rot turned = rotation(p[1]);
    const double side = model.module.side;
    for_near_pairs(k, 10 * side, [&](const NearPair& pair) {
      const auto [i, j, dx, dy, r] = pair;
      const Rot ri = compose({k.c[i], k.s[i]}, turned), rj = compose({k.c[j], k.s[j]}, turned);
      const Vec2 n(dx / r, dy / r), mi(ri.c, ri.s), mj(rj.c, rj.s);
      const double ni = mi.dot(n), nj = mj.dot(n), ratio = side / r, square = ratio * ratio;
      const double size = 0.5 * p[0] * square * square;
      const Vec2 f = size * (ni * mj + nj * mi + (mi.dot(mj) - 5 * ni * nj) * n);
      // B of the other dipole, in the unit in which size r / 3 = strength/6 side (side/r)^3.
      const double field = size * r / 3;
      out[i].fx -= f.x(), out[i].fy -= f.y();
      out[j].fx += f.x(), out[j].fy += f.y();
      out[i].torque += field * cross(mi, 3 * nj * n - mj);
      out[j].torque += field * cross(mj, 3 * ni * n - mi);
    });
  }
};

}  // namespace

const ForceTerm& magnetic_dipole() {
  static const MagneticDipole term;
  return term;
}

}  // namespace lilytank
