#include "bodies/laws/list.hpp"
#include "bodies/laws/pairs.hpp"

namespace lilytank::bodies {
namespace {

class StartingSpring final : public PairLaw {
 public:
  std::string_view name() const override { return "pair_spring"; }
  std::string_view equation() const override { return "F = k (s - gap) where gap < s"; }
  std::vector<LawParameter> parameters(const Typical&) const override {
    return {{"stiffness", "N/m", Kind::amplitude}, {"s", "m", Kind::positive}};
  }
  std::vector<std::vector<double>> starts(const Typical& t) const override {
    const double s = std::max(t.nearest, 1e-3 * t.middle);
    return {{1, 2 * s}, {1, 1.4 * s}};
  }
  double size(double gap, std::span<const double> p) const override {
    return gap < p[1] ? p[0] * (p[1] - gap) : 0;
  }
};

}  // namespace

const Law& pair_spring() {
  static const StartingSpring law;
  return law;
}

}  // namespace lilytank::bodies
