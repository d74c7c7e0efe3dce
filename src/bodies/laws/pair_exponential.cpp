#include "bodies/laws/list.hpp"
#include "bodies/laws/pairs.hpp"

namespace lilytank::bodies {
namespace {

class Exponential final : public PairLaw {
 public:
  std::string_view name() const override { return "pair_exponential"; }
  std::string_view equation() const override { return "F = A exp(-(gap - s)/l)"; }
  std::vector<LawParameter> parameters(const Typical&) const override {
    return {{"strength", "N", Kind::amplitude},
            {"s", "m", Kind::fixed},
            {"range", "m", Kind::positive}};
  }
  std::vector<std::vector<double>> starts(const Typical& t) const override {
    const double s = std::max(t.nearest, 1e-3 * t.middle);
    return {{1, s, s / 3}, {1, s, s}};
  }
  double size(double gap, std::span<const double> p) const override {
    return p[0] * std::exp(std::min(-(gap - p[1]) / p[2], 20.0));
  }
};

}  // namespace

const Law& pair_exponential() {
  static const Exponential law;
  return law;
}

}  // namespace lilytank::bodies
