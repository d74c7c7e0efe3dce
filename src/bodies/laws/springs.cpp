#include "bodies/laws/list.hpp"

namespace lilytank::bodies {
namespace {

// Towards a place: F = -k (x - x0), or the third power of the distance along each axis.
class Spring final : public Law {
 public:
  explicit Spring(bool cubic) : cubic_(cubic) {}
  std::string_view name() const override { return cubic_ ? "cubic_spring" : "linear_spring"; }
  std::string_view equation() const override {
    return cubic_ ? "F = -k (x - x0)^3" : "F = -k (x - x0)";
  }
  std::string_view variable() const override { return "position"; }
  std::string_view split() const override { return "a recording that begins farther away"; }
  bool possible(const Typical&) const override { return true; }
  std::vector<LawParameter> parameters(const Typical& t) const override {
    std::vector<LawParameter> out{{"stiffness", cubic_ ? "N/m^3" : "N/m", Kind::amplitude},
                                  {"x0", "m", Kind::place}};
    if (t.dimensions == 2) out.push_back({"y0", "m", Kind::place});
    return out;
  }
  std::vector<std::vector<double>> starts(const Typical& t) const override {
    std::vector<double> p{1, t.centre[0]};
    if (t.dimensions == 2) p.push_back(t.centre[1]);
    return {p};
  }
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    for (int i = 0; i < s.bodies * s.dimensions; ++i) {
      const double u = s.x[i] - p[static_cast<std::size_t>(1 + i % s.dimensions)];
      force[i] -= p[0] * (cubic_ ? u * u * u : u);
    }
  }

 private:
  bool cubic_;
};

}  // namespace

const Law& linear_spring() {
  static const Spring law(false);
  return law;
}

const Law& cubic_spring() {
  static const Spring law(true);
  return law;
}

}  // namespace lilytank::bodies
