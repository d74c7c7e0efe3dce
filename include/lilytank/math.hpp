// Vectors, rotations and elementary functions that give the same bits on every x86-64 machine.
//
// The C library picks other code for sin, exp, log, ... on other processors, with other last bits.
// Everything here is made of + - * / and sqrt, which IEEE 754 fixes, so the library never calls
// libm for a number that reaches a State.
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace lilytank {

/// A point or vector in the tank's plane, seen from above: x to the right, y up, the tank's centre
/// at the origin. SI: m, m/s or N.
using Vec2 = Eigen::Vector2d;

/// The ratio of a circle's circumference to its diameter, to the nearest double.
constexpr double kPi = 3.14159265358979323846;

/// A heading as a unit vector. Rotations compose by products alone, without an angle that could
/// need trigonometric functions or wrap.
struct Rot {
  double c = 1, s = 0;  ///< cosine and sine of the counter-clockwise angle from +x
};

/// Position and heading of a body.
struct Pose {
  double x = 0, y = 0;  ///< the body's centre, m
  Rot r;                ///< heading of the body's +x axis
};

/// Velocity of a body.
struct Twist {
  double vx = 0, vy = 0;  ///< velocity of the centre, m/s, in the tank's frame
  double omega = 0;       ///< angular velocity, rad/s, counter-clockwise
};

/// Force and torque on a body.
struct Wrench {
  double fx = 0, fy = 0;  ///< force that acts at the body's centre, N, in the tank's frame
  double torque = 0;      ///< torque about the centre, N m, counter-clockwise
};

/// A vector from the body's frame to the tank's.
inline Vec2 rotate(Rot r, const Vec2& v) {
  return {r.c * v.x() - r.s * v.y(), r.s * v.x() + r.c * v.y()};
}
/// A vector from the tank's frame to the body's; inverse of rotate().
inline Vec2 unrotate(Rot r, const Vec2& v) {
  return {r.c * v.x() + r.s * v.y(), r.c * v.y() - r.s * v.x()};
}
/// The rotation by a and then by b; the angles add. Rounding lets the length drift from 1:
/// renormalised() takes it back.
inline Rot compose(Rot a, Rot b) {
  return {a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s};
}
/// The rotation that takes heading `from` to heading `to`; the angles subtract.
inline Rot between(Rot from, Rot to) {
  return {from.c * to.c + from.s * to.s, from.c * to.s - from.s * to.c};
}
/// k quarter turns counter-clockwise (any k, negative ones too), exact: no rounding.
inline Rot quarter(int k) {
  constexpr double c[4] = {1, 0, -1, 0}, s[4] = {0, 1, 0, -1};
  return {c[k & 3], s[k & 3]};
}
/// Removes rounding from a rotation: one Newton step of 1 / sqrt(c^2 + s^2) from 1. An error d of
/// the length becomes 1.5 d^2.
inline Rot renormalised(Rot r) {
  const double k = 1.5 - 0.5 * (r.c * r.c + r.s * r.s);
  return {r.c * k, r.s * k};
}
/// The z component of a x b: positive if b lies counter-clockwise of a.
inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// cos and sin of an angle in radians; absolute error under 3e-16 for |angle| < 1e5.
Rot rotation(double angle);
/// The angle of a rotation, in (-pi, pi]; absolute error under 5e-16.
double angle_of(Rot r);
/// e^x; relative error under 4e-16. 0 below -745, infinity above 709.
double exp_portable(double x);
/// Natural logarithm of x > 0; relative error under 4e-16 (absolute near x = 1).
double log_portable(double x);
/// base^exponent for base >= 0 (0^0 = 1).
double pow_portable(double base, double exponent);

}  // namespace lilytank
