// Which effects explain an experiment's residuals: generalised least squares on fingerprints, with
// every threshold taken from simulated experiments in which nothing is missing.
#pragma once
#include <string>
#include <vector>

#include "finder/atlas.hpp"

namespace lilytank {

/// An effect, or a shape without a name, and how well it explains residuals.
struct EffectFit {
  int effect = -1;             ///< index into the plan's effects; -1: a shape
  int shape = -1;              ///< index into the plan's shapes
  Eigen::VectorXd amplitudes;  ///< in units of the effect's sizes
  Eigen::VectorXd moved;  ///< how far it moves a calibration that knows nothing of it, in its scale
  double gain = 0;        ///< fall of the squared distance
  int about = 0;          ///< experiments of a fingerprint about found amplitudes; 0: learned
  bool at_reach = false;  ///< as far as its fingerprint holds: the truth may be beyond
  double z = 0;           ///< deviations of a normal number with the same probability
};

/// What was found, strongest first.
struct Explanation {
  std::vector<EffectFit> found;
  /// The strongest effect and shape in what is left, against what is expected of nothing.
  EffectFit left_effect, left_shape;
  /// Squared distance of all named numbers that is left, by what fingerprints' own noise adds.
  double misfit = 0;
  double share_left = 1;  ///< of the squared distance that there was
  double doubt = 0;       ///< -2 log likelihood of the named numbers, and a price for amplitudes
};

/// The law of the largest of many numbers (Gumbel's), by its mean and deviation in nulls.
class ExtremeLaw {
 public:
  ExtremeLaw() = default;
  explicit ExtremeLaw(const std::vector<double>& largest);
  double exceeded_with(double probability) const;  ///< the number that is exceeded so often
  double chance_beyond(double value) const;        ///< how often that number is exceeded

 private:
  double mean_ = 0, scale_ = 0;
};

class Naming {
 public:
  /// `nulls`: residuals of experiments in which nothing is missing, a row each, those of `curves`
  /// times kKnots knots at the end; `alike`: correlations that the first of them should have
  /// (score_correlations), or nothing; `fingerprints`: the effects'; `false_alarms`: share of
  /// experiments with nothing missing that may be called otherwise.
  Naming(const Eigen::MatrixXd& nulls, const Eigen::MatrixXd& alike,
         const std::vector<Effect>& effects, const std::vector<Fingerprint>& fingerprints,
         std::size_t curves, double false_alarms);

  /// Every effect alone, strongest first.
  std::vector<EffectFit> effects(const Eigen::VectorXd& residual) const;
  std::vector<EffectFit> shapes(const Eigen::VectorXd& residual) const;
  /// Adds the fingerprint of a shape, so that it competes with the named effects.
  void add_shape(int shape, const Fingerprint& fingerprint);
  /// The effects, and shapes that were added, that leave least, each alone; at most `count`.
  std::vector<EffectFit> leading(const Eigen::VectorXd& residual, int count) const;
  /// What explains nearly as much as a member of `found` does beside the others, that member first;
  /// at most `count` for each.
  std::vector<EffectFit> rivals(const Eigen::VectorXd& residual,
                                const std::vector<EffectFit>& found, double nearly,
                                std::size_t count) const;
  /// Replaces a fingerprint by one about the amplitudes that were found.
  void sharpen(const EffectFit& fit, const Fingerprint& fingerprint);
  /// Judges as if the named numbers' residuals had so much more variance.
  void widen(const Eigen::VectorXd& variance);
  /// Judges by the scatter of experiments with an effect, a row each about their mean, where it is
  /// more than that of nulls: modules that stick scatter otherwise than modules that drift.
  void loosen(const Eigen::MatrixXd& scatter);
  /// This effect or shape alone, by the named numbers and judged by the scatter of the experiments
  /// that its fingerprint rests on.
  struct Alone {
    Eigen::VectorXd amplitudes;
    double doubt = 0;
  };
  Alone alone(const Eigen::VectorXd& residual, int effect, int shape) const;
  /// What several effects leave in residuals at these amplitudes if all are there: they need not
  /// add up. `experiments`: that the mean rests on.
  void add_meeting(const std::vector<EffectFit>& of, const Eigen::VectorXd& residual,
                   int experiments);
  /// The effects, and shapes that were added, that together explain residuals until nothing is
  /// left. The search begins with those of `begun`.
  Explanation explain(const Eigen::VectorXd& residual,
                      const std::vector<EffectFit>& begun = {}) const;
  double effect_threshold() const { return effect_threshold_; }
  double shape_threshold() const { return shape_threshold_; }
  /// Probability that in a complete experiment no effect (no curve, of a shape's fit) is as strong.
  double confidence(const EffectFit& fit) const {
    return 1 - (fit.effect >= 0 ? largest_effect_ : largest_shape_).chance_beyond(fit.z);
  }
  /// Of the squared distance of all named numbers.
  double misfit_threshold() const { return misfit_threshold_; }
  /// Squared distance of all named numbers if nothing is there.
  double misfit_of_nothing(const Eigen::VectorXd& residual) const;
  /// Whether something is left, with a name or without.
  bool leaves_something(const Explanation& e) const {
    return e.misfit > misfit_threshold_ || e.left_shape.z > shape_threshold_;
  }
  /// Whether so much is left that the names explain nothing.
  bool fails(const Explanation& e) const;
  /// Amplitude of an effect at which it would be seen with probability one half, in units of its
  /// size and along the component and sign that show least; infinite if one of them shows nothing.
  double smallest_seen(int effect) const;
  /// Deviations by which an effect at these amplitudes moves residuals, calibrated without it.
  double expected_z(int effect, const Eigen::VectorXd& amplitudes) const;
  /// The same of residuals that are the mean of `experiments` with an effect like this one.
  double expected_z(int effect, const Eigen::VectorXd& mean, int experiments) const;

 private:
  struct Known {
    int effect = -1, shape = -1;
    Fingerprint source;
    Eigen::MatrixXd learned;  ///< first orders of residuals at usual sizes
    /// Whitened, of named numbers, and of all: those named, and each shape's knots by themselves.
    /// Shapes overlap, so a gain in all numbers has a scale of its own.
    Answer named, all;
    Eigen::MatrixXd basis;  ///< first orders of all numbers, as learned at usual sizes
    /// Mean gain of nulls by its degrees of freedom, in the named numbers and in all.
    double scale = 1, scale_all = 1;
  };
  Known known(const Fingerprint& fingerprint, int effect, int shape) const;
  void renew(Known& of, const Fingerprint& fingerprint) const;
  std::size_t place_of(int effect, int shape) const;
  static EffectFit fitted(const Known& of, const Answer& answer, const Eigen::VectorXd& data);
  EffectFit fit(const Known& of, const Eigen::VectorXd& all) const;
  Eigen::MatrixXd whitened(const Eigen::MatrixXd& residuals) const;
  EffectFit fit_shape(int shape, const Eigen::VectorXd& knots) const;
  double length(const Known& of, const Eigen::VectorXd& residual, double noise) const;
  double z_of(double gain, double scale, Eigen::Index freedom) const;
  /// Of one effect in one null.
  struct Gains {
    double named = 0, all = 0;
  };
  struct NullGains {
    std::vector<std::vector<Gains>> effects;  ///< [known][null]
    Eigen::MatrixXd knots;                    ///< a row each null, a column each shape
    std::vector<double> misfits;              ///< squared distance of the named numbers
  };
  NullGains gains_of(const Eigen::MatrixXd& nulls);
  void calibrate(const Eigen::MatrixXd& nulls, double false_alarms);
  /// Effects at once: places in the list of known ones, amplitudes, and what they leave.
  struct Together {
    std::vector<std::size_t> of;
    std::vector<EffectFit> fits;
    Eigen::VectorXd left;
  };
  /// What simulations of several effects at once have more than the sum of each alone.
  struct Meeting {
    std::vector<std::size_t> of;
    Eigen::VectorXd more;  ///< of residuals
  };
  struct Candidate {
    std::size_t known = 0;
    EffectFit fit;
    double worth = 0;
  };
  bool told_already(const EffectFit& fit, const std::vector<EffectFit>& found) const;
  bool within_curve(const Known& of, const std::vector<EffectFit>& found) const;
  double floor_beside(const std::vector<EffectFit>& found) const;
  double worth_of(double gain, const EffectFit& of) const;
  Eigen::VectorXd meeting(const Together& set) const;
  Together set_of(const Eigen::VectorXd& all, const std::vector<EffectFit>& found) const;
  void fit_together(const Eigen::VectorXd& all, Together& set) const;
  std::vector<Candidate> candidates(const Together& set, EffectFit& strongest) const;
  Together extended(const Eigen::VectorXd& all, const Together& set) const;
  Together without(const Eigen::VectorXd& all, const Together& set, std::size_t member) const;
  void exchange(const Eigen::VectorXd& all, Together& set) const;
  double cost(const Together& set) const;
  double noise_of(const Together& set) const;
  Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& rows) const;
  Eigen::MatrixXd whitener_by(const Eigen::MatrixXd& scatter) const;
  static double doubt(double left, const Eigen::MatrixXd& whitener, Eigen::Index amplitudes);
  std::vector<std::pair<std::size_t, std::size_t>> leading_pairs(const Eigen::VectorXd& all) const;
  std::vector<Together> pairs(const Eigen::VectorXd& all) const;
  bool each_speaks(const Together& set) const;
  Together larger(const Eigen::VectorXd& all, const Together& set) const;
  EffectFit strongest_shape(const Eigen::VectorXd& all) const;

  static constexpr double kAmplitudePrice = 4;  // in squared distance
  static constexpr double kNoisy = 2.5;         // standard errors below which a number is noise

  Eigen::Index named_;                  ///< numbers before the shapes' knots
  std::vector<std::string> terms_;      ///< of each effect: the path of its first amplitude
  Eigen::MatrixXd alike_;               ///< root of the expected correlations
  Eigen::VectorXd centre_;              ///< mean of the nulls' residuals
  Eigen::MatrixXd covariance_;          ///< of the named numbers of nulls
  std::vector<Eigen::MatrixXd> knots_;  ///< of each shape's
  Eigen::MatrixXd whitener_;            ///< of the named numbers
  std::vector<Eigen::MatrixXd> root_;   ///< whitens each shape's knots
  std::vector<double> shape_scale_;
  std::vector<Known> known_;
  std::vector<Meeting> meetings_;
  ExtremeLaw largest_effect_, largest_shape_;  ///< z of nulls
  double effect_threshold_ = 0, shape_threshold_ = 0, misfit_threshold_ = 0;
  double null_misfit_ = 0;  ///< mean squared distance of nulls
};

}  // namespace lilytank
