#include "bodies/laws/drags.hpp"
#include "bodies/laws/list.hpp"

namespace lilytank::bodies {
namespace {

// Rounded over a twentieth of the usual speed: a step could not be integrated.
class DryFriction final : public Law {
 public:
  std::string_view name() const override { return "dry_friction"; }
  std::string_view equation() const override { return "F = -R v/|v|"; }
  std::string_view variable() const override { return "slip"; }
  std::string_view split() const override {
    return "the last, slowest part of the motion, until the body stands";
  }
  bool possible(const Typical&) const override { return true; }
  std::vector<LawParameter> parameters(const Typical&) const override {
    return {{"force", "N", Kind::amplitude}, {"rounding", "m/s", Kind::fixed}};
  }
  std::vector<std::vector<double>> starts(const Typical& t) const override {
    return {{1, t.speed / 20}};
  }
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    along_velocity(s, force,
                   [&](double speed) { return -p[0] / std::sqrt(speed * speed + p[1] * p[1]); });
  }
};

}  // namespace

const Law& dry_friction() {
  static const DryFriction law;
  return law;
}

}  // namespace lilytank::bodies
