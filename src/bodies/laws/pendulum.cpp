#include <cmath>

#include "bodies/laws/list.hpp"

namespace lilytank::bodies {
namespace {

class Pendulum final : public Law {
 public:
  std::string_view name() const override { return "pendulum"; }
  std::string_view equation() const override { return "F = -m w^2 sin(x)"; }
  std::string_view variable() const override { return "position"; }
  bool possible(const Typical&) const override { return false; }
  std::vector<LawParameter> parameters(const Typical&) const override {
    return {{"w^2", "1/s^2", Kind::amplitude}};
  }
  std::vector<std::vector<double>> starts(const Typical&) const override { return {{1}}; }
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    for (int i = 0; i < s.bodies * s.dimensions; ++i) {
      force[i] -= s.mass[i / s.dimensions] * p[0] * std::sin(s.x[i]);
    }
  }
};

}  // namespace

const Law& pendulum() {
  static const Pendulum law;
  return law;
}

}  // namespace lilytank::bodies
