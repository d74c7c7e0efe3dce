// Moments of max(0, a) for normal a, and the functions that they need: included by files that are
// compiled once for each instruction set, with the same bits from each.
#if defined(LILYTANK_TRUNCATED_NORMAL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LILYTANK_TRUNCATED_NORMAL_INL
#undef LILYTANK_TRUNCATED_NORMAL_INL
#else
#define LILYTANK_TRUNCATED_NORMAL_INL
#endif

#include <hwy/highway.h>

#include "math/bulk_random_inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {

/// 1 / sqrt(v), relative error under 5e-6; a large finite number at 0. Square root and division of
/// the processor cost more than two of Newton's steps.
HWY_INLINE Float inverse_root(Float v) {
  const Floats d;
  const Words w;
  const Word guess = hn::Sub(hn::Set(w, 0x5f3759dfu), hn::ShiftRight<1>(hn::BitCast(w, v)));
  const Float half = hn::Mul(v, hn::Set(d, 0.5f)), most = hn::Set(d, 1.5f);
  Float y = hn::BitCast(d, guess);
  y = hn::Mul(y, hn::Sub(most, hn::Mul(hn::Mul(half, y), y)));
  y = hn::Mul(y, hn::Sub(most, hn::Mul(hn::Mul(half, y), y)));
  return y;
}

/// e^-x for 0 <= x <= 80, relative error under 2e-7.
HWY_INLINE Float exp_minus(Float x) {
  static constexpr float kExp[7] = {1.0f,         1.0f,          0.5f,         0.16666667f,
                                    0.041666668f, 0.0083333338f, 0.0013888889f};
  const Floats d;
  const Words w;
  const Whole s;
  const auto n = hn::NearestInt(hn::Mul(x, hn::Set(d, -1.44269504f)));
  const Float whole = hn::ConvertTo(d, n);
  Float r = hn::Sub(hn::Neg(x), hn::Mul(whole, hn::Set(d, 0.693359375f)));
  r = hn::Sub(r, hn::Mul(whole, hn::Set(d, -2.12194440e-4f)));
  const auto power = hn::ShiftLeft<23>(hn::Add(n, hn::Set(s, 127)));
  return hn::Mul(poly<6>(r, kExp), hn::BitCast(d, hn::BitCast(w, power)));
}

/// Standard normal density and distribution function at x; absolute errors under 2e-7 [Abramowitz
/// and Stegun, 26.2.17].
HWY_INLINE void normal_at(Float x, Float& density, Float& below) {
  static constexpr float kTail[6] = {0.0f,         0.31938153f,   -0.356563782f,
                                     1.781477937f, -1.821255978f, 1.330274429f};
  const Floats d;
  const Float one = hn::Set(d, 1.0f), size = hn::Abs(x);
  const Float half = hn::Min(hn::Mul(hn::Mul(x, x), hn::Set(d, 0.5f)), hn::Set(d, 80.0f));
  density = hn::Mul(exp_minus(half), hn::Set(d, 0.398942280f));
  const Float t = hn::Div(one, hn::Add(one, hn::Mul(size, hn::Set(d, 0.2316419f))));
  const Float tail = hn::Mul(density, poly<5>(t, kTail));
  below = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), tail, hn::Sub(one, tail));
}

/// E[max(0, a)^k] for k = 1 .. 4, a normal with this mean and deviation; `inverse` is 1 / deviation
/// (any large number where that is 0).
struct Moments {
  Float m1, m2, m3, m4;
};

HWY_INLINE Moments positive_moments(Float mean, Float deviation, Float inverse) {
  const Floats d;
  Float density, below;
  const Float far = hn::Set(d, 1e4f);
  normal_at(hn::Max(hn::Min(hn::Mul(mean, inverse), far), hn::Neg(far)), density, below);
  const Float variance = hn::Mul(deviation, deviation);
  Moments m;
  m.m1 = hn::Add(hn::Mul(mean, below), hn::Mul(deviation, density));
  m.m2 = hn::Add(hn::Mul(mean, m.m1), hn::Mul(variance, below));
  m.m3 = hn::Add(hn::Mul(mean, m.m2), hn::Mul(hn::Add(variance, variance), m.m1));
  m.m4 = hn::Add(hn::Mul(mean, m.m3), hn::Mul(hn::Mul(variance, hn::Set(d, 3.0f)), m.m2));
  return m;
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
