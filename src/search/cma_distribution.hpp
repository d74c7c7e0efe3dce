// The normal distribution that CMA-ES samples from, and how it learns.
#pragma once
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
  CmaDistribution(std::vector<double> mean, double sigma, int lambda);
  CmaDistribution(StateReader& in, int axes, int most_lambda);

  const CmaConstants& constants() const { return constants_; }
  const std::vector<double>& mean() const { return mean_; }
  /// mean + sigma B D z: the sample that belongs to standard normals.
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
  std::vector<double> stretched(std::span<const double> z) const;  ///< B D z
  std::vector<double> turned(std::span<const double> v) const;     ///< B v
  void update_covariance(const std::vector<std::vector<double>>& ranked, double h_sigma);
  void decompose();

  CmaConstants constants_;
  std::vector<double> mean_, path_sigma_, path_c_;
  std::vector<double> covariance_;  ///< row by row
  double sigma_ = 0;
  double decay_ = 1;  ///< (1 - c_sigma)^(2 generations)
  /// Derived: eigenvectors as columns, row by row, and roots of eigenvalues.
  std::vector<double> basis_, scale_;
};

}  // namespace lilytank
