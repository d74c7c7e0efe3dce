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

/// 1 / sqrt(v), relative error under 1e-6; a large finite number at 0. Square root and division of
/// the processor cost more than a guess [Lomont 2003] and the minimax polynomial of what is left.
HWY_INLINE Float inverse_root(Float v) {
  static constexpr float kRoot[4] = {2.18936053f, -2.19180427f, 1.31552507f, -0.313082074f};
  const Floats d;
  const Words w;
  const Word guess = hn::Sub(hn::Set(w, 0x5f3759dfu), hn::ShiftRight<1>(hn::BitCast(w, v)));
  const Float y = hn::BitCast(d, guess);
  return hn::Mul(y, poly<3>(hn::Mul(hn::Mul(v, y), y), kRoot));
}

/// Standard normal density at x, absolute error under 1e-7: 2 to the power of -x^2 / (2 ln 2).
HWY_INLINE Float normal_density(Float x) {
  // Minimax for 2^-f / sqrt(2 pi), |f| <= 1/2.
  static constexpr float kPower[6] = {0.39894231f,    -0.276525632f,  0.0958343922f,
                                      -0.0221441421f, 0.00385998252f, -0.000529654608f};
  const Floats d;
  const Words w;
  const Float far = hn::Set(d, 120.0f);
  const Float y = hn::Min(hn::Mul(hn::Mul(x, x), hn::Set(d, 0.72134752f)), far);
  const Float whole = hn::Round(y);
  const Word halvings = hn::BitCast(w, hn::ShiftLeft<23>(hn::ConvertTo(Whole(), whole)));
  const Float power = short_poly(hn::Sub(y, whole), kPower);
  return hn::BitCast(d, hn::Sub(hn::BitCast(w, power), halvings));
}

/// Standard normal distribution function at x with its density there; absolute error under 2e-7
/// [Abramowitz and Stegun, 26.2.17].
HWY_INLINE Float normal_below(Float x, Float density) {
  static constexpr float kTail[6] = {0.0f,         0.31938153f,   -0.356563782f,
                                     1.781477937f, -1.821255978f, 1.330274429f};
  const Floats d;
  const Float one = hn::Set(d, 1.0f);
  const Float t = hn::Div(one, hn::Add(one, hn::Mul(hn::Abs(x), hn::Set(d, 0.2316419f))));
  const Float tail = hn::Mul(density, short_poly(t, kTail));
  return where_signed(x, tail, hn::Sub(one, tail));
}

/// E[max(0, a)^k] for k = 1 .. 4, a normal.
struct Moments {
  Float m1, m2, m3, m4;
};

/// Mean and variance of a normal; `inverse` is 1 / its deviation (any large number where that is
/// 0).
struct Normal {
  Float mean, variance, inverse;
};

/// In stages over all of them: the processor overlaps many short chains better than few long ones.
template <int kCount>
HWY_INLINE void positive_moments(const Normal (&a)[kCount], Moments (&out)[kCount]) {
  const Floats d;
  Float density[kCount], below[kCount];
  for (int k = 0; k < kCount; ++k) density[k] = normal_density(hn::Mul(a[k].mean, a[k].inverse));
  for (int k = 0; k < kCount; ++k)
    below[k] = normal_below(hn::Mul(a[k].mean, a[k].inverse), density[k]);
  for (int k = 0; k < kCount; ++k) {
    const Float mean = a[k].mean, variance = a[k].variance;
    const Float deviation = hn::Mul(variance, a[k].inverse);
    Moments& m = out[k];
    m.m1 = hn::Add(hn::Mul(mean, below[k]), hn::Mul(deviation, density[k]));
    m.m2 = hn::Add(hn::Mul(mean, m.m1), hn::Mul(variance, below[k]));
    m.m3 = hn::Add(hn::Mul(mean, m.m2), hn::Mul(hn::Add(variance, variance), m.m1));
    m.m4 = hn::Add(hn::Mul(mean, m.m3), hn::Mul(hn::Mul(variance, hn::Set(d, 3.0f)), m.m2));
  }
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
