// The normal distribution that CMA-ES samples from, and how it learns.
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "search/state_text.hpp"

namespace lilytank {

/// Constants for n axes and lambda samples [Hansen 2016, Table 1].
struct CmaConstants {
  int n = 0, lambda = 0, mu = 0;
  std::vector<double> weight;  ///< by rank, the worse half negative
  double mu_eff = 0, c_sigma = 0, d_sigma = 0, c_c = 0, c_1 = 0, c_mu = 0;
  double chi = 0;  ///< mean length of a standard normal vector

  CmaConstants() = default;
  CmaConstants(int axes, int samples);
};

class CmaDistribution {
 public:
  CmaDistribution() = default;
  CmaDistribution(const std::vector<double>& mean, double sigma, int lambda);
  CmaDistribution(StateReader& in, int axes, int most_lambda);

  const CmaConstants& constants() const { return constants_; }
  std::vector<double> mean() const { return {mean_.begin(), mean_.end()}; }
  /// mean + sigma C^(1/2) z: the sample that belongs to standard normals. The symmetric root of the
  /// covariance C does not depend on the order and the signs of the eigenvectors.
  std::vector<double> sample(std::span<const double> z) const;
  /// One generation's update from the normals of its samples, best first.
  void update(const std::vector<std::vector<double>>& ranked);
  /// Multiplies sigma, as far as no axis' deviation passes the box's length.
  void widen(double factor);
  /// Root of the mean variance of an axis.
  double spread() const;
  /// Too small, too flat, or not finite any more.
  bool worn_out() const;
  void save(StateWriter& out) const;

 private:
  void update_covariance(const std::vector<std::vector<double>>& ranked, double h_sigma);
  void decompose();

  CmaConstants constants_;
  Eigen::VectorXd mean_, path_sigma_, path_c_;
  Eigen::MatrixXd covariance_;
  double sigma_ = 0;
  double decay_ = 1;  ///< (1 - c_sigma)^(2 generations)
  /// Derived: the covariance's symmetric root and the roots of its eigenvalues.
  Eigen::MatrixXd root_;
  Eigen::VectorXd scale_;
};

}  // namespace lilytank
