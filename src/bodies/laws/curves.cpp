// Curves over one variable that stand for laws without a name: straight between their knots.
#include <algorithm>
#include <cmath>

#include "bodies/laws/drags.hpp"
#include "bodies/laws/list.hpp"
#include "bodies/laws/pairs.hpp"

namespace lilytank::bodies {
namespace {

constexpr int kKnots = 5;

// Parameters: the knots' values, then the first and the last knot's place.
double at(double u, std::span<const double> p) {
  const double place = (u - p[kKnots]) / (p[kKnots + 1] - p[kKnots]) * (kKnots - 1);
  const double inside = std::clamp(place, 0.0, kKnots - 1.0);
  const auto k = std::min(static_cast<std::size_t>(inside), static_cast<std::size_t>(kKnots - 2));
  const double w = inside - static_cast<double>(k);
  return (1 - w) * p[k] + w * p[k + 1];
}

class CurveLaw : public Law {
 public:
  std::string_view equation() const override { return "a curve, straight between its knots"; }
  bool curve() const override { return true; }
  std::vector<LawParameter> parameters(const Typical&) const override {
    std::vector<LawParameter> out;
    for (int k = 0; k < kKnots; ++k) out.push_back({"knot" + std::to_string(k + 1), "N"});
    out.push_back({"from", "", Kind::fixed}), out.push_back({"to", "", Kind::fixed});
    return out;
  }
  std::vector<std::vector<double>> starts(const Typical& t) const override {
    std::vector<double> p(kKnots, 1.0);
    const auto [from, to] = range(t);
    p.push_back(from), p.push_back(to > from ? to : from + 1);
    return {p};
  }
  virtual std::pair<double, double> range(const Typical& t) const = 0;
};

class OfSlip final : public CurveLaw {
 public:
  std::string_view name() const override { return "curve_of_slip"; }
  std::string_view variable() const override { return "slip"; }
  bool possible(const Typical&) const override { return true; }
  std::pair<double, double> range(const Typical& t) const override { return {0, t.fastest}; }
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    along_velocity(s, force,
                   [&](double v) { return -at(v, p) / std::max(v, 1e-3 * p[kKnots + 1]); });
  }
};

class OfPosition final : public CurveLaw {
 public:
  std::string_view name() const override { return "curve_of_position"; }
  std::string_view variable() const override { return "position"; }
  bool possible(const Typical& t) const override { return t.dimensions == 1 && t.bodies == 1; }
  std::pair<double, double> range(const Typical& t) const override { return {t.low, t.high}; }
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    for (int b = 0; b < s.bodies; ++b) force[b] += at(s.x[b], p);
  }
};

class OfGap final : public CurveLaw {
 public:
  std::string_view name() const override { return "curve_of_gap"; }
  std::string_view variable() const override { return "pair"; }
  bool possible(const Typical& t) const override { return t.bodies > 1; }
  std::pair<double, double> range(const Typical& t) const override {
    return {t.nearest, std::min(t.middle, 4 * t.nearest + 1e-9)};
  }
  // Nothing beyond the last knot.
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    between_pairs(s, force, [&](double gap) { return gap < p[kKnots + 1] ? at(gap, p) : 0.0; });
  }
};

class OfTime final : public CurveLaw {
 public:
  std::string_view name() const override { return "curve_of_time"; }
  std::string_view variable() const override { return "time"; }
  bool possible(const Typical& t) const override { return t.dimensions == 1; }
  std::pair<double, double> range(const Typical& t) const override { return {0, t.duration}; }
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    for (int b = 0; b < s.bodies; ++b) force[b] += at(s.time, p);
  }
};

}  // namespace

const Law& curve_of_slip() {
  static const OfSlip law;
  return law;
}

const Law& curve_of_position() {
  static const OfPosition law;
  return law;
}

const Law& curve_of_gap() {
  static const OfGap law;
  return law;
}

const Law& curve_of_time() {
  static const OfTime law;
  return law;
}

}  // namespace lilytank::bodies
