#include "bodies/laws/list.hpp"

namespace lilytank::bodies {
namespace {

class ConstantForce final : public Law {
 public:
  std::string_view name() const override { return "constant_force"; }
  std::string_view equation() const override { return "F = constant"; }
  std::string_view variable() const override { return ""; }
  std::string_view split() const override { return "a recording with the camera turned"; }
  bool possible(const Typical&) const override { return true; }
  std::vector<LawParameter> parameters(const Typical& t) const override {
    std::vector<LawParameter> out{{"x", "N", Kind::amplitude}};
    if (t.dimensions == 2) out.push_back({"y", "N", Kind::amplitude});
    return out;
  }
  std::vector<std::vector<double>> starts(const Typical& t) const override {
    return {std::vector<double>(static_cast<std::size_t>(t.dimensions), 1.0)};
  }
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    for (int i = 0; i < s.bodies * s.dimensions; ++i) {
      force[i] += p[static_cast<std::size_t>(i % s.dimensions)];
    }
  }
};

}  // namespace

const Law& constant_force() {
  static const ConstantForce law;
  return law;
}

}  // namespace lilytank::bodies
