// What a calibration could absorb: errors of the baseline's parameters and of the flow map, as
// accelerations of modules. Scores of effects are cleared of them.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "effects/features.hpp"
#include "filter/sensitivity.hpp"
#include "lilytank/flow_maps.hpp"

namespace lilytank {

/// Factors on drag, on the flow and on the gusts, both dampings; then principal components of the
/// errors of the mean flow and of the gusts, those of most variance (Karhunen-Loeve). Constant once
/// made.
class Nuisances {
 public:
  /// The parameters alone.
  Nuisances() = default;
  /// From draws of the maps' errors (flow_uncertainty.hpp). `threads`: 0: one a core.
  Nuisances(const Model& model, const FlowMaps& maps, std::uint64_t seed, int threads = 0);

  /// How many there are.
  Eigen::Index count() const { return kParameters + mean_basis_.cols() + gust_basis_.cols(); }
  /// What is known of their amplitudes before any recording of modules: the inverse of their
  /// covariance, [nuisance, nuisance], the identity in these sizes. Parameters are hardly known.
  Eigen::MatrixXd known() const { return Eigen::MatrixXd::Identity(count(), count()); }
  /// The same of other maps on the grid of those of the constructor.
  Eigen::MatrixXd known_for(const FlowMaps& maps, std::uint64_t seed, int threads = 0) const;
  /// How many are errors of the mean flow: of a map from 12 min of balls, 68 % of their variance
  /// where modules are. Beside them most scores scatter as their information says
  /// (docs/validation.md).
  static constexpr std::size_t kMeanModes = 256;
  /// The first ones, which are parameters of the model and not errors of the flow.
  static constexpr Eigen::Index kParameters = 5;
  /// In words, and the size of each: a relative change, or 1/s.
  struct Parameter {
    const char* name;
    double size;
  };
  static const std::array<Parameter, kParameters> kModelParameters;

  /// The acceleration of module `i` by each at its size, from entry `first` of `pushes` on.
  void push(const Features& features, const Kinematics& k, std::size_t i, std::size_t first,
            Pushes& pushes) const;

 private:
  void push_flow(const Features& features, double x, double y, std::size_t i, std::size_t first,
                 Pushes& pushes) const;

  int cells_ = 0;      // a side of the grid
  double extent_ = 0;  // m, half its side
  // Of each cell: velocities along x and y (m/s), rates of turning (rad/s), and relative changes of
  // the gusts' deviation, by all components.
  std::vector<float> changes_;
  Eigen::MatrixXd mean_basis_, gust_basis_;  // where the components were found, [value, component]
};

}  // namespace lilytank
