// The stages of a calibration, in their order. Each keeps what it has done in the directory and
// goes on from there.
#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/setup.hpp"
#include "lilytank/response_surface.hpp"
#include "scores/prediction_numbers.hpp"
#include "study/kept_rows.hpp"

namespace lilytank {

/// What the stages share.
class Stages {
 public:
  explicit Stages(CalibrationSetup& setup);

  /// The flow and the draws of its error; the setup's model then has the best of it.
  FlowMaps flow_maps();
  /// The search's estimate, with nuisances at their start.
  std::vector<double> search(CalibrationResult& out);

  using Of = CalibrationSetup::Of;
  /// From here on a model with these values predicts whole experiments.
  void predict_with(const std::vector<double>& values);
  /// Statistics of whole experiments, and what they are.
  std::vector<double> numbers(const std::vector<Recording>& recordings) const;
  std::vector<SummaryEntry> entries() const;
  /// Which of them estimates are made of: if a model predicts, what its errors and the kicks are;
  /// else all.
  std::vector<Eigen::Index> fitted() const;
  /// Numbers that the objective compares, of whole experiments simulated at points (a row each, on
  /// the fitted scale), each in another flow that the balls allow; or of single pieces in the best
  /// flow. Empty rows where worlds diverged.
  std::vector<std::vector<double>> simulate(const std::string& stage, const Eigen::MatrixXd& points,
                                            std::uint64_t seed, const FlowMaps& maps,
                                            Of of = Of::experiments);
  /// Eq. 9's MSD of whole experiments simulated at points, in the best flow.
  std::vector<std::vector<double>> displacements(const std::string& stage,
                                                 const Eigen::MatrixXd& points, std::uint64_t seed);
  /// Rows kept under a stage's name. `cost` of one, in simulated experiments, is for the progress.
  std::vector<std::vector<double>> rows(const std::string& stage, int count,
                                        const std::function<std::vector<double>(int)>& work,
                                        double cost = 1);

  /// Rows of several stages, computed in one loop and kept under the name of each; `title`: of all,
  /// for the progress.
  struct RowsOfStage {
    std::string stage;
    int count = 0;
    std::function<std::vector<double>(int)> work;
  };
  std::vector<std::vector<std::vector<double>>> rows(const std::string& title,
                                                     const std::vector<RowsOfStage>& stages,
                                                     double cost = 1);

  /// A matrix with so many rows, computed by `of` unless it is kept under the stage's name.
  Eigen::MatrixXd matrix(const std::string& stage, Eigen::Index rows,
                         const std::function<Eigen::MatrixXd()>& of);

  const CalibrationSetup& setup() const { return setup_; }
  Eigen::VectorXd to_scale(const std::vector<double>& values) const;
  /// Clipped to the bounds.
  std::vector<double> from_scale(const Eigen::VectorXd& point) const;
  FitBounds bounds() const;
  /// How many simulated experiments are still to come, for the progress, by whoever knows better
  /// than a calibration's usual course.
  void expect(double experiments) { expected_ = spent_ + experiments; }
  /// What a calibration's usual course simulates besides the flow's errors.
  double usual_experiments() const { return usual_; }
  /// In simulated experiments, for the progress: what is done, and that so much is, by work that
  /// simulates less than was expected.
  double spent() const { return spent_; }
  void reach(double spent) { spent_ = std::max(spent_, spent); }
  /// Experiments that estimates and intervals rest on.
  int simulations() const { return simulations_; }
  /// A piece's share of an experiment.
  double piece_cost() const { return piece_cost_; }

 private:
  std::string file(const std::string& stage) const;
  void tell(double spent, const std::string& stage) const;
  CalibrationSetup& setup_;
  Emulator whole_, piece_;  ///< in the flow without its mean error
  std::optional<ScorePlan> predicted_;
  int simulations_ = 0;
  double piece_cost_ = 0, search_cost_ = 0, usual_ = 0, expected_ = 0,
         spent_ = 0;  ///< in simulated experiments
};

/// A response surface about the estimate, its simulations, and the data's fit.
struct LocalAnswer {
  Design design;
  ResponseSurface model;
  LocalFit fit;
  int rounds = 0;
  bool settled = false;  ///< the last design was centred at the estimate
  Eigen::MatrixXd
      spread;  ///< of the designs: a lower triangle, points are its products with normals
  Eigen::VectorXd observed;  ///< the data's numbers
};
LocalAnswer find_locally(Stages& stages, const std::vector<double>& from, const FlowMaps& maps,
                         CalibrationResult& out);

/// Fills in estimates, intervals, correlations, profiles, misfit and numbers.
void find_intervals(Stages& stages, const LocalAnswer& answer, const FlowMaps& maps,
                    CalibrationResult& out);

/// Where the search by displacements ended, on the fitted scale.
struct NearestPoint {
  Eigen::VectorXd point;
  int rounds = 0;
  bool settled = false;  ///< the last round was about the point
};
/// The statistics are averaged over the flow's posterior, and drag, damping and K_v have nearly the
/// same effect on them, so a combination of the parameters may remain undetermined. Among the
/// parameters of the posterior (mean `middle` and covariance, on the fitted scale, nuisances at the
/// end), these have the least difference of the MSD [Eq. 9] in the best flow. `centre`: start of
/// the search.
NearestPoint nearest_displacements(Stages& stages, const Eigen::VectorXd& middle,
                                   const Eigen::MatrixXd& covariance,
                                   const Eigen::VectorXd& centre);

/// Eq. 9 before and after, against the noise floor, and Fig. 7's maps.
void compare_with_data(Stages& stages, CalibrationResult& out);

}  // namespace lilytank
