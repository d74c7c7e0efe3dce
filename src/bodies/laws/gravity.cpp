#include "bodies/laws/list.hpp"

namespace lilytank::bodies {
namespace {

// For baselines only: as a candidate it is the constant force.
class Gravity final : public Law {
 public:
  std::string_view name() const override { return "gravity"; }
  std::string_view equation() const override { return "F = -m g along the last coordinate"; }
  std::string_view variable() const override { return ""; }
  bool possible(const Typical&) const override { return false; }
  std::vector<LawParameter> parameters(const Typical&) const override {
    return {{"g", "m/s^2", Kind::amplitude}};
  }
  std::vector<std::vector<double>> starts(const Typical&) const override { return {{1}}; }
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    for (int b = 0; b < s.bodies; ++b) force[(b + 1) * s.dimensions - 1] -= p[0] * s.mass[b];
  }
};

}  // namespace

const Law& gravity() {
  static const Gravity law;
  return law;
}

}  // namespace lilytank::bodies
