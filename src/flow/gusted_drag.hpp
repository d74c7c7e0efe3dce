// Quadratic drag in a wind that fluctuates: mean and covariance of |w| w for w = U + s xi, xi two
// standard normals. Only lengths relative to s matter, so one table serves all.
#pragma once
#include <vector>

namespace lilytank {

class GustedDrag {
 public:
  GustedDrag();

  /// E |w| w with its derivatives.
  struct Mean {
    double x, y;        ///< m^2/s^2
    double xx, xy, yy;  ///< by U, m/s
    double sx, sy;      ///< by log s^2
  };
  Mean mean(double ux, double uy, double s2) const;

  /// The covariance of |w| w and its derivative by log s^2, both m^4/s^4.
  struct Covariance {
    double xx, xy, yy, sxx, sxy, syy;
  };

  /// Both at once.
  struct Moments {
    Mean mean;
    Covariance covariance;
  };
  Moments moments(double ux, double uy, double s2) const;

 private:
  struct Point {
    double c, slope;
  };
  Point at(double u) const;
  struct Setting;
  Setting setting(double ux, double uy, double s2) const;
  static Mean mean(const Setting& at);
  static Covariance covariance(const Setting& at);
  std::vector<Point> table_;
};

}  // namespace lilytank
