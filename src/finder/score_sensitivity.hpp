// Sensitivity of the scores to an effect, computed by the filter along the recordings under test.
//
// A score is linear in forces at the recorded positions, however strong these are, and the
// information that two effects share follows from the recordings without noise. Simulations then
// measure only the rest: the factor by which the filter underestimates an effect, and the effect's
// influence on other statistics.
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "finder/reference_ensemble.hpp"

namespace lilytank {

class ScoreSensitivity {
 public:
  /// `ensemble` and `recordings` must outlive this.
  ScoreSensitivity(const ReferenceEnsemble& ensemble, const std::vector<Recording>& recordings);

  /// The fingerprint with the filter's scores times the factor estimated from its simulations;
  /// other statistics are kept where they are significant.
  Fingerprint aligned(Fingerprint of, const Effect& effect);
  const std::vector<Recording>& recordings() const { return recordings_; }
  /// Variance that the named numbers' residuals have beyond that of nulls, where modules of these
  /// recordings felt less of an effect.
  Eigen::VectorXd further_variance() const;

 private:
  const Eigen::MatrixXd& response(const Effect& effect);
  Eigen::MatrixXd from_informations(const Eigen::MatrixXd& informations, Eigen::Index first,
                                    Eigen::Index count) const;
  Eigen::VectorXd clear(const Eigen::VectorXd& scores, double error) const;
  double factor(const Eigen::VectorXd& scores, const Eigen::VectorXd& expected) const;

  const ReferenceEnsemble& ensemble_;
  const std::vector<Recording>& recordings_;
  Eigen::Index scores_;           ///< numbers of the ensemble that are scores
  Eigen::MatrixXd own_;           ///< information of the plan's scores
  Eigen::MatrixXd plain_, root_;  ///< takes expected correlations out, and its inverse
  std::map<std::string, Eigen::MatrixXd>
      responses_;  ///< by variant: of residuals by each amplitude
};

}  // namespace lilytank
