// Vectors, rotations and elementary functions that give the same bits on every x86-64 machine.
//
// The C library picks other code for sin, exp, log, ... on other processors, with other last bits.
// Everything here is made of + - * / and sqrt, which IEEE 754 fixes, so the library never calls
// libm for a number that reaches a State.
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace lilytank {

/// A point or vector in the tank, metres (or N, m/s): x to the right, y up, seen from above.
using Vec2 = Eigen::Vector2d;

constexpr double kPi = 3.14159265358979323846;

/// A heading as a unit vector: cos and sin of the counter-clockwise angle from +x.
struct Rot {
  double c = 1, s = 0;
};

/// Where a body is: position of its centre (m) and heading.
struct Pose {
  double x = 0, y = 0;
  Rot r;
};

/// How a body moves: velocity of its centre (m/s) and spin (rad/s, counter-clockwise).
struct Twist {
  double vx = 0, vy = 0, omega = 0;
};

/// What pushes a body: force on its centre (N) and torque (N m, counter-clockwise).
struct Wrench {
  double fx = 0, fy = 0, torque = 0;
};

inline Vec2 rotate(Rot r, const Vec2& v) {
  return {r.c * v.x() - r.s * v.y(), r.s * v.x() + r.c * v.y()};
}
inline Vec2 unrotate(Rot r, const Vec2& v) {
  return {r.c * v.x() + r.s * v.y(), r.c * v.y() - r.s * v.x()};
}
/// The rotation by a and then by b.
inline Rot compose(Rot a, Rot b) {
  return {a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s};
}
/// The rotation that takes heading `from` to heading `to`.
inline Rot between(Rot from, Rot to) {
  return {from.c * to.c + from.s * to.s, from.c * to.s - from.s * to.c};
}
/// A quarter turn k times (any k), exact.
inline Rot quarter(int k) {
  constexpr double c[4] = {1, 0, -1, 0}, s[4] = {0, 1, 0, -1};
  return {c[k & 3], s[k & 3]};
}
/// Takes rounding off a rotation: one Newton step towards length 1.
inline Rot renormalised(Rot r) {
  const double k = 1.5 - 0.5 * (r.c * r.c + r.s * r.s);
  return {r.c * k, r.s * k};
}
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
