// A face of each of one vector of modules, as the drag on it is summed: included by files that are
// compiled once for each instruction set, with the same bits from each.
#if defined(LILYTANK_FACE_FRAME_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LILYTANK_FACE_FRAME_INL
#undef LILYTANK_FACE_FRAME_INL
#else
#define LILYTANK_FACE_FRAME_INL
#endif

#include <hwy/highway.h>

#include "face_drag_kernel.hpp"
#include "flow_lookup_inl.hpp"
#include "truncated_normal_inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {

/// One vector of modules.
struct Modules {
  Float x, y, c, s, vx, vy, omega;
};

/// What the four faces of one vector of modules share.
struct Task {
  Task(const DragSettings& settings_, const Lookup& field_, const std::uint8_t* covered_,
       const float* numbers_)
      : settings(settings_),
        field(field_),
        covered(covered_),
        numbers(numbers_),
        K_v(hn::Set(Floats(), settings_.K_v)),
        half(hn::Set(Floats(), settings_.half)) {}

  const DragSettings& settings;
  const Lookup& field;
  const std::uint8_t* covered;
  const float* numbers;  ///< of these lanes, kBulkBodies apart
  Water centre;          ///< at the modules' centres, where FlowAt says so
  Float K_v, half;

  HWY_INLINE Float number(int k) const { return hn::Load(Floats(), numbers + k * kBulkBodies); }
};

/// Its normal n, its tangent t = (-n_y, n_x), and how its middle moves.
struct FaceFrame {
  Float nx, ny;
  Float vn, vt, omega;  ///< m/s along n and t; rad/s
  Float gx, gy;         ///< the middle, in cells
  Float open;           ///< 1, or 0 where a neighbour covers it

  HWY_INLINE Float along_n(Float x, Float y) const {
    return hn::Add(hn::Mul(x, nx), hn::Mul(y, ny));
  }
  HWY_INLINE Float along_t(Float x, Float y) const {
    return hn::Sub(hn::Mul(y, nx), hn::Mul(x, ny));
  }
  /// Speed of the place `at` along n.
  HWY_INLINE Float normal_speed(Float at) const { return hn::Sub(vn, hn::Mul(omega, at)); }
};

HWY_INLINE Float open_of(const std::uint8_t* covered, int face) {
  const Floats d;
  const Words w;
  const hn::Rebind<std::uint8_t, Words> bytes;
  const Word bits = hn::PromoteTo(w, hn::LoadU(bytes, covered));
  const Word bit = hn::And(bits, hn::Set(w, 1u << face));
  return hn::IfThenElse(hn::RebindMask(d, hn::Eq(bit, hn::Zero(w))), hn::Set(d, 1.0f), hn::Zero(d));
}

HWY_INLINE FaceFrame face_frame(const Task& task, const Modules& m, int face) {
  FaceFrame f;
  const Float nc = hn::Neg(m.c), ns = hn::Neg(m.s);
  f.nx = face == 0 ? m.c : face == 1 ? ns : face == 2 ? nc : m.s;
  f.ny = face == 0 ? m.s : face == 1 ? m.c : face == 2 ? ns : nc;
  f.vn = f.along_n(m.vx, m.vy);
  f.vt = hn::Add(f.along_t(m.vx, m.vy), hn::Mul(m.omega, task.half));
  f.omega = m.omega;
  f.gx = task.field.cells_of(hn::Add(m.x, hn::Mul(task.half, f.nx)));
  f.gy = task.field.cells_of(hn::Add(m.y, hn::Mul(task.half, f.ny)));
  f.open = open_of(task.covered, face);
  return f;
}

/// Force along n and t, summed over a face's segments, and the sum of place times force along n.
struct FaceSum {
  Float n, t, moment;
};

struct WrenchSum {
  Float fx, fy, torque;
};

HWY_INLINE void add_face(const FaceFrame& f, FaceSum sum, Float half, WrenchSum& out) {
  sum.n = hn::Mul(sum.n, f.open), sum.t = hn::Mul(sum.t, f.open);
  sum.moment = hn::Mul(sum.moment, f.open);
  out.fx = hn::Add(out.fx, hn::Sub(hn::Mul(sum.n, f.nx), hn::Mul(sum.t, f.ny)));
  out.fy = hn::Add(out.fy, hn::Add(hn::Mul(sum.n, f.ny), hn::Mul(sum.t, f.nx)));
  out.torque = hn::Add(out.torque, hn::Sub(hn::Mul(half, sum.t), sum.moment));
}

/// Gusts in a face's frame, before K_v: those along n are deviation z, those along t are slant z +
/// rest z', z and z' independent standard normals.
struct Gust {
  Float deviation, slant, rest, inverse;  ///< m/s; inverse = 1 / deviation, large where that is 0
};

HWY_INLINE Gust gust_of(const Water& u, const FaceFrame& f) {
  const Float p = hn::Mul(u.sigma_x, f.nx), q = hn::Mul(u.sigma_y, f.ny);
  const Float p_t = hn::Mul(u.sigma_x, f.ny), q_t = hn::Mul(u.sigma_y, f.nx);
  const Float variance = hn::Add(hn::Mul(p, p), hn::Mul(q, q));
  const Float covariance = hn::Sub(hn::Mul(q, q_t), hn::Mul(p, p_t));
  const Float inverse = inverse_root(variance);
  return {hn::Mul(variance, inverse), hn::Mul(covariance, inverse),
          hn::Mul(hn::Mul(u.sigma_x, u.sigma_y), inverse), inverse};
}

/// Leaves the field's deviation at the share that it has now.
HWY_INLINE void calm(const DragSettings& settings, int count, Water* water) {
  if (settings.gust_gain == 1) return;
  const Float gain = hn::Set(Floats(), settings.gust_gain);
  for (int k = 0; k < count; ++k) {
    water[k].sigma_x = hn::Mul(water[k].sigma_x, gain);
    water[k].sigma_y = hn::Mul(water[k].sigma_y, gain);
  }
}

/// The water at places along a face (m from its middle).
template <FlowAt kAt>
HWY_INLINE void water_along(const Task& task, const FaceFrame& f, const float* places, int count,
                            Water* out) {
  if (kAt == FlowAt::centre) {
    for (int k = 0; k < count; ++k) out[k] = task.centre;
    return;
  }
  Spots spots;
  for (int k = 0; k < count; ++k) {
    const Float way = hn::Set(Floats(), places[k] * task.field.per_metre);
    const Float gx = hn::Sub(f.gx, hn::Mul(way, f.ny)), gy = hn::Add(f.gy, hn::Mul(way, f.nx));
    locate(task.field, gx, gy, k, spots);
  }
  read(task.field, spots, count, out);
  calm(task.settings, count, out);
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
