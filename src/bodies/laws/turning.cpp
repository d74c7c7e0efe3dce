#include <cmath>
#include <numbers>

#include "bodies/laws/list.hpp"

namespace lilytank::bodies {
namespace {

constexpr double kTide = 12.4206 * 3600;  // s, the principal lunar tide (M2)

// Adds a force that turns velocities clockwise at `rate` (rad/s).
void turn(const Scene& s, double rate, double* force) {
  for (int b = 0; b < s.bodies; ++b) {
    const double f = s.mass[b] * rate;
    force[2 * b] += f * s.v[2 * b + 1];
    force[2 * b + 1] -= f * s.v[2 * b];
  }
}

constexpr std::string_view kSplit =
    "a recording where the latitude's turning and the tide's period differ: elsewhere than at 74.5 "
    "degrees, for longer than they take to fall out of step";

class Coriolis final : public Law {
 public:
  std::string_view name() const override { return "coriolis"; }
  std::string_view equation() const override {
    return "F = m f (v_y, -v_x), f = 2 Omega sin(latitude)";
  }
  std::string_view variable() const override { return "turn"; }
  std::string_view split() const override { return kSplit; }
  bool possible(const Typical& t) const override {
    return t.dimensions == 2 && (t.latitude >= 0 || t.turning != 0);
  }
  std::vector<LawParameter> parameters(const Typical&) const override {
    return {{"f", "1/s", Kind::fixed}, {"latitude", "1", Kind::fixed}};
  }
  std::vector<std::vector<double>> starts(const Typical& t) const override {
    return {{t.turning, static_cast<double>(t.latitude)}};
  }
  double turning_rate(std::span<const double> p) const override {
    return p[1] >= 0 ? inertial_turning(90) : std::fabs(p[0]);
  }
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    turn(s, p[1] >= 0 ? inertial_turning(s.drivers[static_cast<int>(p[1])]) : p[0], force);
  }
};

class Rotation final : public Law {
 public:
  std::string_view name() const override { return "rotation"; }
  std::string_view equation() const override { return "F = m w (v_y, -v_x), w free"; }
  /// It fits whatever turns; the laws beside it say why.
  bool curve() const override { return true; }
  std::string_view variable() const override { return "turn"; }
  std::string_view split() const override { return kSplit; }
  bool possible(const Typical& t) const override { return t.dimensions == 2; }
  std::vector<LawParameter> parameters(const Typical&) const override {
    return {{"rate", "rad/s", Kind::amplitude}};
  }
  std::vector<std::vector<double>> starts(const Typical&) const override { return {{1}}; }
  double turning_rate(std::span<const double> p) const override { return std::fabs(p[0]); }
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    turn(s, p[0], force);
  }
};

// A tide's current that is set anew all the time: what it leaves turns once a period.
class TideTurning final : public Law {
 public:
  std::string_view name() const override { return "tide"; }
  std::string_view equation() const override { return "velocities turn once in 12.4206 h (M2)"; }
  std::string_view variable() const override { return "turn"; }
  std::string_view split() const override { return kSplit; }
  bool possible(const Typical& t) const override {
    return t.dimensions == 2 && t.duration > 2 * kTide;
  }
  std::vector<LawParameter> parameters(const Typical&) const override {
    return {{"period", "s", Kind::fixed}};
  }
  std::vector<std::vector<double>> starts(const Typical&) const override { return {{kTide}}; }
  double turning_rate(std::span<const double> p) const override {
    return 2 * std::numbers::pi / std::fabs(p[0]);
  }
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    turn(s, 2 * std::numbers::pi / p[0], force);
  }
};

}  // namespace

const Law& coriolis() {
  static const Coriolis law;
  return law;
}

const Law& rotation() {
  static const Rotation law;
  return law;
}

const Law& tide_turning() {
  static const TideTurning law;
  return law;
}

}  // namespace lilytank::bodies
