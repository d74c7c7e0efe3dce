#include "face_drag_kernel.hpp"

#include <algorithm>

// Compiled once for each instruction set, as bulk_normals.cpp is, with the same bits from each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "forces/face_drag_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, 16>;
using Four = hn::CappedTag<float, 4>;
using Float = hn::Vec<Floats>;
using Whole = hn::RebindToSigned<Floats>;

struct Lanes {
  alignas(64) float v[kDragPoints];
};

// Cell and place within it of some points.
HWY_INLINE void locate(const WaterView& water, Float x, Float y, std::int32_t* cell, float* tx,
                       float* ty) {
  const Floats d;
  const Whole w;
  const Float last = hn::Set(d, static_cast<float>(water.cells - 1));
  const Float most = hn::Set(d, static_cast<float>(water.cells - 2));
  const Float extent = hn::Set(d, water.extent), per = hn::Set(d, water.per_metre);
  const Float half = hn::Set(d, 0.5f);
  Float gx = hn::Sub(hn::Mul(hn::Add(x, extent), per), half);
  Float gy = hn::Sub(hn::Mul(hn::Add(y, extent), per), half);
  gx = hn::Min(hn::Max(gx, hn::Zero(d)), last), gy = hn::Min(hn::Max(gy, hn::Zero(d)), last);
  if (water.nearest) {
    gx = hn::ConvertTo(d, hn::ConvertTo(w, hn::Add(gx, half)));
    gy = hn::ConvertTo(d, hn::ConvertTo(w, hn::Add(gy, half)));
  }
  const auto ix = hn::ConvertTo(w, hn::Min(gx, most)), iy = hn::ConvertTo(w, hn::Min(gy, most));
  hn::Store(hn::Sub(gx, hn::ConvertTo(d, ix)), d, tx);
  hn::Store(hn::Sub(gy, hn::ConvertTo(d, iy)), d, ty);
  hn::Store(hn::Add(hn::Mul(iy, hn::Set(w, water.cells)), ix), w, cell);
}

// Bilinear mean and deviation at a point, four floats.
HWY_INLINE void sample(const WaterView& water, std::int32_t cell, float tx, float ty, float* out) {
  const Four d;
  const float* f = water.packed + 4 * static_cast<std::ptrdiff_t>(cell);
  const auto a = hn::LoadU(d, f), b = hn::LoadU(d, f + 4);
  const auto c = hn::LoadU(d, f + 4 * water.cells), e = hn::LoadU(d, f + 4 * water.cells + 4);
  const auto x = hn::Set(d, tx), y = hn::Set(d, ty);
  const auto low = hn::Add(a, hn::Mul(hn::Sub(b, a), x));
  const auto high = hn::Add(c, hn::Mul(hn::Sub(e, c), x));
  hn::Store(hn::Add(low, hn::Mul(hn::Sub(high, low), y)), d, out);
}

// Eight partial sums in a fixed order, whatever the vectors' width.
HWY_INLINE float total(const Lanes& a) {
  const Four d;
  auto even = hn::Load(d, a.v), odd = hn::Load(d, a.v + 4);
  for (int i = 8; i < kDragPoints; i += 8) {
    even = hn::Add(even, hn::Load(d, a.v + i));
    odd = hn::Add(odd, hn::Load(d, a.v + i + 4));
  }
  alignas(16) float part[4];
  hn::Store(hn::Add(even, odd), d, part);
  return (part[0] + part[1]) + (part[2] + part[3]);
}

}  // namespace

void drag(const DragPoints& points, const WaterView& water, const BodyView& b, const float* open,
          const PointGusts& gusts, float out[3]) {
  const Floats d;
  const int step = static_cast<int>(hn::Lanes(d)), used = 4 * points.segments;
  Lanes rx, ry, tx, ty, fx, fy, torque;
  alignas(64) std::int32_t cell[kDragPoints];
  alignas(64) float flow[4 * kDragPoints];
  const Float c = hn::Set(d, b.c), s = hn::Set(d, b.s), K_v = hn::Set(d, water.K_v);
  const Float x = hn::Set(d, b.x), y = hn::Set(d, b.y);
  for (int i = 0; i < kDragPoints; i += step) {
    const Float px = hn::Load(d, points.px + i), py = hn::Load(d, points.py + i);
    const Float dx = hn::Sub(hn::Mul(c, px), hn::Mul(s, py));
    const Float dy = hn::Add(hn::Mul(s, px), hn::Mul(c, py));
    hn::Store(dx, d, rx.v + i), hn::Store(dy, d, ry.v + i);
    locate(water, hn::Add(x, dx), hn::Add(y, dy), cell + i, tx.v + i, ty.v + i);
  }
  for (int i = 0; i < used; ++i) sample(water, cell[i], tx.v[i], ty.v[i], flow + 4 * i);
  std::fill(flow + 4 * used, flow + 4 * kDragPoints, 0.0f);
  const Float vx = hn::Set(d, b.vx), vy = hn::Set(d, b.vy), omega = hn::Set(d, b.omega);
  for (int i = 0; i < kDragPoints; i += step) {
    Float mu_x, mu_y, sigma_x, sigma_y;
    hn::LoadInterleaved4(d, flow + 4 * i, mu_x, mu_y, sigma_x, sigma_y);
    const Float dx = hn::Load(d, rx.v + i), dy = hn::Load(d, ry.v + i);
    const Float ux = hn::Mul(K_v, hn::Add(mu_x, hn::Mul(sigma_x, hn::Load(d, gusts.x + i))));
    const Float uy = hn::Mul(K_v, hn::Add(mu_y, hn::Mul(sigma_y, hn::Load(d, gusts.y + i))));
    const Float wx = hn::Sub(ux, hn::Sub(vx, hn::Mul(omega, dy)));
    const Float wy = hn::Sub(uy, hn::Add(vy, hn::Mul(omega, dx)));
    const Float px = hn::Load(d, points.nx + i), py = hn::Load(d, points.ny + i);
    const Float nx = hn::Sub(hn::Mul(c, px), hn::Mul(s, py));
    const Float ny = hn::Add(hn::Mul(s, px), hn::Mul(c, py));
    const Float against = hn::Neg(hn::Add(hn::Mul(nx, wx), hn::Mul(ny, wy)));
    const Float met = hn::Mul(hn::Max(against, hn::Zero(d)), hn::Load(d, open + i));
    const Float force_x = hn::Mul(met, wx), force_y = hn::Mul(met, wy);
    hn::Store(force_x, d, fx.v + i), hn::Store(force_y, d, fy.v + i);
    hn::Store(hn::Sub(hn::Mul(dx, force_y), hn::Mul(dy, force_x)), d, torque.v + i);
  }
  out[0] = total(fx), out[1] = total(fy), out[2] = total(torque);
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lilytank {

HWY_EXPORT(drag);

DragPoints::DragPoints(int n, double side) : px{}, py{}, nx{}, ny{}, segments(n) {
  for (int f = 0; f < 4; ++f) {
    const Rot turn = quarter(f);
    for (int k = 0; k < n; ++k) {
      const int i = f * n + k;
      const Vec2 p = rotate(turn, Vec2(side / 2, ((k + 0.5) / n - 0.5) * side));
      px[i] = static_cast<float>(p.x()), py[i] = static_cast<float>(p.y());
      nx[i] = static_cast<float>(turn.c), ny[i] = static_cast<float>(turn.s);
    }
  }
}

Wrench face_drag_sum(const DragPoints& points, const WaterView& water, const BodyView& body,
                     unsigned covered, const PointGusts& gusts) {
  alignas(64) float open[kDragPoints];
  std::fill(open, open + kDragPoints, 1.0f);
  for (int f = 0; covered != 0 && f < 4; ++f) {
    float* first = open + f * points.segments;
    if (covered >> f & 1u) std::fill(first, first + points.segments, 0.0f);
  }
  float out[3];
  HWY_DYNAMIC_DISPATCH(drag)(points, water, body, open, gusts, out);
  return {out[0], out[1], out[2]};
}

}  // namespace lilytank
#endif
