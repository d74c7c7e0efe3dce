#include "face_drag_kernel.hpp"

#include <algorithm>
#include <cmath>

#include "forces/kept_gusts.hpp"

// Compiled once for each instruction set, as bulk_normals.cpp is, with the same bits from each. A
// lane is a module, so nothing is ever summed across lanes.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "forces/face_drag_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "face_frame_inl.hpp"
#include "face_moments_inl.hpp"
#include "flow_lookup_inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {
namespace {

// The water at a place with the module's one gust: its speed along n, and along t relative to the
// face.
struct Drift {
  Float un, wt;
};

HWY_INLINE Drift drift_of(const Task& task, const FaceFrame& f, Water u) {
  u.mu_x = hn::Add(u.mu_x, hn::Mul(u.sigma_x, task.gust_x));
  u.mu_y = hn::Add(u.mu_y, hn::Mul(u.sigma_y, task.gust_y));
  return {f.mean_n(u), hn::Sub(f.mean_t(u), f.vt)};
}

HWY_INLINE void add_segment(const FaceFrame& f, const Drift& drift, Float at, FaceSum& sum) {
  const Float a = hn::Max(hn::Sub(f.normal_speed(at), drift.un), hn::Zero(Floats()));
  const Float square = hn::Mul(a, a);
  sum.n = hn::Sub(sum.n, square);
  sum.moment = hn::Sub(sum.moment, hn::Mul(at, square));
  sum.t = hn::Add(sum.t, hn::Mul(a, drift.wt));
}

// Gusts per drag point. In stages over the points: each is a short chain, of which the processor
// overlaps many.
template <FlowAt kAt>
HWY_INLINE FaceSum point_face(const Task& task, const FaceFrame& f, int face) {
  constexpr bool kOne = kAt == FlowAt::centre;  // the same water at all points
  const Floats d;
  const int segments = task.settings.segments, waters = kOne ? 1 : segments;
  Water water[kMostSegments];
  if (kOne)
    water[0] = task.centre;
  else
    water_along(task, f, task.settings.places, segments, water);
  Gust gust[kMostSegments];
  Float inverse[kMostSegments];
  for (int k = 0; k < waters; ++k) {
    gust[k] = gust_of(water[k], f);
    inverse[k] = inverse_root(gust[k].variance);
  }
  FaceSum sum{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  Float spread = hn::Zero(d);
  for (int k = 0; k < segments; ++k) {
    const int i = kOne ? 0 : k;
    const Float z = hn::Mul(task.number(face * segments + k), inverse[i]);
    const Float at = hn::Set(d, task.settings.places[k]);
    const Float un = hn::Add(f.mean_n(water[i]), hn::Mul(gust[i].variance, z));
    const Float ut = hn::Add(f.mean_t(water[i]), hn::Mul(gust[i].covariance, z));
    const Float a = hn::Max(hn::Sub(f.normal_speed(at), un), hn::Zero(d));
    const Float square = hn::Mul(a, a);
    const Float rest = hn::Mul(hn::Mul(gust[i].product, inverse[i]), inverse[i]);
    sum.n = hn::Sub(sum.n, square);
    sum.moment = hn::Sub(sum.moment, hn::Mul(at, square));
    sum.t = hn::Add(sum.t, hn::Mul(a, hn::Sub(ut, f.vt)));
    spread = hn::Add(spread, hn::Mul(rest, square));
  }
  const Float deviation = hn::Mul(spread, inverse_root(spread));
  const Float gain = hn::Mul(task.gust_K_v, task.gust_K_v);
  const Float z = task.number(4 * segments + face);
  sum.t = hn::Add(sum.t, hn::Mul(hn::Mul(gain, deviation), z));
  return sum;
}

// One gust for the whole module, or none; water read at each segment.
HWY_INLINE FaceSum module_face(const Task& task, const FaceFrame& f) {
  const Floats d;
  FaceSum sum{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  Water water[kMostSegments];
  water_along(task, f, task.settings.places, task.settings.segments, water);
  for (int k = 0; k < task.settings.segments; ++k) {
    const Drift drift = drift_of(task, f, water[k]);
    add_segment(f, drift, hn::Set(d, task.settings.places[k]), sum);
  }
  return sum;
}

// The same with the water of the module's centre, where -n.w = a - omega s along a face. Where that
// has one sign, the sums over the segments are closed: N a^2 + omega^2 sum s^2 and so on. Few faces
// meet the flow on one side only; a lane's bits must not depend on its neighbours', so each lane
// takes the way that is its own.
HWY_INLINE FaceSum uniform_face(const Task& task, const FaceFrame& f) {
  const Floats d;
  const Drift drift = drift_of(task, f, task.centre);
  const Float a = hn::Sub(f.vn, drift.un), zero = hn::Zero(d);
  const Float turning = hn::Mul(hn::Abs(f.omega), hn::Set(d, -task.settings.places[0]));
  const Float count = hn::Set(d, static_cast<float>(task.settings.segments));
  const Float spin = hn::Mul(f.omega, hn::Set(d, task.settings.squares));
  const auto met = hn::Gt(a, zero);
  FaceSum sum;
  sum.n = hn::Neg(
      hn::IfThenElseZero(met, hn::Add(hn::Mul(hn::Mul(a, a), count), hn::Mul(f.omega, spin))));
  sum.moment = hn::IfThenElseZero(met, hn::Mul(hn::Add(a, a), spin));
  sum.t = hn::IfThenElseZero(met, hn::Mul(hn::Mul(a, count), drift.wt));
  const auto mixed = hn::Lt(hn::Abs(a), turning);
  if (hn::AllFalse(d, mixed)) return sum;
  FaceSum each{zero, zero, zero};
  for (int k = 0; k < task.settings.segments; ++k)
    add_segment(f, drift, hn::Set(d, task.settings.places[k]), each);
  return {hn::IfThenElse(mixed, each.n, sum.n), hn::IfThenElse(mixed, each.t, sum.t),
          hn::IfThenElse(mixed, each.moment, sum.moment)};
}

template <Gusts kGusts, FlowAt kAt>
HWY_INLINE void sum_faces(Task& task, const Modules& m, WrenchSum& out) {
  if (kGusts == Gusts::per_module) {
    const Float gain = hn::Set(Floats(), task.settings.gust_gain);
    task.gust_x = hn::Mul(gain, task.number(0)), task.gust_y = hn::Mul(gain, task.number(1));
  }
  for (int face = 0; face < 4; ++face) {
    const FaceFrame f = face_frame(task, m, face);
    FaceSum sum;
    if (kGusts == Gusts::per_point)
      sum = point_face<kAt>(task, f, face);
    else
      sum = kAt == FlowAt::centre ? uniform_face(task, f) : module_face(task, f);
    add_face(f, sum, task.half, out);
  }
}

template <FlowAt kAt>
void sum_modules(Task& task, const Modules& m, WrenchSum& out) {
  if (!task.settings.gusty || task.settings.gusts == Gusts::per_module)
    sum_faces<Gusts::per_module, kAt>(task, m, out);
  else if (task.settings.gusts == Gusts::per_point)
    sum_faces<Gusts::per_point, kAt>(task, m, out);
  else if (task.settings.expected)
    matched_faces<kAt, false>(task, m, out);
  else
    matched_faces<kAt, true>(task, m, out);
}

}  // namespace

// `z`: the modules' normal numbers.
void drag(const DragSettings& settings, const DragBlock& block, const float* z, DragSums& out) {
  const Floats d;
  const Lookup field(*settings.field);
  for (int i = 0; i < kBulkBodies; i += static_cast<int>(hn::Lanes(d))) {
    const Modules m{hn::Load(d, block.x + i),    hn::Load(d, block.y + i),
                    hn::Load(d, block.c + i),    hn::Load(d, block.s + i),
                    hn::Load(d, block.vx + i),   hn::Load(d, block.vy + i),
                    hn::Load(d, block.omega + i)};
    Task task(settings, field, block.covered + i, z + i);
    WrenchSum sum{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    const Float gx = field.cells_of(m.x), gy = field.cells_of(m.y);
    if (settings.at == FlowAt::centre) {
      Spots spots;
      locate(field, gx, gy, 0, spots);
      read(field, spots, 1, &task.centre);
      sum_modules<FlowAt::centre>(task, m, sum);
    } else {
      // Nearly always. 1.5: more than the way to a corner, with room for rounding.
      task.inside = field.surrounds(gx, gy, 1.5f * settings.half * field.per_metre);
      sum_modules<FlowAt::points>(task, m, sum);
    }
    hn::Store(sum.fx, d, out.fx + i), hn::Store(sum.fy, d, out.fy + i);
    hn::Store(sum.torque, d, out.torque + i);
  }
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lilytank {

HWY_EXPORT(drag);

int gust_numbers(Gusts gusts, int segments) {
  switch (gusts) {
    case Gusts::per_point:
      return 4 * segments + 4;
    case Gusts::per_module:
      return 2;
    default:
      return 4;
  }
}

DragSettings::DragSettings(const Model& model, int segments_, const StepContext& now)
    : field(&field_now(model, now)),
      gusts(now.expected ? Gusts::moment_matched : model.flow.gusts),
      gusty(now.gusts || now.expected),
      expected(now.expected),
      at(model.flow.at),
      segments(segments_),
      half(static_cast<float>(0.5 * model.module.side)),
      K_v(static_cast<float>(model.flow.K_v * now.gain)),
      gust_gain(static_cast<float>(now.gust_gain)),
      draw{now.seed, Stream::gust, now.gust, 0, 0} {
  const double side = model.module.side, pitch = side / segments;
  double second = 0, fourth = 0;
  for (int k = 0; k < segments; ++k) {
    const double place = (k + 0.5) * pitch - 0.5 * side, square = place * place;
    places[k] = static_cast<float>(place);
    second += square, fourth += square * square;
  }
  squares = static_cast<float>(second);
  if (gusts == Gusts::moment_matched) set_nodes(second, fourth);
}

void DragSettings::set_moment(const Model& model, const StepContext& now) {
  field = &field_now(model, now);
  K_v = static_cast<float>(model.flow.K_v * now.gain),
  gust_gain = static_cast<float>(now.gust_gain);
  draw = {now.seed, Stream::gust, now.gust, 0, 0};
}

void DragSettings::set_nodes(double second, double fourth) {
  const double square = second > 0 ? fourth / second : 0;
  const double beside = square > 0 ? 0.5 * second / square : 0, way = std::sqrt(square);
  nodes[0] = static_cast<float>(-way), nodes[1] = 0, nodes[2] = static_cast<float>(way);
  weights[0] = weights[2] = static_cast<float>(beside);
  weights[1] = static_cast<float>(segments - 2 * beside);
}

void face_drag_sums(const DragSettings& settings, const DragBlock& block, KeptGusts* kept,
                    DragSums& out) {
  alignas(64) float buffer[(4 * kMostSegments + 4) * kBulkBodies];
  const float* z = buffer;
  if (settings.gusty && !settings.expected) {
    const int count = gust_numbers(settings.gusts, settings.segments);
    if (kept != nullptr)
      z = kept->normals(settings.draw, count, buffer);
    else
      bulk_normals(settings.draw, count, buffer);
  } else {
    std::fill(buffer, buffer + 4 * kBulkBodies, 0.0f);
  }
  HWY_DYNAMIC_DISPATCH(drag)(settings, block, z, out);
}

}  // namespace lilytank
#endif
