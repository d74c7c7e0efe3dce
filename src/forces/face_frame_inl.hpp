// A face of each of one vector of modules, as the drag on it is summed: included by files that are
// compiled once for each instruction set, with the same bits from each.
#if defined(LILYTANK_FACE_FRAME_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LILYTANK_FACE_FRAME_INL
#undef LILYTANK_FACE_FRAME_INL
#else
#define LILYTANK_FACE_FRAME_INL
#endif

#include <hwy/highway.h>

#include <type_traits>

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
        gust_K_v(hn::Set(Floats(), settings_.K_v * settings_.gust_gain)),
        half(hn::Set(Floats(), settings_.half)) {}

  const DragSettings& settings;
  const Lookup& field;
  const std::uint8_t* covered;
  const float* numbers;  ///< of these lanes, kBulkBodies apart
  bool inside = false;   ///< the field surrounds all points, see Lookup
  Water centre;          ///< at the modules' centres, where FlowAt says so
  Float K_v, gust_K_v;   ///< factors on the field's mean and deviation
  Float half;
  Float gust_x, gust_y;  ///< the module's one gust, in deviations

  HWY_INLINE Float number(int k) const { return hn::Load(Floats(), numbers + k * kBulkBodies); }
};

/// Its normal n, its tangent t = (-n_y, n_x), and how its middle moves.
struct FaceFrame {
  Float nx, ny;
  Float vn, vt, omega;  ///< m/s along n and t; rad/s
  Float gx, gy;         ///< the middle, in cells
  Float open;           ///< 1, or 0 where a neighbour covers it
  Float wx, wy;         ///< K_v n
  Float xx, xy, yy;     ///< products of gust_K_v n_x and gust_K_v n_y

  HWY_INLINE Float along_n(Float x, Float y) const {
    return hn::Add(hn::Mul(x, nx), hn::Mul(y, ny));
  }
  HWY_INLINE Float along_t(Float x, Float y) const {
    return hn::Sub(hn::Mul(y, nx), hn::Mul(x, ny));
  }
  /// The mean flow along n and t, K_v included.
  HWY_INLINE Float mean_n(const Water& u) const {
    return hn::Add(hn::Mul(u.mu_x, wx), hn::Mul(u.mu_y, wy));
  }
  HWY_INLINE Float mean_t(const Water& u) const {
    return hn::Sub(hn::Mul(u.mu_y, wx), hn::Mul(u.mu_x, wy));
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
  f.wx = hn::Mul(task.K_v, f.nx), f.wy = hn::Mul(task.K_v, f.ny);
  const Float x = hn::Mul(task.gust_K_v, f.nx), y = hn::Mul(task.gust_K_v, f.ny);
  f.xx = hn::Mul(x, x), f.xy = hn::Mul(x, y), f.yy = hn::Mul(y, y);
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

/// Covariance of the gusts along n and t at a point, K_v included except in `product`: given the
/// one along n, the one along t has the mean covariance / variance times it, and the variance
/// gust_K_v^4 product / variance.
struct Gust {
  Float variance, covariance;  ///< m^2/s^2
  Float product;               ///< of the variances along x and y, m^4/s^4
};

HWY_INLINE Gust gust_of(const Water& u, const FaceFrame& f) {
  const Float x = hn::Mul(u.sigma_x, u.sigma_x), y = hn::Mul(u.sigma_y, u.sigma_y);
  return {hn::Add(hn::Mul(x, f.xx), hn::Mul(y, f.yy)), hn::Mul(f.xy, hn::Sub(y, x)), hn::Mul(x, y)};
}

/// Notes places along a face (m from its middle) as points `first` and on.
HWY_INLINE void locate_along(const Task& task, const FaceFrame& f, const float* places, int count,
                             int first, Spots& spots) {
  const auto locate_all = [&](auto inside) {
    for (int k = 0; k < count; ++k) {
      const Float way = hn::Set(Floats(), places[k] * task.field.per_metre);
      const Float gx = hn::Sub(f.gx, hn::Mul(way, f.ny)), gy = hn::Add(f.gy, hn::Mul(way, f.nx));
      locate<inside>(task.field, gx, gy, first + k, spots);
    }
  };
  if (task.inside)
    locate_all(std::true_type());
  else
    locate_all(std::false_type());
}

/// The water at places along a face.
HWY_INLINE void water_along(const Task& task, const FaceFrame& f, const float* places, int count,
                            Water* out) {
  Spots spots;
  locate_along(task, f, places, count, 0, spots);
  read(task.field, spots, count, out);
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
