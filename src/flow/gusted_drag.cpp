#include "flow/gusted_drag.hpp"

#include <algorithm>
#include <cmath>

namespace lilytank {
namespace {

constexpr double kStep = 0.05, kLast = 16;  // of u = |U| / s in the table

// c(u) = E |w| w_along for s = 1 and its derivative, as integrals over |w| = r: the angle gives
// Bessel functions. Twice differentiable and falling off as a normal density, the integrand needs
// no more than a plain sum.
void integrate(double u, double& c, double& slope) {
  constexpr double kWidth = 8, dr = 0.1;
  c = 0, slope = 0;
  for (double r = std::max(0.0, u - kWidth) + dr / 2; r < u + kWidth; r += dr) {
    const double weight = dr * std::exp(-(r * r + u * u) / 2);
    const double b0 = std::cyl_bessel_i(0.0, r * u), b1 = std::cyl_bessel_i(1.0, r * u);
    const double b2 = r * u > 0 ? b0 - 2 * b1 / (r * u) : 0;
    c += weight * r * r * r * b1;
    slope += weight * r * r * (b0 + (b0 + b2) / 2);
  }
}

}  // namespace

GustedDrag::GustedDrag() {
  for (int i = 0; i * kStep <= kLast + kStep / 2; ++i) {
    Point p{};
    integrate(i * kStep, p.c, p.slope);
    table_.push_back(p);
  }
}

GustedDrag::Point GustedDrag::at(double u) const {
  // The first terms of the expansion for weak gusts: exact to 1e-5 here.
  if (u >= kLast) return {u * u + 1.5 - 0.375 / (u * u), 2 * u + 0.75 / (u * u * u)};
  const double f = u / kStep;
  const auto i = static_cast<std::size_t>(f);
  const double t = f - static_cast<double>(i);
  const Point &a = table_[i], &b = table_[i + 1];
  const double rise = b.c - a.c;
  // Hermite's cubic through values and slopes.
  const double p = a.slope * kStep - rise, q = rise - b.slope * kStep;
  return {(1 - t) * a.c + t * b.c + t * (1 - t) * ((1 - t) * p + t * q),
          (1 - t) * a.slope + t * b.slope};
}

// What mean and covariance share: U by size and direction, and the table's entry.
struct GustedDrag::Setting {
  double s, s2, u, x, y;  // u = |U| / s
  Point point;
};

GustedDrag::Setting GustedDrag::setting(double ux, double uy, double s2) const {
  const double s = std::sqrt(s2), size = std::sqrt(ux * ux + uy * uy), u = size / s;
  const bool moving = size > 0;
  return {s, s2, u, moving ? ux / size : 1, moving ? uy / size : 0, at(u)};
}

GustedDrag::Mean GustedDrag::mean(const Setting& d) {
  const Point& p = d.point;
  const double along = d.s * p.slope, across = d.s * (d.u > 1e-6 ? p.c / d.u : p.slope);
  const double by_s = d.s2 * (p.c - d.u * p.slope / 2);
  const double mixed = along - across;
  return {d.s2 * p.c * d.x,  d.s2 * p.c * d.y,           across + mixed * d.x * d.x,
          mixed * d.x * d.y, across + mixed * d.y * d.y, by_s * d.x,
          by_s * d.y};
}

GustedDrag::Covariance GustedDrag::covariance(const Setting& d) {
  const Point& p = d.point;
  const double s4 = d.s2 * d.s2, u = d.u, v = u * u;
  // Second moments are polynomials: E |w|^2 w_along^2 = u^4 + 7 u^2 + 4, across u^2 + 4.
  const double along = s4 * (v * v + 7 * v + 4 - p.c * p.c), across = s4 * (v + 4);
  // d/dlog s^2 of s^4 f(u) is s^4 (2 f - u f' / 2).
  const double by_along = 2 * along - s4 * u / 2 * (4 * v * u + 14 * u - 2 * p.c * p.slope);
  const double by_across = 2 * across - s4 * v;
  const double xx = d.x * d.x, xy = d.x * d.y, yy = d.y * d.y;
  return {across + (along - across) * xx, (along - across) * xy,
          across + (along - across) * yy, by_across + (by_along - by_across) * xx,
          (by_along - by_across) * xy,    by_across + (by_along - by_across) * yy};
}

GustedDrag::Mean GustedDrag::mean(double ux, double uy, double s2) const {
  return mean(setting(ux, uy, s2));
}

GustedDrag::Moments GustedDrag::moments(double ux, double uy, double s2) const {
  const Setting d = setting(ux, uy, s2);
  return {mean(d), covariance(d)};
}

}  // namespace lilytank
