#include "statistics/quantiles.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cassert>
#include <cmath>

namespace lilytank {
namespace {

using boost::math::chi_squared;
using boost::math::normal;
using boost::math::students_t;

}  // namespace

double normal_quantile(double p) {
  return quantile(normal(), p);
}

double normal_half_width(double level) {
  assert(0 < level && level < 1);
  return quantile(normal(), (1 + level) / 2);
}

double student_half_width(double freedom, double level) {
  return quantile(students_t(freedom), (1 + level) / 2);
}

double student_tail(double t, double freedom) {
  return 2 * cdf(complement(students_t(freedom), t));
}

double chi_squared_quantile(double p, double freedom) {
  return quantile(chi_squared(freedom), p);
}

double chi_squared_upper_quantile(double p, double freedom) {
  return quantile(complement(chi_squared(freedom), p));
}

double chi_squared_tail(double square, double freedom) {
  return cdf(complement(chi_squared(freedom), square));
}

double chi_squared_z(double square, int freedom) {
  if (freedom == 1) return std::sqrt(square);
  const double part = 2.0 / (9.0 * freedom);
  return (std::cbrt(square / freedom) - (1 - part)) / std::sqrt(part);
}

}  // namespace lilytank
