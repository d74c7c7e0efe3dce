#include "bodies/laws/list.hpp"
#include "bodies/laws/pairs.hpp"

namespace lilytank::bodies {
namespace {

// The strength is given at a gap that occurs: far from there it would hang on the exponent. Gaps
// below a fifth of that count as a fifth, so that no step meets a pole.
class PowerLaw final : public PairLaw {
 public:
  explicit PowerLaw(bool dipoles) : dipoles_(dipoles) {}
  std::string_view name() const override { return dipoles_ ? "pair_dipoles" : "pair_power_law"; }
  std::string_view equation() const override {
    return dipoles_ ? "F = A (s/gap)^4" : "F = A (s/gap)^n";
  }
  std::vector<LawParameter> parameters(const Typical&) const override {
    return {{"strength", "N", Kind::amplitude},
            {"s", "m", Kind::fixed},
            {"n", "1", dipoles_ ? Kind::fixed : Kind::positive}};
  }
  std::vector<std::vector<double>> starts(const Typical& t) const override {
    const double s = std::max(t.nearest, 1e-3 * t.middle);
    if (dipoles_) return {{1, s, 4}};
    return {{1, s, 2}, {1, s, 4}};
  }
  double size(double gap, std::span<const double> p) const override {
    return p[0] * std::pow(p[1] / std::max(gap, p[1] / 5), p[2]);
  }

 private:
  bool dipoles_;
};

}  // namespace

const Law& pair_power_law() {
  static const PowerLaw law(false);
  return law;
}

const Law& pair_dipoles() {
  static const PowerLaw law(true);
  return law;
}

}  // namespace lilytank::bodies
