#include "bodies/laws/drags.hpp"
#include "bodies/laws/list.hpp"

namespace lilytank::bodies {
namespace {

// Against the velocity: F = -k v, or by the second power of the speed.
class Drag final : public Law {
 public:
  explicit Drag(bool quadratic) : quadratic_(quadratic) {}
  std::string_view name() const override { return quadratic_ ? "quadratic_drag" : "linear_drag"; }
  std::string_view equation() const override { return quadratic_ ? "F = -c |v| v" : "F = -k v"; }
  std::string_view variable() const override { return "slip"; }
  std::string_view split() const override {
    return "the same body at speeds that differ by a factor of three or more";
  }
  bool possible(const Typical&) const override { return true; }
  std::vector<LawParameter> parameters(const Typical&) const override {
    return {{"coefficient", quadratic_ ? "N s^2/m^2" : "N s/m", Kind::amplitude}};
  }
  std::vector<std::vector<double>> starts(const Typical&) const override { return {{1}}; }
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    along_velocity(s, force, [&](double speed) { return quadratic_ ? -p[0] * speed : -p[0]; });
  }

 private:
  bool quadratic_;
};

}  // namespace

const Law& linear_drag() {
  static const Drag law(false);
  return law;
}

const Law& quadratic_drag() {
  static const Drag law(true);
  return law;
}

}  // namespace lilytank::bodies
