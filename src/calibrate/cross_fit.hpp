// What local models say of simulations that they did not know: as it will be with data.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "calibrate/estimate_line.hpp"
#include "lilytank/response_surface.hpp"

namespace lilytank {

/// Estimates of every simulation of a design, each by a model of the others, and of data by all of
/// these models.
struct CrossFit {
  Eigen::MatrixXd estimates;  ///< [simulation, parameter]
  Eigen::VectorXd misfits;    ///< [simulation]
  Eigen::VectorXd answer;     ///< of data, the mean over the models
  double misfit = 0;          ///< of data, likewise
  std::vector<LocalModel> models;
  /// What all models together say of numbers, as of data: the answer, and the mean misfit.
  LocalFit of(const Eigen::VectorXd& numbers) const;
};

/// By eight models, each without every eighth simulation. Throws std::invalid_argument where these
/// are too few.
CrossFit cross_fit(const Design& design, const Eigen::VectorXd& data, Misfit misfit, Slopes slopes);

/// What data say of the parameters, and how surely, by what the models say of simulations whose
/// parameters are known. The slopes of a local model carry noise, and a hundred numbers that do not
/// depend on a parameter at all seem to tell it: answers are drawn to the centre. Their line in the
/// truth says by how much, and is turned round.
struct HonestFit {
  Eigen::VectorXd point;
  Eigen::MatrixXd covariance;  ///< of an answer's error
  Eigen::MatrixXd errors;      ///< of the design's simulations, a row each
  double wide = 0;             ///< half width of a 95 % interval, in deviations
};
/// `least`: what the line's slope is taken for where it is less, a share: without it, directions
/// that a design hardly tells would lead anywhere.
HonestFit turned_round(const Design& design, const CrossFit& fit, double least);

/// Answers are drawn to the design's centre by the noise of the local model's slopes. Each
/// simulation is estimated by a model that did not know it: their estimates are a line in the
/// truth, and its inverse at the data's estimate by the same models, together with what is known
/// before, gives the values.
struct TurnedBack {
  CrossFit by_others;
  Line line;
  Scatter answer;
};
/// `centre`: of the line. Throws as cross_fit.
TurnedBack turned_back(const Design& design, const Eigen::VectorXd& centre, const Prior& prior,
                       const Eigen::VectorXd& data);

}  // namespace lilytank
