// How innovations answer to accelerations that the model lacks, carried along with the filter.
#pragma once
#include <vector>

#include "lilytank/predictor.hpp"

namespace lilytank {

/// Accelerations of one module, one value a feature: m/s^2, m/s^2, rad/s^2.
struct Pushes {
  std::vector<float> x, y, turn;
  explicit Pushes(std::size_t features) : x(features), y(features), turn(features) {}
  void clear() {
    for (auto* of : {&x, &y, &turn}) std::fill(of->begin(), of->end(), 0.0f);
  }
};

/// For a number of features, each an acceleration of every module: sums of score and information.
class Sensitivities {
 public:
  Sensitivities(std::size_t features, std::size_t modules);

  /// A module whose prediction cannot be used at this frame: forgets what it was pushed by.
  void forget(std::size_t module);
  /// Carries all features of module `module`, which is number `i` of the frame, over a frame and
  /// takes up what the frame then showed if `told`. `loss`: share of a velocity that drag takes in
  /// a second.
  void pass(std::size_t module, const Pushes& pushes, const PredictedFrame& frame, std::size_t i,
            double loss, bool told);

  /// The estimate of a feature's amplitude; 0 where nothing was pushed. `known`: information before
  /// any data that it is 0, to which that draws what was hardly seen.
  double estimate(std::size_t feature, double known = 0) const;
  /// By how much the feature at its estimate raises twice the log-likelihood of what was seen.
  double gain(std::size_t feature) const { return estimate(feature) * score_[feature]; }

 private:
  std::size_t features_;
  std::vector<float> x_, vx_, y_, vy_, t_, w_;  // [module * features + feature]
  std::vector<double> score_, information_;
};

}  // namespace lilytank
