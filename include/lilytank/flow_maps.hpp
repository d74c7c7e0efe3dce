// A flow found from balls, and the flows that the balls would allow as well.
//
// What is calibrated in an extracted flow inherits its errors. They are known from doing it again:
// balls simulated in the extracted flow, recorded and extracted from anew, give fields whose
// differences from the flow that was simulated are draws of the error.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "lilytank/flow_estimate.hpp"

namespace lilytank {

/// One field's difference from the truth, cell by cell.
using FlowDifference = std::vector<FlowSample>;

/// Extracts the flow again from simulated balls in `estimate`'s field: draw number `run` of its
/// error. `balls` give the shape of the recordings. Throws InputError if the estimate has no noise
/// budget.
FlowDifference redraw_flow(const FlowEstimate& estimate, std::span<const Recording> balls,
                           const BallPhysics& physics, const FlowOptions& options,
                           std::uint64_t seed, int run);

class FlowMaps {
 public:
  /// A flow that is known, or taken to be.
  explicit FlowMaps(std::shared_ptr<const FlowField> field) : field_(std::move(field)) {}
  /// A flow as it was extracted, with draws of the extraction's error; at least two.
  FlowMaps(const FlowField& extracted, std::vector<FlowDifference> errors);

  /// The extracted field less its mean error.
  const std::shared_ptr<const FlowField>& best() const { return field_; }
  bool uncertain() const { return !errors_.empty(); }
  /// A field that could be the true one: the best and a normal combination of the errors' scatter,
  /// draw `run`.
  std::shared_ptr<const FlowField> draw(std::uint64_t seed, std::int64_t run) const;

 private:
  std::shared_ptr<const FlowField> field_;
  std::vector<FlowDifference> errors_;  ///< about their mean
};

}  // namespace lilytank
