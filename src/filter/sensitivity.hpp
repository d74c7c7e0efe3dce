// Sensitivity of the innovations to accelerations that the model omits, propagated with the filter.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "filter/sensitivity_kernel.hpp"
#include "lilytank/predictor.hpp"

namespace lilytank {

/// Accelerations of one body, one value a feature: m/s^2, m/s^2, rad/s^2.
struct Pushes {
  std::vector<float> x, y, turn;
  explicit Pushes(std::size_t features)
      : x(in_lanes(features)), y(in_lanes(features)), turn(in_lanes(features)) {}
  /// Those of an assembly, by those of every module of the frame: what pushes its members pushes
  /// it, at their arms.
  void of_members(const PredictedFrame& frame, const PredictedAssembly& assembly,
                  const std::vector<Pushes>& each);
  /// Features and empty ones, for vectors of any length.
  static std::size_t in_lanes(std::size_t features) {
    return (features + kFeatureLanes - 1) / kFeatureLanes * kFeatureLanes;
  }
};

/// For a number of features, each an acceleration of every body (a module, or an assembly of
/// latched ones): sums of score and information, and of their products with the last ones, of which
/// some are nuisances: what may be at fault for another's score.
class Sensitivities {
 public:
  /// `partners`: features at the end with which products are summed.
  Sensitivities(std::size_t features, std::size_t bodies, std::size_t partners);

  /// Forgets what pushed a body. Call it where its prediction cannot be used.
  void forget(std::size_t body);
  /// Carries all features of a body over a frame and takes up what the frame then showed of it if
  /// `usable`. `loss`: share of a velocity that drag takes in a second.
  void pass(std::size_t body, const Pushes& pushes, const PredictedFrame& frame,
            const Innovation& seen, double loss, bool usable);

  /// Call once all frames are passed, before the first result is read.
  void finish();
  /// An amplitude that is cleared of nuisances: the most likely one beside them.
  struct Amplitude {
    double estimate = 0, information = 0;
    /// By how much it raises twice the log-likelihood.
    double gain() const { return estimate * estimate * information; }
    /// The estimate where it was known with so much information to be 0.
    double drawn(double known) const {
      return information > 0 ? estimate * information / (information + known) : 0;
    }
  };
  /// Of every feature but the nuisances, the last ones; 0 where nothing was pushed. `known`:
  /// precision of the nuisances' amplitudes before any data, [nuisance, nuisance].
  std::vector<Amplitude> amplitudes(const Eigen::MatrixXd& known) const;
  /// By how much the nuisances, the last features, alone raise twice the log-likelihood.
  double absorbed(const Eigen::MatrixXd& known) const;
  /// Information of every two features that nuisances leave, if all features are partners: an
  /// amplitude of the second moves the estimate of the first by it over the first's own.
  Eigen::MatrixXd informations(const Eigen::MatrixXd& known) const;
  /// Scores of all features, and information of every two if all are partners; nothing is
  /// eliminated.
  Eigen::VectorXd scores() const { return last_scores(static_cast<Eigen::Index>(features_)); }
  Eigen::MatrixXd products() const { return products(static_cast<Eigen::Index>(features_)); }

 private:
  void pass_axis(const FeatureAxis& axis, bool summed, const float* push, float* x, float* v);
  void add_rows();
  void flush();
  /// Products of every feature with the last `count`.
  Eigen::MatrixXd products(Eigen::Index count) const;
  /// Scores of the last `count`.
  Eigen::Map<const Eigen::VectorXd> last_scores(Eigen::Index count) const;

  std::size_t features_, partners_, wide_;      // wide: features and empty ones
  std::vector<float> x_, vx_, y_, vy_, t_, w_;  // [body * wide + feature]
  std::vector<double> score_, information_;
  std::vector<double> shared_;  // products, [partner * wide + feature]
  // Sums of the last passings, in single precision, and rows that are not summed yet.
  std::vector<float> recent_score_, recent_information_, recent_shared_, rows_, now_;
  std::size_t kept_ = 0;                // rows
  std::size_t passed_ = 0, taken_ = 0;  // axes
};

}  // namespace lilytank
