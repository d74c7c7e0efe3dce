// The lee behind a module.
#include "library.hpp"
#include "lilytank/model.hpp"
#include "pairs.hpp"
#include "water.hpp"

namespace lilytank {
namespace {

constexpr Parameter kParameters[] = {
    {"share", "1", 0, 0, 1, "share of the relative flow that is missing right behind a module"},
    {"length", "m", 0.08, 0.01, 0.5, "distance downstream over which the lee falls by e"},
    {"width", "m", 0.02, 0.005, 0.2, "deviation of the lee across the stream"},
};

// The moment without what terms have added to the water so far.
Moment still(Moment now) {
  now.ux = now.uy = {};
  return now;
}

class WakeShielding final : public ForceTerm {
 public:
  std::string_view name() const override { return "wake_shielding"; }
  std::string_view summary() const override {
    return "a module in the lee of another meets less of the flow";
  }
  std::string_view equation() const override {
    return "u_i += share exp(-s / length - y^2 / (2 width^2)) (v_i - u_i), s > 0 and y the place "
           "of i "
           "along and across the relative flow at j";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  bool stirs() const override { return true; }
  void stir(const Model& model, const Kinematics& k, const Moment& now, std::span<const double> p,
            Stirring& water) const override {
    const double far = 4 * p[1] + model.module.side;
    // In one pass over pairs from the water as it was, so that no order of modules counts.
    for_near_pairs(k, far, [&](const NearPair& pair) {
      for (const bool swapped : {false, true}) {
        const int front = swapped ? pair.j : pair.i, lee = swapped ? pair.i : pair.j;
        const double sign = swapped ? -1 : 1;
        const Vec2 slip = slip_of(model, k, still(now), front);
        const double size = slip.norm();
        if (size == 0) continue;
        const double s = sign * (pair.dx * slip.x() + pair.dy * slip.y()) / size;
        const double y = (pair.dx * slip.y() - pair.dy * slip.x()) / size;
        if (s <= 0) continue;
        const double deficit = p[0] * exp_portable(-s / p[1] - y * y / (2 * p[2] * p[2]));
        const Vec2 own = slip_of(model, k, still(now), lee);
        water.ux[lee] -= deficit * own.x(), water.uy[lee] -= deficit * own.y();
      }
    });
  }
};

}  // namespace

const ForceTerm& wake_shielding() {
  static const WakeShielding term;
  return term;
}

}  // namespace lilytank
