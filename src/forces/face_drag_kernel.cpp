#include "face_drag_kernel.hpp"

#include <algorithm>

#include "clones.hpp"

namespace lilytank {
namespace {

constexpr int kN = kDragPoints;
typedef float Float4 __attribute__((vector_size(16)));

struct Lanes {
  alignas(64) float v[kN];
};

// Cell and place within it of every point.
LILYTANK_INLINE void locate(const WaterView& water, float x, float y, const Lanes& rx,
                            const Lanes& ry, int cell[kN], Lanes& tx, Lanes& ty) {
  const float last = static_cast<float>(water.cells - 1);
  const float most = static_cast<float>(water.cells - 2);
  for (int i = 0; i < kN; ++i) {
    float gx = (x + rx.v[i] + water.extent) * water.per_metre - 0.5f;
    float gy = (y + ry.v[i] + water.extent) * water.per_metre - 0.5f;
    gx = std::min(std::max(gx, 0.0f), last), gy = std::min(std::max(gy, 0.0f), last);
    if (water.nearest) {
      gx = static_cast<float>(static_cast<int>(gx + 0.5f));
      gy = static_cast<float>(static_cast<int>(gy + 0.5f));
    }
    const float cx = static_cast<float>(static_cast<int>(std::min(gx, most)));
    const float cy = static_cast<float>(static_cast<int>(std::min(gy, most)));
    tx.v[i] = gx - cx, ty.v[i] = gy - cy;
    cell[i] = static_cast<int>(cy) * water.cells + static_cast<int>(cx);
  }
}

// Bilinear mean and deviation, four floats a point.
LILYTANK_INLINE void sample(const WaterView& water, const int cell[kN], const Lanes& tx,
                            const Lanes& ty, Float4 out[kN]) {
  for (int i = 0; i < kN; ++i) {
    Float4 a, b, c, d;
    const float* f = water.packed + 4 * static_cast<std::ptrdiff_t>(cell[i]);
    __builtin_memcpy(&a, f, 16), __builtin_memcpy(&b, f + 4, 16);
    __builtin_memcpy(&c, f + 4 * water.cells, 16), __builtin_memcpy(&d, f + 4 * water.cells + 4, 16);
    const Float4 low = a + (b - a) * tx.v[i], high = c + (d - c) * tx.v[i];
    out[i] = low + (high - low) * ty.v[i];
  }
}

// Eight partial sums in a fixed order, whatever the vectors' width.
LILYTANK_INLINE float total(const Lanes& a) {
  float part[8] = {};
  for (int i = 0; i < kN; i += 8)
    for (int j = 0; j < 8; ++j) part[j] += a.v[i + j];
  return ((part[0] + part[4]) + (part[1] + part[5])) + ((part[2] + part[6]) + (part[3] + part[7]));
}

LILYTANK_CLONES void drag(const DragPoints& points, const WaterView& water, const BodyView& b,
                          const float* open, const float* xi_x, const float* xi_y, float out[3]) {
  Lanes rx, ry, tx, ty, fx, fy, torque;
  int cell[kN];
  Float4 flow[kN];
  for (int i = 0; i < kN; ++i) {
    rx.v[i] = b.c * points.px[i] - b.s * points.py[i];
    ry.v[i] = b.s * points.px[i] + b.c * points.py[i];
  }
  locate(water, b.x, b.y, rx, ry, cell, tx, ty);
  sample(water, cell, tx, ty, flow);
  const float* f = reinterpret_cast<const float*>(flow);
  for (int i = 0; i < kN; ++i) {
    const float ux = water.K_v * (f[4 * i] + f[4 * i + 2] * xi_x[i]);
    const float uy = water.K_v * (f[4 * i + 1] + f[4 * i + 3] * xi_y[i]);
    const float wx = ux - (b.vx - b.omega * ry.v[i]), wy = uy - (b.vy + b.omega * rx.v[i]);
    const float nx = b.c * points.nx[i] - b.s * points.ny[i];
    const float ny = b.s * points.nx[i] + b.c * points.ny[i];
    const float met = std::max(-(nx * wx + ny * wy), 0.0f) * open[i];
    fx.v[i] = met * wx, fy.v[i] = met * wy;
    torque.v[i] = rx.v[i] * fy.v[i] - ry.v[i] * fx.v[i];
  }
  out[0] = total(fx), out[1] = total(fy), out[2] = total(torque);
}

}  // namespace

DragPoints::DragPoints(int n, double side) : px{}, py{}, nx{}, ny{}, segments(n) {
  for (int f = 0; f < 4; ++f) {
    const Rot turn = quarter(f);
    for (int k = 0; k < n; ++k) {
      const int i = (f / 2) * kBulkBlocks + (f % 2) * n + k;
      const Vec2 p = rotate(turn, Vec2(side / 2, ((k + 0.5) / n - 0.5) * side));
      px[i] = static_cast<float>(p.x()), py[i] = static_cast<float>(p.y());
      nx[i] = static_cast<float>(turn.c), ny[i] = static_cast<float>(turn.s);
    }
  }
}

Wrench face_drag_sum(const DragPoints& points, const WaterView& water, const BodyView& body,
                     unsigned covered, const float xi[2][kDragPoints]) {
  alignas(64) float open[kDragPoints];
  std::fill(open, open + kDragPoints, 1.0f);
  for (int f = 0; covered != 0 && f < 4; ++f) {
    const int from = (f / 2) * kBulkBlocks + (f % 2) * points.segments;
    if (covered >> f & 1u) std::fill(open + from, open + from + points.segments, 0.0f);
  }
  float out[3];
  drag(points, water, body, open, xi[0], xi[1], out);
  return {out[0], out[1], out[2]};
}

}  // namespace lilytank
