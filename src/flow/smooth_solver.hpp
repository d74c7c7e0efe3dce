// Newton's rounds for the smooth estimate: the mean flow with its smoothness, the gusts' strength
// with its variation, the kicks.
#pragma once
#include <Eigen/Core>
#include <array>
#include <span>

#include "flow/gust_fit.hpp"
#include "flow/smooth_fit.hpp"

namespace lilytank {

class SmoothSolver {
 public:
  /// `sets` must outlive the solver.
  SmoothSolver(std::span<const BalanceSet> sets, const BallPhysics& ball, const FlowGrid& grid);

  /// Solves for everything; `kick` (m^2/s^3) is a first guess. Throws InputError if the balances do
  /// not determine a flow.
  void solve(double kick);

  const NodeGrid& nodes() const { return nodes_; }
  const FlowUnknowns& now() const { return now_; }
  const FlowSums& sums() const { return sums_; }
  /// Effective number of values that the mean field is free to take.
  double free_values() const { return free_values_; }
  /// Variances of a node's u_x and u_y, the gusts' uncertainty included.
  std::array<double, 2> mean_variance(int node) const;
  /// Variance of a weighted sum of log s^2 over the nodes.
  double log_variance(const Eigen::VectorXd& weight) const;
  double log_variance(int node) const;
  /// Changes of mean flow and log s^2 at the nodes, drawn from their posterior about `now()`.
  struct Change {
    Eigen::VectorXd mean, log_s2;
  };
  Change draw(int run) const;
  /// Principal components of the mean flow's posterior, those of most variance within `radius` of
  /// the centre, each times its standard deviation (Karhunen-Loeve), [value, component].
  Eigen::MatrixXd components(int count, double radius) const;

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  void settle(int stride);
  Matrix assemble() const;
  void factor();
  Eigen::VectorXd rough(const Eigen::VectorXd& mean) const;
  Eigen::VectorXd mean_right() const { return sums_.mean - smoothness_ * rough(now_.mean); }
  void step_mean();
  double step_both();
  Eigen::MatrixXd couple(Matrix& own) const;
  Eigen::MatrixXd covariance_times(const Eigen::MatrixXd& of) const;
  void set_smoothness();
  void set_kick();
  void find_covariance();

  NodeGrid nodes_;
  SmoothFit fit_;
  Matrix roughness_;
  Eigen::MatrixXd splines_;  ///< at the nodes: in the plane, then by radius
  Eigen::Index plane_ = 0;
  FlowUnknowns now_;
  FlowSums sums_{0};
  GustPosterior gusts_;
  Eigen::MatrixXd carried_;  ///< what a spline coefficient changes in the mean flow
  MeanCovariance covariance_;
  SparseFactor factor_;
  double start_ = 0;  ///< prior mean of log s^2
  double smoothness_ = 0, free_values_ = 0;
  std::int64_t balances_ = 0;
  bool analysed_ = false;
};

}  // namespace lilytank
