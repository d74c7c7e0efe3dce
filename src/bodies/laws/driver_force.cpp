#include "bodies/laws/list.hpp"

namespace lilytank::bodies {
namespace {

// Of all drivers together, each with a coefficient an axis.
class DriverForce final : public Law {
 public:
  std::string_view name() const override { return "driver_force"; }
  std::string_view equation() const override { return "F = sum of a_i driver_i"; }
  std::string_view variable() const override { return "driver"; }
  std::string_view split() const override { return "a recording in which the drivers change more"; }
  bool possible(const Typical& t) const override { return t.drivers > (t.latitude >= 0 ? 1 : 0); }
  std::vector<LawParameter> parameters(const Typical& t) const override {
    std::vector<LawParameter> out;
    for (int i = 0; i < t.drivers; ++i) {
      for (int d = 0; d < t.dimensions; ++d) {
        out.push_back({"a" + std::to_string(i + 1) + (d == 0 ? "x" : "y"), "N",
                       i == t.latitude ? Kind::fixed : Kind::amplitude});
      }
    }
    return out;
  }
  std::vector<std::vector<double>> starts(const Typical& t) const override {
    std::vector<double> p;
    for (int i = 0; i < t.drivers; ++i) {
      p.insert(p.end(), static_cast<std::size_t>(t.dimensions), i == t.latitude ? 0.0 : 1.0);
    }
    return {p};
  }
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    for (int i = 0; i < s.bodies * s.dimensions; ++i) {
      for (std::size_t k = static_cast<std::size_t>(i % s.dimensions), j = 0; k < p.size();
           k += static_cast<std::size_t>(s.dimensions), ++j) {
        force[i] += p[k] * s.drivers[j];
      }
    }
  }
};

}  // namespace

const Law& driver_force() {
  static const DriverForce law;
  return law;
}

}  // namespace lilytank::bodies
