// A force known by its curve alone: what is left when no effect of the list has the right shape.
#include "forces/empirical_force.hpp"

#include "library.hpp"
#include "lilytank/model.hpp"
#include "pairs.hpp"

namespace lilytank {
namespace {

double size_at(const ForceCurve& curve, std::span<const double> p, double value) {
  const KnotShare at = place_on(curve, value);
  const double* v = &p[kFirstKnot];
  return v[at.first] + at.share * (v[at.second] - v[at.first]);
}

void add_pairs(const Model& model, const Kinematics& k, const ForceCurve& curve,
               std::span<const double> p, std::span<Wrench> out) {
  for_near_pairs(k, curve.high + model.module.side, [&](const NearPair& pair) {
    const double size = size_at(curve, p, pair.r - model.module.side);
    if (curve.toward == Toward::torque) {
      out[pair.i].torque += size, out[pair.j].torque += size;
    } else if (curve.toward == Toward::around) {
      const double fx = -size * pair.dy / pair.r, fy = size * pair.dx / pair.r;
      out[pair.i].fx -= fx, out[pair.i].fy -= fy, out[pair.j].fx += fx, out[pair.j].fy += fy;
    } else {
      pull_together(pair, -size, out);
    }
  });
}

class EmpiricalForce final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"variable", "1", 0, 0, 7,
       "0 radius (m), 1 heading (rad), 2 slip (m/s), 3 spin (rad/s), 4 time (s), 5 x, 6 y (m), 7 "
       "gap "
       "between modules (m)",
       true},
      {"direction", "1", 0, 0, 8,
       "0 x, 1 y, 2 outwards, 3 around, 4 along the slip, 5 to its left, 6 forward, 7 left, 8 "
       "torque; of a gap 2 apart, 3 across, 8 torque",
       true},
      {"low", "1", 0, -1e6, 1e6, "the variable at the first value"},
      {"high", "1", 1, -1e6, 1e6, "the variable at the last value; of headings one value further"},
      {"v1", "N", 0, -1, 1, "force there; of a torque in N m"},
      {"v2", "N", 0, -1, 1, "likewise"},
      {"v3", "N", 0, -1, 1, "likewise"},
      {"v4", "N", 0, -1, 1, "likewise"},
      {"v5", "N", 0, -1, 1, "likewise"},
      {"v6", "N", 0, -1, 1, "likewise"},
  };

 public:
  std::string_view name() const override { return "empirical_force"; }
  std::string_view summary() const override {
    return "a force that is given as a curve over one variable";
  }
  std::string_view equation() const override {
    return "F = f(variable) in one direction, f straight between six values from low to high; of "
           "gaps nothing beyond high";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::string objection(const Model&, std::span<const double> p) const override {
    return p[2] < p[3] ? "" : "high: it must be above low";
  }
  void add(const Model& model, const Kinematics& k, const StepContext& now,
           std::span<const double> p, std::span<Wrench> out) const override {
    const ForceCurve curve{static_cast<Along>(static_cast<int>(p[0])),
                           static_cast<Toward>(static_cast<int>(p[1])), p[2], p[3]};
    if (curve.along == Along::gap) return add_pairs(model, k, curve, p, out);
    for (int i = 0; i < k.modules; ++i) {
      const double size = size_at(curve, p, value_along(curve.along, model, k, now, i));
      const Wrench unit = unit_toward(curve.toward, model, k, now, i);
      out[i].fx += size * unit.fx, out[i].fy += size * unit.fy, out[i].torque += size * unit.torque;
    }
  }
};

}  // namespace

const ForceTerm& empirical_force() {
  static const EmpiricalForce term;
  return term;
}

}  // namespace lilytank
