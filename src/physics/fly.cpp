#include "fly.hpp"

#include "small_turn.hpp"

// Compiled once for each instruction set, with the same bits from each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "physics/fly.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::CappedTag<double, 8>;
using Double = hn::Vec<Doubles>;

// 1 - q a (1 - q b (...)), as in small_turn().
template <int kTerms>
HWY_INLINE Double series(Double q, const double (&coefficients)[kTerms]) {
  const Doubles d;
  const Double one = hn::Set(d, 1.0);
  Double sum = one;
  for (int k = kTerms - 1; k >= 0; --k)
    sum = hn::Sub(one, hn::Mul(hn::Mul(q, hn::Set(d, coefficients[k])), sum));
  return sum;
}

// One vector of slots from i on; false if one turns too far for the series.
HWY_INLINE bool fly_some(const Flight& f, double h, int i) {
  static constexpr double kSine[] = {1.0 / 6, 1.0 / 20, 1.0 / 42, 1.0 / 72, 1.0 / 110};
  static constexpr double kCosine[] = {0.5, 1.0 / 12, 1.0 / 30, 1.0 / 56, 1.0 / 90};
  const Doubles d;
  const Double time = hn::Set(d, h);
  const auto load = [&](const double* p) { return hn::LoadU(d, p + i); };
  hn::StoreU(hn::Add(load(f.x), hn::Mul(time, load(f.vx))), d, f.to_x + i);
  hn::StoreU(hn::Add(load(f.y), hn::Mul(time, load(f.vy))), d, f.to_y + i);
  const Double angle = hn::Mul(time, load(f.omega)), q = hn::Mul(angle, angle);
  const auto small = hn::Le(q, hn::Set(d, 0.0625));
  const Double tc = series(q, kCosine), ts = hn::Mul(angle, series(q, kSine));
  const Double c = load(f.c), s = load(f.s);
  const Double nc = hn::Sub(hn::Mul(c, tc), hn::Mul(s, ts));
  const Double ns = hn::Add(hn::Mul(c, ts), hn::Mul(s, tc));
  const Double square = hn::Add(hn::Mul(nc, nc), hn::Mul(ns, ns));
  const Double k = hn::Sub(hn::Set(d, 1.5), hn::Mul(hn::Set(d, 0.5), square));
  hn::StoreU(hn::Mul(nc, k), d, f.to_c + i);
  hn::StoreU(hn::Mul(ns, k), d, f.to_s + i);
  return hn::AllTrue(d, small);
}

// The last vector ends with the last slot, over some that were done before.
bool fly_all(const Flight& f, double h) {
  const int lanes = static_cast<int>(hn::Lanes(Doubles()));
  if (f.count < lanes) return false;
  bool small = true;
  for (int i = 0; i + lanes < f.count; i += lanes) small = fly_some(f, h, i) && small;
  return fly_some(f, h, f.count - lanes) && small;
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lilytank {

HWY_EXPORT(fly_all);

void fly(const Flight& f, double h) {
  if (HWY_DYNAMIC_DISPATCH(fly_all)(f, h)) return;
  for (int i = 0; i < f.count; ++i) {
    const Rot r = turned_by({f.c[i], f.s[i]}, h * f.omega[i]);
    f.to_x[i] = f.x[i] + h * f.vx[i], f.to_y[i] = f.y[i] + h * f.vy[i];
    f.to_c[i] = r.c, f.to_s[i] = r.s;
  }
}

}  // namespace lilytank
#endif
