// A flow found from balls, and the flows that the balls would allow as well.
//
// What is calibrated in an extracted flow inherits its errors. Their mean is known from doing it
// again: balls simulated in the extracted flow, recorded and extracted from anew, give fields that
// differ from the flow that was simulated. Their scatter would be too small, as the extracted flow
// is smoother than the water was: it comes from the posterior, which holds structure that the balls
// do not resolve.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "lilytank/flow_estimate.hpp"

namespace lilytank {

/// Extracts the flow again from simulated balls in `estimate`'s field: draw number `run` of its
/// error. `balls` give the shape of the recordings. Throws InputError if the estimate has no noise
/// budget.
FlowDifference redraw_flow(const FlowEstimate& estimate, std::span<const Recording> balls,
                           const BallPhysics& physics, const FlowOptions& options,
                           std::uint64_t seed, int run);

/// An extracted flow with its uncertainty, as a family of fields. Constant once made.
class FlowMaps {
 public:
  /// A flow without error.
  explicit FlowMaps(std::shared_ptr<const FlowField> field) : field_(std::move(field)) {}
  /// An estimated flow with draws of its error and at least two draws from the posterior. The mean
  /// error is subtracted. `components`: FlowEstimate::components.
  FlowMaps(const FlowField& extracted, const std::vector<FlowDifference>& errors,
           const std::vector<FlowDifference>& open, std::vector<FlowDifference> components = {});

  /// The extracted field less its mean error.
  const std::shared_ptr<const FlowField>& best() const { return field_; }
  /// Whether draw() differs from best().
  bool uncertain() const { return !open_.empty(); }
  /// A field that could be the true one: the best and a normal combination of what is open, draw
  /// `run`.
  std::shared_ptr<const FlowField> draw(std::uint64_t seed, std::int64_t run) const;
  /// Principal components of what is open in the mean; empty if they are not known.
  const std::vector<FlowDifference>& components() const { return components_; }

 private:
  std::shared_ptr<const FlowField> field_;
  /// What is open, a draw after the other about their mean, in single precision: sums of all are
  /// the larger part of a draw.
  std::vector<float> open_;
  std::vector<FlowDifference> components_;
};

}  // namespace lilytank
