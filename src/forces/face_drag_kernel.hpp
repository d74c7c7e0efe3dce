// The face-segment drag of sixteen modules at once: the hot loop of the whole simulator.
#pragma once
#include <cstdint>

#include "lilytank/flow_field.hpp"
#include "lilytank/model.hpp"
#include "math/bulk_random.hpp"

namespace lilytank {

constexpr int kMostSegments = 24;

/// What is the same for all modules in a step.
struct DragSettings {
  DragSettings(const Model& model, int segments_, const StepContext& now);
  /// Takes over what changes from step to step.
  void set_moment(const Model& model, const StepContext& now);

  const FlowField* field;
  Gusts gusts;
  bool gusty;     ///< false: the mean flow only
  bool expected;  ///< gusty, but the mean over gusts instead of a draw
  FlowAt at;
  int segments;
  float half;  ///< m, half the side
  float K_v;
  float gust_gain;              ///< factor on the field's deviation
  Draw draw;                    ///< of the gusts; `body` is the first module of the block
  float places[kMostSegments];  ///< m, where segments lie: from a face's middle along its tangent
  float squares;                ///< m^2, sum of their squares
  /// m; three places and their weights, whose sums over polynomials up to degree five equal those
  /// over the segments (Gauss's rule with the segments' places as the measure). Set for
  /// moment-matched gusts only.
  float nodes[3], weights[3];

 private:
  /// From the sums of the places' second and fourth powers.
  void set_nodes(double second, double fourth);
};

/// Poses and twists of sixteen modules (m, m/s, rad/s), in arrays aligned to 64 bytes; `covered`
/// as in Kinematics.
struct DragBlock {
  const float *x, *y, *c, *s, *vx, *vy, *omega;
  const std::uint8_t* covered;
};

/// Sums over a module's segments of max(0, -n.w) w, w = u(p) - v_p (m^2/s^2), and of its torque
/// about the centre (m^3/s^2).
struct DragSums {
  alignas(64) float fx[kBulkBodies], fy[kBulkBodies], torque[kBulkBodies];
};

/// The drag of a block. With gusts per drag point, the normal gust of each segment is drawn
/// (numbers face * segments + k of bulk_normals()), and for each face one number more (4 * segments
/// + face) for what is left of its tangential gusts: given the normal ones, the tangential force is
/// normal with mean sum a c and variance sum a^2 r^2 (a = max(0, -n.w), c and r the tangential
/// flow's conditional mean and deviation), and it acts at one distance from the centre. That is
/// exact, with half the random numbers. With gusts per module, numbers 0 and 1 are the gust.
///
/// Moment-matched gusts: the wrench is normal with the exact mean and covariance (over the three
/// nodes of each face that integrate degree five over its segments exactly) and is made of numbers
/// 0, 1 and 2.
///
/// `kept`: where these numbers are kept, or null.
void face_drag_sums(const DragSettings& settings, const DragBlock& block, KeptGusts* kept,
                    DragSums& out);

/// How many numbers a module takes.
int gust_numbers(Gusts gusts, int segments);

}  // namespace lilytank
