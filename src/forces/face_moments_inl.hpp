// Mean and covariance of the drag on a face under gusts that are independent from segment to
// segment, and a module's wrench drawn from them: included by files that are compiled once for each
// instruction set, with the same bits from each.
#if defined(LILYTANK_FACE_MOMENTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LILYTANK_FACE_MOMENTS_INL
#undef LILYTANK_FACE_MOMENTS_INL
#else
#define LILYTANK_FACE_MOMENTS_INL
#endif

#include <hwy/highway.h>

#include "face_frame_inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {

HWY_INLINE Float at_least_zero(Float v) {
  return hn::Max(v, hn::Zero(Floats()));
}

/// Sums over a face of the covariances of one segment's forces f_n and f_t with weights 1, s, s^2.
struct FaceCovariance {
  Float nn, nn_s, nn_ss, nt, nt_s, tt;
};

/// Covariance of a module's wrench in its own frame.
struct Spread {
  Float xx, xy, yy, xq, yq, qq;  ///< q: torque

  HWY_INLINE void clear() { xx = xy = yy = xq = yq = qq = hn::Zero(Floats()); }

  // Force along n, t of face 0..3 is that along x, y turned by as many quarters.
  HWY_INLINE void add(int face, const FaceCovariance& c, Float half) {
    const Float nq = hn::Sub(hn::Mul(half, c.nt), c.nn_s);
    const Float tq = hn::Sub(hn::Mul(half, c.tt), c.nt_s);
    const Float twice = hn::Add(c.nt_s, c.nt_s);
    qq = hn::Add(qq, hn::Add(hn::Mul(half, hn::Sub(hn::Mul(half, c.tt), twice)), c.nn_ss));
    if (face % 2 == 0) {
      xx = hn::Add(xx, c.nn), yy = hn::Add(yy, c.tt), xy = hn::Add(xy, c.nt);
      xq = face == 0 ? hn::Add(xq, nq) : hn::Sub(xq, nq);
      yq = face == 0 ? hn::Add(yq, tq) : hn::Sub(yq, tq);
    } else {
      xx = hn::Add(xx, c.tt), yy = hn::Add(yy, c.nn), xy = hn::Sub(xy, c.nt);
      xq = face == 1 ? hn::Sub(xq, tq) : hn::Add(xq, tq);
      yq = face == 1 ? hn::Add(yq, nq) : hn::Sub(yq, nq);
    }
  }

  // Cholesky's factors, row by row, times three numbers.
  HWY_INLINE void draw(const Task& task, const Modules& m, WrenchSum& out) const {
    const Float z0 = task.number(0), z1 = task.number(1), z2 = task.number(2);
    const Float i0 = inverse_root(xx);
    const Float x0 = hn::Mul(xx, i0), y0 = hn::Mul(xy, i0), q0 = hn::Mul(xq, i0);
    const Float left_y = at_least_zero(hn::Sub(yy, hn::Mul(y0, y0)));
    const Float i1 = inverse_root(left_y);
    const Float y1 = hn::Mul(left_y, i1);
    const Float q1 = hn::Mul(hn::Sub(yq, hn::Mul(q0, y0)), i1);
    const Float left_q = at_least_zero(hn::Sub(hn::Sub(qq, hn::Mul(q0, q0)), hn::Mul(q1, q1)));
    const Float q2 = hn::Mul(left_q, inverse_root(left_q));
    const Float fx = hn::Mul(x0, z0), fy = hn::Add(hn::Mul(y0, z0), hn::Mul(y1, z1));
    out.fx = hn::Add(out.fx, hn::Sub(hn::Mul(m.c, fx), hn::Mul(m.s, fy)));
    out.fy = hn::Add(out.fy, hn::Add(hn::Mul(m.s, fx), hn::Mul(m.c, fy)));
    const Float q = hn::Add(hn::Add(hn::Mul(q0, z0), hn::Mul(q1, z1)), hn::Mul(q2, z2));
    out.torque = hn::Add(out.torque, q);
  }
};

/// Of f_t = a (A - b a + rho z) at a node.
struct Tangential {
  Float A, b, rho_2;
};

HWY_INLINE Tangential tangential_of(const Task& task, const FaceFrame& f, const Water& u,
                                    const Gust& gust, const Normal& a) {
  Tangential t;
  t.b = hn::Mul(hn::Mul(gust.covariance, a.inverse), a.inverse);
  t.A = hn::Add(hn::Sub(f.mean_t(u), f.vt), hn::Mul(t.b, a.mean));
  const Float scaled = hn::Mul(hn::Mul(task.gust_K_v, task.gust_K_v), a.inverse);
  t.rho_2 = hn::Mul(hn::Mul(gust.product, scaled), scaled);
  return t;
}

/// Means of f_n = -a^2 and f_t = a (A - b a + rho z), a = max(0, -n.w), and their covariances.
struct SegmentMoments {
  Float square;  ///< E[a^2]
  Float t, nn, nt, tt;
};

HWY_INLINE SegmentMoments segment_moments(const Moments& m, const Tangential& f) {
  const Float A = f.A, b = f.b;
  SegmentMoments s;
  s.square = m.m2;
  s.t = hn::Sub(hn::Mul(A, m.m1), hn::Mul(b, m.m2));
  s.nn = at_least_zero(hn::Sub(m.m4, hn::Mul(m.m2, m.m2)));
  const Float third = hn::Sub(hn::Mul(A, m.m3), hn::Mul(b, m.m4));  // E[a^2 f_t]
  s.nt = hn::Sub(hn::Mul(m.m2, s.t), third);
  const Float second = hn::Sub(hn::Mul(A, m.m2), hn::Mul(b, m.m3));
  const Float all = hn::Sub(hn::Mul(A, second), hn::Mul(b, third));  // E[f_t^2] without z
  const Float own = hn::Mul(f.rho_2, m.m2);
  s.tt = at_least_zero(hn::Add(hn::Sub(all, hn::Mul(s.t, s.t)), own));
  return s;
}

/// Sums over a face's nodes: the outer two have one weight and lie as far on either side of the
/// middle.
struct NodeSums {
  NodeSums(const DragSettings& settings, Float open)
      : outer(hn::Mul(hn::Set(Floats(), settings.weights[2]), open)),
        middle(hn::Mul(hn::Set(Floats(), settings.weights[1]), open)),
        way(hn::Set(Floats(), settings.nodes[2])) {}

  Float outer, middle, way;

  HWY_INLINE Float outside(Float a, Float c) const { return hn::Mul(outer, hn::Add(a, c)); }
  /// Weighted by place.
  HWY_INLINE Float by_place(Float a, Float c) const {
    return hn::Mul(hn::Mul(outer, way), hn::Sub(c, a));
  }
  HWY_INLINE Float all(Float a, Float b, Float c) const {
    return hn::Add(outside(a, c), hn::Mul(middle, b));
  }
};

HWY_INLINE FaceSum mean_of(const NodeSums& w, const SegmentMoments (&s)[3]) {
  return {hn::Neg(w.all(s[0].square, s[1].square, s[2].square)), w.all(s[0].t, s[1].t, s[2].t),
          hn::Neg(w.by_place(s[0].square, s[2].square))};
}

HWY_INLINE FaceCovariance covariance_of(const NodeSums& w, const SegmentMoments (&s)[3]) {
  const Float nn = w.outside(s[0].nn, s[2].nn);
  return {hn::Add(nn, hn::Mul(w.middle, s[1].nn)),
          w.by_place(s[0].nn, s[2].nn),
          hn::Mul(nn, hn::Mul(w.way, w.way)),
          w.all(s[0].nt, s[1].nt, s[2].nt),
          w.by_place(s[0].nt, s[2].nt),
          w.all(s[0].tt, s[1].tt, s[2].tt)};
}

// In stages over the three nodes of all faces: the processor can then overlap their chains. Of an
// expected drag nothing is drawn, so its covariance is not computed.
template <FlowAt kAt, bool kDrawn>
HWY_INLINE void matched_faces(const Task& task, const Modules& m, WrenchSum& out) {
  const Floats d;
  const float* places = task.settings.nodes;
  const FaceFrame frames[4] = {face_frame(task, m, 0), face_frame(task, m, 1),
                               face_frame(task, m, 2), face_frame(task, m, 3)};
  Water water[12];
  if (kAt == FlowAt::points) {
    Spots spots;
    for (int face = 0; face < 4; ++face)
      locate_along(task, frames[face], places, 3, 3 * face, spots);
    read(task.field, spots, 12, water);
  }
  Normal against[12];  // -n.w
  Tangential along[12];
  for (int i = 0; i < 12; ++i) {
    const FaceFrame& f = frames[i / 3];
    const Water& u = kAt == FlowAt::points ? water[i] : task.centre;
    const Gust gust = gust_of(u, f);
    const Float speed = f.normal_speed(hn::Set(d, places[i % 3]));
    against[i] = {hn::Sub(speed, f.mean_n(u)), gust.variance, inverse_root(gust.variance)};
    along[i] = tangential_of(task, f, u, gust, against[i]);
  }
  Moments moments[12];
  positive_moments(against, moments);
  Spread spread;
  spread.clear();
  for (int face = 0; face < 4; ++face) {
    const int i = 3 * face;
    const SegmentMoments s[3] = {segment_moments(moments[i], along[i]),
                                 segment_moments(moments[i + 1], along[i + 1]),
                                 segment_moments(moments[i + 2], along[i + 2])};
    const NodeSums sums(task.settings, frames[face].open);
    add_face(frames[face], mean_of(sums, s), task.half, out);
    if (kDrawn) spread.add(face, covariance_of(sums, s), task.half);
  }
  if (kDrawn) spread.draw(task, m, out);
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
