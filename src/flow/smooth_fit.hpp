// The mean flow and the gusts' strength under which momentum balances agree with a ball's equation
// of motion.
//
// A balance's mean acceleration should be, on average over what happens in it,
//   a = kappa E|w|w - d v,   w = u + s xi - v,   s = sigma / sqrt(draws),
// and its square about that should be the kicks of random force and gusts, and noise. Unknown are
// u = (u_x, u_y) and l = log s^2 at the nodes. Differences are weighed with the model's derivatives
// at the motion *before* the balance: with those at the motion in it, which the kicks of the
// balance itself have changed, the drag would seem other than it is.
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "flow/balances.hpp"
#include "flow/gusted_drag.hpp"
#include "flow/node_grid.hpp"
#include "flow/selected_inverse.hpp"

namespace lilytank {

/// Unknown fields at the nodes, and the noise.
struct FlowUnknowns {
  Eigen::VectorXd mean;    ///< m/s; u_x and u_y of node i at 2 i and 2 i + 1
  Eigen::VectorXd log_s2;  ///< log of the variance of a ball's gust, m^2/s^2
  double kick = 0;         ///< m^2/s^3, of random force and gusts together
  double random_kick = 0;  ///< m^2/s^3, of the random force alone
  double outlier = 0;      ///< variances beyond which a squared difference is excluded; 0: none
};

/// Sums over balances for one Newton step. Blocks couple the three unknowns of a node with those of
/// the nine nodes around it.
class FlowSums {
 public:
  explicit FlowSums(int nodes);
  double& block(int node, int neighbour, int row, int column) {
    return blocks_[((node * 9 + neighbour) * 3 + row) * 3 + column];
  }
  double block(int node, int neighbour, int row, int column) const {
    return const_cast<FlowSums*>(this)->block(node, neighbour, row, column);
  }
  Eigen::VectorXd mean, log_s2;  ///< right-hand sides, as FlowUnknowns
  double squares = 0;            ///< of differences, less what noise adds to them
  double gusts = 0;              ///< what gusts add to them
  double shares = 0;             ///< what a unit kick adds to them
  double pulls = 0;              ///< m^2/s^4, mean square of the expected acceleration, per axis
  std::int64_t count = 0;
  std::vector<int> per_cell;  ///< balances in each cell of the grid

 private:
  std::vector<double> blocks_;
};

/// Covariance of u_x, u_y between a node and the nine around it, from the last Newton step.
struct MeanCovariance {
  std::vector<std::array<double, 3>> block;  ///< xx, xy, yy at node * 9 + neighbour
};

class SmoothFit {
 public:
  /// `sets` must outlive the fit.
  SmoothFit(std::span<const BalanceSet> sets, const BallPhysics& ball, const FlowGrid& grid,
            const NodeGrid& nodes);

  /// Sums over every `stride`-th balance. With `covariance`,
  /// the gusts' part is freed of what the mean flow's own uncertainty adds to it.
  FlowSums sum(const FlowUnknowns& now, int stride, const MeanCovariance* covariance) const;

 private:
  struct Work;
  void scale(const BalanceSet& set, const FlowUnknowns& now, Work& w) const;
  void instrument(const Balance& b, const BalanceSet& set, const FlowUnknowns& now, Work& w) const;
  void inside(const Balance& b, const BalanceSet& set, const FlowUnknowns& now, Work& w) const;
  void spread(const Work& w, FlowSums& out) const;
  void free_of_uncertainty(const Work& w, const MeanCovariance& covariance, FlowSums& out) const;
  double uncertainty(const Work& w, const MeanCovariance& covariance) const;

  std::span<const BalanceSet> sets_;
  const BallPhysics ball_;
  const FlowGrid grid_;
  const NodeGrid& nodes_;
  const GustedDrag drag_;
};

}  // namespace lilytank
