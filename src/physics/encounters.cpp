#include "encounters.hpp"

// Compiled once for each instruction set, with the same bits from each: a lane is a pair.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "physics/encounters.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace encounter_lanes {
namespace {
#define LILYTANK_LANES kBlockLanes
#include "lanes_inl.hpp"
#include "shapes_inl.hpp"
#undef LILYTANK_LANES

// Fields of a pair: body a, body b, then what they have in common.
enum Field { kX, kY, kC, kS, kVx, kVy, kOmega, kBody, kArc = 2 * kBody, kH, kHalf, kRadius, kTank };

// No less than this is between two bodies on their courses, m: the gap along a fixed normal closes
// by their motion along it, and as they turn. A square at angle t to a direction is half * (|cos t|
// + |sin t|) wide, which changes by less than half the side per radian.
template <class Load>
HWY_INLINE F clearance(PairKind kind, Load&& load) {
  const auto shape = [&](int first) {
    return Outline{load(first + kX), load(first + kY), load(first + kC), load(first + kS), 0};
  };
  const F half = load(kHalf), h = load(kH), arc = load(kArc);
  const Outline b = shape(kBody);
  const F vbx = load(kBody + kVx), vby = load(kBody + kVy);
  const F turn_b = h * abs(load(kBody + kOmega));
  if (kind == PairKind::wall_square || kind == PairKind::wall_disc) {
    // Distance from the centre is greatest at an end of a straight way.
    Outline end = b;
    end.x += h * vbx, end.y += h * vby;
    const F tank = load(kTank), radius = load(kRadius);
    if (kind == PairKind::wall_disc)
      return tank - radius - root(greater(b.x * b.x + b.y * b.y, end.x * end.x + end.y * end.y));
    const F room =
        lesser(gap_of_square_and_wall(b, half, tank), gap_of_square_and_wall(end, half, tank));
    return room - (turn_b * (1.41421357f * half) + arc);
  }
  const Outline a = shape(0);
  const F turn_a = h * abs(load(kOmega));
  LaneGap gap;
  F widening = 0.0f;
  if (kind == PairKind::squares) {
    gap = gap_of_squares(a, b, half), widening = half * (turn_a + turn_b);
  } else if (kind == PairKind::square_disc) {
    gap = gap_of_square_and_disc(a, b, half, load(kRadius)), widening = half * turn_a;
  } else {
    gap = gap_of_discs(a, b, load(kRadius));
  }
  const F along = gap.nx * (vbx - load(kVx)) + gap.ny * (vby - load(kVy));
  return gap.size - greater(widening + arc - h * along, 0.0f);
}

template <PairKind kind>
void measure_kind(const RowOf<kBlockLanes>* rows, int count, float spare, std::uint8_t* close) {
  const auto lanes = static_cast<int>(hn::Lanes(FloatTag()));
  for (int k = 0; k < count; k += lanes) {
    const RowOf<kBlockLanes>* of_block = rows + k / kBlockLanes * Encounters::kFields;
    const auto load = [&](int field) -> F {
      return hn::Load(FloatTag(), of_block[field].v + k % kBlockLanes);
    };
    const Mask near = clearance(kind, load) <= F(spare);
    alignas(64) float out[kBlockLanes];
    hn::Store(keep(near, 1.0f).v, FloatTag(), out);
    for (int l = 0; l < lanes; ++l) close[k + l] = out[l] != 0;
  }
}
}  // namespace
}  // namespace encounter_lanes

void measure_pairs(PairKind kind, const RowOf<kBlockLanes>* rows, int count, float spare,
                   std::uint8_t* close) {
  using namespace encounter_lanes;
  switch (kind) {
    case PairKind::squares:
      return measure_kind<PairKind::squares>(rows, count, spare, close);
    case PairKind::square_disc:
      return measure_kind<PairKind::square_disc>(rows, count, spare, close);
    case PairKind::discs:
      return measure_kind<PairKind::discs>(rows, count, spare, close);
    case PairKind::wall_square:
      return measure_kind<PairKind::wall_square>(rows, count, spare, close);
    default:
      return measure_kind<PairKind::wall_disc>(rows, count, spare, close);
  }
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lilytank {

HWY_EXPORT(measure_pairs);

void Encounters::reserve(std::size_t pairs) {
  if (pairs <= pairs_.size()) return;
  pairs_.resize(pairs);
  rows_.resize((pairs + kBlockLanes - 1) / kBlockLanes * kFields);
  close_.resize(pairs + kBlockLanes);
}

float* Encounters::room() {
  const auto k = static_cast<std::size_t>(count_);
  if (k == pairs_.size()) reserve(2 * k + kBlockLanes);
  ++count_;
  return reinterpret_cast<float*>(rows_.data()) + k / kBlockLanes * kFields * kBlockLanes +
         k % kBlockLanes;
}

void Encounters::add(const Bodies& b, const Surroundings& around, Pair pair) {
  float* p = room();
  pairs_[static_cast<std::size_t>(count_ - 1)] = pair;
  const auto put = [&](float v) { *p = v, p += kBlockLanes; };
  const auto body = [&](int i) {
    put(b.x[i]), put(b.y[i]), put(b.c[i]), put(b.s[i]), put(b.vx[i]), put(b.vy[i]), put(b.omega[i]);
  };
  const int first = pair.j < 0 ? pair.i : pair.i, second = pair.j < 0 ? pair.i : pair.j;
  body(first), body(second);
  put(pair.j < 0 ? b.arc[first] : b.arc[first] + b.arc[second]);
  put(around.h), put(around.half), put(around.radius), put(around.tank);
}

void Encounters::add_ends(const Bodies& b, const Surroundings& around, Pair pair) {
  float* p = room();
  pairs_[static_cast<std::size_t>(count_ - 1)] = pair;
  const auto put = [&](float v) { *p = v, p += kBlockLanes; };
  const auto body = [&](int i) {
    put(b.to_x[i]), put(b.to_y[i]), put(b.to_c[i]), put(b.to_s[i]), put(0), put(0), put(0);
  };
  body(pair.i), body(pair.j < 0 ? pair.i : pair.j);
  put(0), put(0), put(around.half), put(around.radius), put(around.tank);
}

void Encounters::measure(PairKind kind, float spare) {
  if (count_ > 0)
    HWY_DYNAMIC_DISPATCH(measure_pairs)(kind, rows_.data(), count_, spare, close_.data());
}

}  // namespace lilytank
#endif
