// What a tank looks like while its speed is taken: shows that two programs did the same work.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "lilytank/model.hpp"
#include "lilytank/state.hpp"

namespace lilytank::bench {

/// Sums over samples of a tank's modules. Lengths in m.
class Measures {
 public:
  explicit Measures(const Model& model) : model_(&model) {}
  /// Adds one moment. `faces` (four a module) tell which modules are joined; may be empty.
  void sample(const Kinematics& bodies, std::span<const Face> faces = {});

  double speed() const { return speed_ / bodies_; }        ///< m/s, mean
  double spin() const { return spin_ / bodies_; }          ///< rad/s, mean of |omega|
  double radius() const { return radius_ / bodies_; }      ///< mean distance from the centre
  double near() const { return near_ / bodies_; }          ///< pairs whose circles meet, a module
  double touching() const { return touching_ / bodies_; }  ///< pairs nearer than 0.3 mm
  double at_wall() const { return at_wall_ / bodies_; }    ///< modules nearer than 0.3 mm
  double beyond_wall() const { return beyond_wall_; }      ///< farthest corner outside
  double joined() const { return joined_ / bodies_; }      ///< share of modules with a bond
  double joints() const { return joints_ / bodies_; }      ///< bonds, a module
  /// Depths of overlapping pairs that are not joined, and distances of joined faces' centres.
  const std::vector<double>& depths() const { return depths_; }
  const std::vector<double>& joint_errors() const { return joint_errors_; }
  /// Share of `depths` above a bound.
  double deep_share(double bound) const;
  double overlapping() const { return static_cast<double>(depths_.size()) / bodies_; }

 private:
  void pair(const Kinematics& bodies, std::span<const Face> faces, int i, int j);
  void bonds(const Kinematics& bodies, std::span<const Face> faces, int i);
  const Model* model_;
  double bodies_ = 0, speed_ = 0, spin_ = 0, radius_ = 0, near_ = 0, touching_ = 0, at_wall_ = 0,
         beyond_wall_ = -1, joined_ = 0, joints_ = 0;
  std::vector<double> depths_, joint_errors_;
};

/// The value that a share q of `values` lies below; 0 for none.
double quantile(std::vector<double> values, double q);

}  // namespace lilytank::bench
