#include "bodies/laws/drags.hpp"
#include "bodies/laws/list.hpp"

namespace lilytank::bodies {
namespace {

class QuadraticDrag final : public Law {
 public:
  std::string_view name() const override { return "quadratic_drag"; }
  std::string_view equation() const override { return "F = -c |v| v"; }
  std::string_view variable() const override { return "slip"; }
  std::string_view split() const override {
    return "the same body at speeds that differ by a factor of three or more";
  }
  bool possible(const Typical&) const override { return true; }
  std::vector<LawParameter> parameters(const Typical&) const override {
    return {{"coefficient", "N s^2/m^2", Kind::amplitude}};
  }
  std::vector<std::vector<double>> starts(const Typical&) const override { return {{1}}; }
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    along_velocity(s, force, [&](double speed) { return -p[0] * speed; });
  }
};

}  // namespace

const Law& quadratic_drag() {
  static const QuadraticDrag law;
  return law;
}

}  // namespace lilytank::bodies
