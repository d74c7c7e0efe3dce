// The face-segment drag of one module: the hot loop of the whole simulator.
#pragma once
#include "bulk_normals.hpp"
#include "lilytank/flow_field.hpp"
#include "lilytank/math.hpp"

namespace lilytank {

/// Drag points of a module, padded to what one bulk draw serves; face f's segment k is point
/// f * segments + k.
constexpr int kDragPoints = kBulkBlocks * kBulkPairs;
constexpr int kMostSegments = kDragPoints / 4;

/// What is the same for all modules and steps, float32.
struct DragPoints {
  DragPoints(int segments, double side);
  alignas(64) float px[kDragPoints], py[kDragPoints];  ///< m, in the module's frame
  alignas(64) float nx[kDragPoints], ny[kDragPoints];  ///< outward normals; 0 where padded
  int segments;
};

/// The water as the kernel reads it.
struct WaterView {
  const float* packed;  ///< FlowField::packed()
  int cells;
  float extent, per_metre;  ///< m, 1/m
  bool nearest;
  float K_v;
};

struct BodyView {
  float x, y, c, s, vx, vy, omega;
};

/// Gusts at a module's drag points, standard normals per axis.
struct PointGusts {
  alignas(64) float x[kDragPoints], y[kDragPoints];
};

/// Sum over the segments of max(0, -n.w) w, w = u(p) - v_p, and of its torque about the centre
/// (m^2/s^2 and m^3/s^2 per unit segment area). Faces whose bit is set in `covered` feel nothing.
Wrench face_drag_sum(const DragPoints& points, const WaterView& water, const BodyView& body,
                     unsigned covered, const PointGusts& gusts);

}  // namespace lilytank
