// What experiments in a tank look like if the baseline is all there is, and if an effect is there
// too: learned from simulations, once for a tank, for any number of experiments.
//
// The vector of an experiment is its motion summary, from which parameters are calibrated, and its
// scores (scores.hpp). Simulations at scattered parameters, each in another flow that the balls
// allow, give its mean as a function of the parameters; calibrating every one of them as if it were
// data gives residuals, and these the covariance that remains after calibration: what calibration
// can absorb is gone from it. Experiments with an effect, calibrated without it, give the effect's
// fingerprint in residuals. [Gallant and Tauchen 1996; Allen and Tett 1999]
#pragma once
#include <Eigen/Core>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/estimate_line.hpp"
#include "calibrate/stages.hpp"
#include "finder/fingerprint.hpp"
#include "lilytank/response_surface.hpp"
#include "scores/scores.hpp"

namespace lilytank {

/// Fingerprints about amplitudes that were found, by the names of effects and shapes, and the
/// parameters they were learned at. Each judgement learns its own: what is said of one experiment
/// must not depend on which others were diagnosed before.
struct LearnedFingerprint {
  Eigen::VectorXd point;
  Fingerprint fingerprint;
  int experiments = 0;  ///< requested
};
using LearnedFingerprints = std::map<std::string, std::vector<LearnedFingerprint>>;

struct EnsembleOptions {
  int nulls = 300;    ///< experiments simulated without any effect
  Learning learning;  ///< with one
  std::uint64_t seed = 1;
  std::uint64_t curve_seed = 1;  ///< of the fingerprints of curves
};

/// An experiment's vector, its two parts.
struct Vectors {
  Eigen::VectorXd summary, scores;
};

class ReferenceEnsemble {
 public:
  /// Simulates what is not kept yet. Throws Stopped, InputError.
  ReferenceEnsemble(Stages& stages, const FlowMaps& maps, ScorePlan plan,
                    const Eigen::VectorXd& centre, const Eigen::MatrixXd& spread,
                    const EnsembleOptions& options);

  static constexpr int kAbout = 10;  ///< experiments of a fingerprint about found amplitudes

  const ScorePlan& plan() const { return plan_; }
  Vectors vectors(const std::vector<Recording>& recordings, ScoreDetails* details = nullptr) const;
  Eigen::VectorXd summary(const std::vector<Recording>& recordings) const;
  /// Parameters (fitted scale) that explain a summary best.
  LocalFit nearest(const Eigen::VectorXd& summary) const;
  /// Parameters fitted to a summary as far as a baseline explains it: the rest must not move them
  /// to imitate an omitted effect.
  Eigen::VectorXd calibrated(const Eigen::VectorXd& summary) const;
  /// Posterior of the parameters for a summary under the baseline, with errors from cross-fitted
  /// surfaces of the null experiments.
  ParameterEstimate posterior(const Eigen::VectorXd& summary, const Prior& before) const;
  /// Scores less their mean at the calibrated parameters, by their deviations among nulls; of all
  /// numbers, shapes' knots at the end.
  Eigen::VectorXd residual(const Vectors& vectors) const;
  /// How far the displacements alone are from what the calibrated baseline gives, a squared
  /// distance by their covariance: all that a comparison of MSDs could see.
  double displacement_misfit(const Eigen::VectorXd& summary) const;
  /// Of every null, a row each.
  const Eigen::MatrixXd& null_residuals() const { return null_residuals_; }
  Eigen::Index named_numbers() const { return named_; }  ///< those before the shapes
  /// Of the scores of effects, the first of the named numbers, in the calibrated recordings.
  const Eigen::MatrixXd& informations() const { return informations_; }
  const std::vector<Fingerprint>& fingerprints() const { return fingerprints_; }
  /// The fingerprint of a curve of the plan; its experiments are simulated at the first call.
  const Fingerprint& shape_fingerprint(int shape);
  /// The fingerprint where it is needed: near amplitudes that are far from those it was learned at,
  /// at the parameters at which calibration then finds `calibrated` in spite of the effect. One
  /// that was learned within kBeside of there before, by no fewer experiments (an even number),
  /// serves again; a new one is added. `name`: of the effect or shape, its own.
  Fingerprint fingerprint_about(const Eigen::VectorXd& amplitudes, const Fingerprint& from,
                                const Effect& effect, const Eigen::VectorXd& calibrated,
                                const std::string& name, LearnedFingerprints& learned,
                                int experiments = kAbout);
  /// Mean residual of `experiments` simulated with an effect at these amplitudes and parameters;
  /// kept as `stage`.
  Eigen::VectorXd mean_residual(const Effect& effect, const Eigen::VectorXd& amplitudes,
                                const Eigen::VectorXd& point, int experiments,
                                const std::string& stage, std::uint64_t seed);
  /// Numbers of `count` further null experiments, kept as `stage`: a row each, without those that
  /// diverged.
  using Measure = std::function<std::vector<double>(const std::vector<Recording>&)>;
  Eigen::MatrixXd further_nulls(const std::string& stage, int count, const Measure& numbers) const;
  const ResponseSurface& parameters() const { return *parameters_; }
  const Eigen::VectorXd& deviations() const { return deviation_; }

 private:
  /// Experiments about a point: parameters and amplitudes, a row each.
  struct Simulation {
    Eigen::MatrixXd points;
    std::function<std::optional<std::vector<Recording>>(int)> record;  ///< that of a row
  };
  Simulation simulation(const Emulator& emulator, const Eigen::VectorXd& about,
                        const Eigen::MatrixXd& spread, const Eigen::MatrixXd& amplitudes,
                        const Effect* effect, std::uint64_t seed) const;
  Simulation nulls(int count, std::uint64_t seed) const;
  Simulation simulation_with(const Effect& effect, const Eigen::VectorXd& about,
                             const Eigen::MatrixXd& spread, const Eigen::MatrixXd& amplitudes,
                             std::uint64_t seed) const;
  /// Those that an effect's fingerprint is learned from.
  Simulation learning(const Effect& effect, std::uint64_t seed) const;
  static Stages::RowsOfStage measured(const std::string& stage, const Simulation& of,
                                      const Measure& numbers);
  /// Summaries and scores.
  Stages::RowsOfStage scored(const std::string& stage, const Simulation& of) const;

  // Fingerprints (ensemble_fingerprints.cpp).

  void learn_effects();
  /// Experiments with an effect, calibrated without it.
  struct Responses {
    Eigen::MatrixXd amplitudes, points, residuals, moved;  ///< a row each
  };
  Responses answers(const Effect& effect, const std::string& stage, const Eigen::VectorXd& about,
                    const Eigen::MatrixXd& spread, const Eigen::MatrixXd& amplitudes,
                    std::uint64_t seed);
  Responses responses(const Simulation& of, const std::vector<std::vector<double>>& rows) const;
  Fingerprint fingerprint(const Effect& effect, const Responses& made) const;
  const LearnedFingerprint* nearest_of(const Effect& effect,
                                       const std::vector<LearnedFingerprint>& learned,
                                       const Eigen::VectorXd& amplitudes,
                                       const Eigen::VectorXd& point, int experiments) const;
  Prior prior() const;
  Eigen::Index summary_numbers() const;
  Eigen::VectorXd residual_at(const Eigen::VectorXd& scores, const Eigen::VectorXd& point) const;
  Stages& stages_;
  const FlowMaps& maps_;
  ScorePlan plan_;
  EnsembleOptions options_;
  Eigen::VectorXd centre_;
  Eigen::MatrixXd spread_;
  Design summaries_;  ///< of nulls
  std::unique_ptr<ResponseSurface> parameters_, scores_;
  Eigen::VectorXd deviation_;
  Eigen::MatrixXd null_residuals_, informations_;
  Eigen::Index named_ = 0;
  std::vector<Fingerprint> fingerprints_;
  std::map<int, Fingerprint> shape_fingerprints_;  ///< those learned so far
};

}  // namespace lilytank
