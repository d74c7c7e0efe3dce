// Attraction of modules that are near each other, as of menisci between floating bodies.
#include <cmath>

#include "library.hpp"
#include "lilytank/model.hpp"

namespace lilytank {
namespace {

constexpr Parameter kParameters[] = {
    {"strength", "N", 0, 0, 0.1, "force at contact"},
    {"range", "m", 0.012, 0.001, 0.1, "gap over which the force falls by e"},
};

class PairAttraction final : public ForceTerm {
 public:
  std::string_view name() const override { return "pair_attraction"; }
  std::string_view summary() const override {
    return "attraction between modules along the line of their centres, falling with the gap";
  }
  std::string_view equation() const override {
    return "F = strength exp(-g / range), g = max(0, r - side), r the distance of the centres; "
           "nothing beyond g = 8 range";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }

  void add(const Model& model, const Kinematics& k, const Moment&, std::span<const double> p,
           std::span<Wrench> out) const override {
    const double far = model.module.side + 8 * p[1];
    for (int i = 0; i < k.modules; ++i) {
      for (int j = i + 1; j < k.modules; ++j) {
        const double dx = k.x[j] - k.x[i], dy = k.y[j] - k.y[i], square = dx * dx + dy * dy;
        if (square >= far * far || square == 0) continue;
        const double r = std::sqrt(square), gap = std::fmax(0, r - model.module.side);
        const double size = p[0] * exp_portable(-gap / p[1]) / r;
        out[i].fx += size * dx, out[i].fy += size * dy;
        out[j].fx -= size * dx, out[j].fy -= size * dy;
      }
    }
  }
};

}  // namespace

const ForceTerm& pair_attraction() {
  static const PairAttraction term;
  return term;
}

}  // namespace lilytank
