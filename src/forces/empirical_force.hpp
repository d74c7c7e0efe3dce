// What a force without a name depends on and where it points: shared by the term that simulates it
// and the search that measures it.
#pragma once
#include <array>

#include "forces/water.hpp"
#include "math/knots.hpp"

namespace lilytank {

constexpr int kKnots = 6;  ///< values of a curve
/// Where they begin among the parameters of the term: variable, direction, low and high come first.
constexpr std::size_t kFirstKnot = 4;

/// What the force depends on.
enum class Along : int { radius, heading, slip, spin, time, x, y, gap };
/// Where it points; of pairs (Along::gap) only out: apart, around: across, torque.
enum class Toward : int { x, y, out, around, slip, across_slip, forward, left, torque };

/// A curve over a variable: straight lines between kKnots values from `low` to `high`, the end
/// values beyond; over headings it closes.
struct ForceCurve {
  Along along = Along::radius;
  Toward toward = Toward::x;
  double low = 0, high = 1;
};

/// The variable's value at a knot; over a closed curve knot kKnots would be the first again.
inline double knot_at(const ForceCurve& curve, int knot) {
  const int steps = curve.along == Along::heading ? kKnots : kKnots - 1;
  return curve.low + knot * (curve.high - curve.low) / steps;
}

inline KnotShare place_on(const ForceCurve& curve, double value) {
  const bool closed = curve.along == Along::heading;
  const double t = (value - curve.low) / (curve.high - curve.low) * (closed ? kKnots : kKnots - 1);
  return between_knots(t, kKnots, closed);
}

/// The variable's value at body i.
inline double value_along(Along along, const Model& model, const Kinematics& k,
                          const StepContext& now, int i) {
  switch (along) {
    case Along::radius:
      return std::sqrt(k.x[i] * k.x[i] + k.y[i] * k.y[i]);
    case Along::heading:
      return angle_of({k.c[i], k.s[i]});
    case Along::slip:
      return slip_of(model, k, now, i).norm();
    case Along::spin:
      return k.omega[i];
    case Along::time:
      return now.time;
    case Along::x:
      return k.x[i];
    case Along::y:
      return k.y[i];
    default:
      return 0;
  }
}

/// The wrench of size 1 (N, or N m) in that direction on body i.
inline Wrench unit_toward(Toward toward, const Model& model, const Kinematics& k,
                          const StepContext& now, int i) {
  const auto unit = [](double x, double y) {
    const double size = std::sqrt(x * x + y * y);
    return size > 0 ? Wrench{x / size, y / size, 0} : Wrench{};
  };
  switch (toward) {
    case Toward::x:
      return {1, 0, 0};
    case Toward::y:
      return {0, 1, 0};
    case Toward::out:
      return unit(k.x[i], k.y[i]);
    case Toward::around:
      return unit(-k.y[i], k.x[i]);
    case Toward::forward:
      return {k.c[i], k.s[i], 0};
    case Toward::left:
      return {-k.s[i], k.c[i], 0};
    case Toward::torque:
      return {0, 0, 1};
    default: {
      const Vec2 w = slip_of(model, k, now, i);
      return toward == Toward::slip ? unit(w.x(), w.y()) : unit(-w.y(), w.x());
    }
  }
}

}  // namespace lilytank
