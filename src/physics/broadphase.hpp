// Which circles overlap: all pairs for few bodies, a uniform grid for many.
#pragma once
#include <algorithm>
#include <span>
#include <vector>

namespace lilytank {

/// Finds overlapping circles. Results come in ascending order of the bodies' numbers and do not
/// depend on which of the two ways is used.
class Broadphase {
 public:
  static constexpr int kAllPairs = 64;  ///< up to so many bodies the grid does not pay

  /// For up to `bodies` circles within a square of half-width `extent` (m; those outside are kept
  /// at its rim), most of them with radii near `radius` (m).
  Broadphase(int bodies, double extent, double radius);

  /// Takes the circles of a moment; the spans must live as long as they are asked about.
  void build(std::span<const double> x, std::span<const double> y, std::span<const double> radius);

  /// Calls use(i, j) for every pair i < j that overlaps or is nearer than `margin` (m).
  template <class Use>
  void pairs(double margin, Use&& use);
  /// Calls use(j) for every body j that overlaps the circle of radius `radius` about body i,
  /// without i itself.
  template <class Use>
  void around(int i, double radius, Use&& use);

 private:
  int cell_of(double v) const;
  void gather(double x, double y, double radius, int above);

  double extent_, inverse_cell_;
  int cells_;  // per side; 0: all pairs
  std::span<const double> x_, y_, radius_;
  std::vector<int> begin_, entries_;  // bodies of cell k: entries_[begin_[k] .. begin_[k + 1])
  std::vector<int> seen_, found_;
  int stamp_ = 0;
};

template <class Use>
void Broadphase::pairs(double margin, Use&& use) {
  const int n = static_cast<int>(x_.size());
  const double *x = x_.data(), *y = y_.data(), *radius = radius_.data();
  for (int i = 0; i < n; ++i) {
    const double xi = x[i], yi = y[i], own = radius[i] + margin;
    const auto near = [=](int j) {
      const double dx = x[j] - xi, dy = y[j] - yi, reach = own + radius[j];
      return dx * dx + dy * dy < reach * reach;
    };
    if (cells_ == 0) {
      for (int j = i + 1; j < n; ++j) {
        if (near(j)) use(i, j);
      }
    } else {
      gather(xi, yi, own, i);
      for (const int j : found_) {
        if (near(j)) use(i, j);
      }
    }
  }
}

template <class Use>
void Broadphase::around(int i, double radius, Use&& use) {
  const int n = static_cast<int>(x_.size());
  const auto test = [&](int j) {
    const double dx = x_[j] - x_[i], dy = y_[j] - y_[i], reach = radius + radius_[j];
    if (j != i && dx * dx + dy * dy < reach * reach) use(j);
  };
  if (cells_ == 0) {
    for (int j = 0; j < n; ++j) test(j);
  } else {
    gather(x_[i], y_[i], radius, -1);
    for (const int j : found_) test(j);
  }
}

}  // namespace lilytank
