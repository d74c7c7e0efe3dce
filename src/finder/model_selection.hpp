// Which effects explain an experiment's residuals: generalised least squares on fingerprints, with
// every threshold taken from simulated null experiments.
#pragma once
#include <string>
#include <vector>

#include "finder/candidate.hpp"
#include "finder/null_thresholds.hpp"
#include "finder/reference_ensemble.hpp"

namespace lilytank {

/// The effects that were selected, strongest first, and what they do not explain.
struct SelectedModel {
  std::vector<EffectFit> found;
  /// The strongest effect and shape in the remaining residual, by the thresholds of nulls.
  EffectFit left_effect, left_shape;
  double inexact = 0;  ///< z that errors of the findings' fingerprints may leave
  /// Remaining squared distance of all named statistics, over the noise of the fingerprints.
  double misfit = 0;
  double share_left = 1;          ///< of the squared distance before
  double penalized_deviance = 0;  ///< -2 log likelihood of the named statistics, and a price
};

/// -2 log likelihood of named statistics at this squared distance, and a price for amplitudes. Wide
/// scatter explains anything, and pays for it by the determinant of its covariance.
double penalized_deviance(double squared, const Eigen::MatrixXd& whitener, Eigen::Index amplitudes);

/// One effect or shape alone, by the scatter of the experiments of its own fingerprint.
struct SingleFit {
  Eigen::VectorXd amplitudes;
  double penalized_deviance = 0;
};

/// What simulations of several effects at once have beyond the sum of each alone.
struct Interaction {
  std::vector<std::size_t> of;  ///< indices of candidates, rising
  Eigen::VectorXd more;         ///< of residuals
};

/// All that a selection depends on beside the residual.
struct SelectionState {
  Whitening whitening;
  std::vector<std::string> terms;     ///< of each effect: the path of its first amplitude
  std::vector<bool> between_modules;  ///< of each effect: a force between them
  std::vector<EffectCandidate> candidates;
  std::vector<double> shape_scale;  ///< gains of each curve's knots in nulls, by their number
  std::vector<Interaction> interactions;
  NullThresholds thresholds;
};

/// Price of an amplitude, in squared distance.
inline constexpr double kAmplitudePrice = 4;

class ModelSelection {
 public:
  /// `nulls`: residuals of null experiments, a row each, those of `curves` times kKnots knots at
  /// the end; `expected_correlation`: of the first of them (score_correlations), or empty;
  /// `fingerprints`: the effects'; `false_alarms`: false-positive rate of null experiments.
  ModelSelection(const Eigen::MatrixXd& nulls, const Eigen::MatrixXd& expected_correlation,
                 const std::vector<Effect>& effects, const std::vector<Fingerprint>& fingerprints,
                 std::size_t curves, double false_alarms);

  /// Every effect alone, strongest first.
  std::vector<EffectFit> effects(const Eigen::VectorXd& residual) const;
  std::vector<EffectFit> shapes(const Eigen::VectorXd& residual) const;
  /// Adds the fingerprint of a shape, so that it competes with the named effects.
  void add_shape(int shape, const Fingerprint& fingerprint);
  /// The effects, and shapes that were added, that explain most, each alone; at most `count`.
  std::vector<EffectFit> leading(const Eigen::VectorXd& residual, int count) const;
  /// What explains nearly as much as a member of `found` does beside the others, that member first;
  /// at most `count` for each.
  std::vector<EffectFit> rivals(const Eigen::VectorXd& residual,
                                const std::vector<EffectFit>& found, double nearly,
                                std::size_t count) const;
  /// Replaces a fingerprint by one about the amplitudes that were found.
  void set_fingerprint(const EffectFit& fit, const Fingerprint& fingerprint);
  /// Adds variance to the named statistics' residuals.
  void inflate_covariance(const Eigen::VectorXd& variance);
  /// Judges by the scatter of experiments with an effect, a row each about their mean, where it is
  /// more than that of nulls (with_scatter).
  void inflate_by_scatter(const Eigen::MatrixXd& scatter);
  SingleFit fit_alone(const Eigen::VectorXd& residual, int effect, int shape) const;
  /// What several effects leave in residuals at these amplitudes if all are there: they need not
  /// add up. `experiments`: that the mean rests on.
  void add_interaction(const std::vector<EffectFit>& of, const Eigen::VectorXd& residual,
                       int experiments);
  /// The effects, and shapes that were added, that together explain residuals down to the
  /// thresholds. The search starts from those of `start`.
  SelectedModel select(const Eigen::VectorXd& residual,
                       const std::vector<EffectFit>& start = {}) const;
  double effect_threshold() const { return state_.thresholds.effect; }
  double shape_threshold() const { return state_.thresholds.shape; }
  /// Of the squared distance of all named statistics.
  double misfit_threshold() const { return state_.thresholds.misfit; }
  /// Probability that in a null experiment no effect (no curve, of a shape's fit) is as strong.
  double confidence(const EffectFit& fit) const;
  /// Squared distance of all named statistics without any effect.
  double baseline_misfit(const Eigen::VectorXd& residual) const;
  /// Whether the remaining residual exceeds a threshold of nulls.
  bool leaves_residual(const SelectedModel& m) const {
    return m.misfit > misfit_threshold() || m.left_shape.z > shape_threshold();
  }
  /// Whether so much remains that the names explain nothing.
  bool fails(const SelectedModel& m) const;
  /// Amplitude of an effect that is detected with probability one half, in units of its size and
  /// along the component and sign that show least; infinite if one of them shows nothing.
  double smallest_detectable(int effect) const;
  /// Deviations by which an effect at these amplitudes moves residuals, calibrated without it.
  double expected_z(int effect, const Eigen::VectorXd& amplitudes) const;
  /// The same by the mean change of residuals in `experiments` with an effect like this one; -1: by
  /// the curve that shows it best.
  double expected_z(int effect, const Eigen::VectorXd& change, int experiments) const;

 private:
  SelectionState state_;
};

}  // namespace lilytank
