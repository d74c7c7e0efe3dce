// The face-segment drag of one module: the hot loop of the whole simulator.
#pragma once
#include "bulk_normals.hpp"
#include "lilytank/flow_field.hpp"
#include "lilytank/math.hpp"

namespace lilytank {

/// Most segments a face may have: two faces' points share one bulk draw.
constexpr int kMostSegments = kBulkBlocks / 2;
/// Drag points of a module, padded: faces 0 and 1 from 0, faces 2 and 3 from kBulkBlocks.
constexpr int kDragPoints = 2 * kBulkBlocks;

/// What is the same for all modules and steps, float32. Points are numbered as the gusts are: face
/// f's segment k is at (f / 2) * kBulkBlocks + (f % 2) * segments + k.
struct DragPoints {
  DragPoints(int segments, double side);
  alignas(64) float px[kDragPoints], py[kDragPoints];  ///< m, in the module's frame
  alignas(64) float nx[kDragPoints], ny[kDragPoints];  ///< outward normals; 0 where padded
  int segments;
};

/// The water around one module as the kernel reads it.
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

/// Sum over the segments of max(0, -n.w) w, w = u(p) - v_p, and of its torque about the centre
/// (m^2/s^2 and m^3/s^2 per unit segment area), with xi[0] and xi[1] the gusts per point and axis.
/// Faces whose bit is set in `covered` feel nothing.
Wrench face_drag_sum(const DragPoints& points, const WaterView& water, const BodyView& body,
                     unsigned covered, const float xi[2][kDragPoints]);

}  // namespace lilytank
