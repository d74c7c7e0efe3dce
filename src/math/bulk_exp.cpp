#include "bulk_exp.hpp"

#include <algorithm>
#include <limits>

#include "exp_series.hpp"

// Compiled once for each instruction set, with the same bits from each: exp_portable's operations
// in its order, a number a lane.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/bulk_exp.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::CappedTag<double, 8>;
using Double = hn::Vec<Doubles>;

// 2^e for whole e in -1022 .. 1023: the lowest bits of 2^52 + n are those of n.
HWY_INLINE Double power_of_two(Double e) {
  const Doubles d;
  const hn::RebindToUnsigned<Doubles> bits;
  const Double shifted = hn::Add(e, hn::Set(d, 0x1p52 + 1023));
  return hn::BitCast(d, hn::ShiftLeft<52>(hn::BitCast(bits, shifted)));
}

HWY_INLINE Double exp_of(Double x) {
  const Doubles d;
  const Double least = hn::Set(d, kExpLeast), most = hn::Set(d, kExpMost);
  const Double inside = hn::Min(hn::Max(x, least), most);
  const Double k =
      hn::Floor(hn::Add(hn::Div(inside, hn::Set(d, kLn2High + kLn2Low)), hn::Set(d, 0.5)));
  const Double rest =
      hn::Sub(hn::Sub(inside, hn::Mul(k, hn::Set(d, kLn2High))), hn::Mul(k, hn::Set(d, kLn2Low)));
  const Double q = hn::Mul(rest, rest);
  Double even = hn::Set(d, kInverseFactorial[14]), odd = hn::Set(d, kInverseFactorial[13]);
  for (std::size_t n = 12; n >= 2; n -= 2) {
    even = hn::Add(hn::Mul(even, q), hn::Set(d, kInverseFactorial[n]));
    odd = hn::Add(hn::Mul(odd, q), hn::Set(d, kInverseFactorial[n - 1]));
  }
  const Double sum = hn::Add(hn::Set(d, 1), hn::Add(hn::Mul(rest, odd), hn::Mul(q, even)));
  const Double half = hn::Trunc(hn::Mul(k, hn::Set(d, 0.5)));
  const Double value = hn::Mul(hn::Mul(sum, power_of_two(half)), power_of_two(hn::Sub(k, half)));
  const Double infinity = hn::Set(d, std::numeric_limits<double>::infinity());
  const Double low = hn::IfThenElse(hn::Gt(x, least), value, hn::Zero(d));
  const Double all = hn::IfThenElse(hn::Gt(x, most), infinity, low);
  return hn::IfThenElse(hn::Eq(x, x), all, x);
}

}  // namespace

void exponentials(const double* x, int count, double* out) {
  const Doubles d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  int i = 0;
  for (; i + lanes <= count; i += lanes) hn::StoreU(exp_of(hn::LoadU(d, x + i)), d, out + i);
  if (i == count) return;
  double rest[8] = {};
  std::copy(x + i, x + count, rest);
  hn::StoreU(exp_of(hn::LoadU(d, rest)), d, rest);
  std::copy(rest, rest + (count - i), out + i);
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lilytank {

HWY_EXPORT(exponentials);

void bulk_exp(const double* x, int count, double* out) {
  HWY_DYNAMIC_DISPATCH(exponentials)(x, count, out);
}

}  // namespace lilytank
#endif
