#include "bulk_normals.hpp"

// Compiled once for each instruction set; the best that the machine has is chosen at run time. Only
// integer arithmetic and IEEE + - * sqrt, so all give the same bits.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "forces/bulk_normals.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kBulkBlocks>;
using Words = hn::RebindToUnsigned<Floats>;
using Whole = hn::RebindToSigned<Floats>;
using Word = hn::Vec<Words>;
using Float = hn::Vec<Floats>;

// The high and low halves of 32 x 32 bit products.
HWY_INLINE void multiply(Word a, std::uint32_t factor, Word& high, Word& low) {
  const Words d;
  const hn::RepartitionToWide<Words> wide;
  const auto k = hn::Set(d, factor);
  const auto even = hn::MulEven(a, k);
  const auto odd = hn::MulEven(hn::BitCast(d, hn::ShiftRight<32>(hn::BitCast(wide, a))), k);
  low = hn::OddEven(hn::BitCast(d, hn::ShiftLeft<32>(odd)), hn::BitCast(d, even));
  high = hn::OddEven(hn::BitCast(d, odd), hn::BitCast(d, hn::ShiftRight<32>(even)));
}

// Philox4x32-10.
HWY_INLINE void philox(Word c[4], std::uint32_t k0, std::uint32_t k1) {
  const Words d;
  for (int round = 0; round < 10; ++round) {
    Word h0, l0, h1, l1;
    multiply(c[0], 0xD2511F53u, h0, l0);
    multiply(c[2], 0xCD9E8D57u, h1, l1);
    c[0] = hn::Xor(hn::Xor(h1, c[1]), hn::Set(d, k0));
    c[1] = l1;
    c[2] = hn::Xor(hn::Xor(h0, c[3]), hn::Set(d, k1));
    c[3] = l0;
    k0 += 0x9E3779B9u;
    k1 += 0xBB67AE85u;
  }
}

HWY_INLINE Float poly(Float x, const float* coefficients, int degree) {
  const Floats d;
  Float sum = hn::Set(d, coefficients[degree]);
  for (int k = degree - 1; k >= 0; --k) sum = hn::Add(hn::Mul(sum, x), hn::Set(d, coefficients[k]));
  return sum;
}

// ln u for u in (0, 1). ln(1 + f) / f is a minimax polynomial on [sqrt(1/2) - 1, sqrt(2) - 1] of
// relative error 3e-8.
HWY_INLINE Float log_of(Float u) {
  static constexpr float kLog[] = {0.999999975f,  -0.499999777f, 0.333341605f,
                                   -0.250029461f, 0.199584171f,  -0.165437379f,
                                   0.149173777f,  -0.144821859f, 0.089599121f};
  const Floats d;
  const Words w;
  const Whole s;
  const Word bits = hn::Sub(hn::BitCast(w, u), hn::Set(w, 0x3f3504f3u));
  const Float e = hn::ConvertTo(d, hn::ShiftRight<23>(hn::BitCast(s, bits)));
  const Word mantissa = hn::Add(hn::And(bits, hn::Set(w, 0x7fffffu)), hn::Set(w, 0x3f3504f3u));
  const Float f = hn::Sub(hn::BitCast(d, mantissa), hn::Set(d, 1.0f));
  return hn::Add(hn::Mul(e, hn::Set(d, 0.693147181f)), hn::Mul(f, poly(f, kLog, 8)));
}

// Box and Muller on one lot of bits: 24 for the length, 16 for the direction.
HWY_INLINE void box_muller(Word length_bits, Word direction_bits, Float& x, Float& y) {
  // Taylor sums, exact to float32 on an eighth of a turn either way.
  static constexpr float kSine[] = {1.0f, -1.0f / 6, 1.0f / 120, -1.0f / 5040, 1.0f / 362880};
  static constexpr float kCosine[] = {1.0f, -0.5f, 1.0f / 24, -1.0f / 720, 1.0f / 40320};
  const Floats d;
  const Words w;
  const Whole s;
  const Float u = hn::Mul(hn::Add(hn::ConvertTo(d, hn::BitCast(s, length_bits)), hn::Set(d, 0.5f)),
                          hn::Set(d, 0x1p-24f));
  const Float length = hn::Sqrt(hn::Mul(log_of(u), hn::Set(d, -2.0f)));
  // The low 14 bits are a place in a quarter turn about 0, the upper two say which quarter.
  const Word place = hn::And(direction_bits, hn::Set(w, 0x3fffu));
  const Float t = hn::Mul(hn::Sub(hn::ConvertTo(d, hn::BitCast(s, place)), hn::Set(d, 8191.5f)),
                          hn::Set(d, static_cast<float>(3.14159265358979 / 32768)));
  const Float q = hn::Mul(t, t);
  const Float sine = hn::Mul(t, poly(q, kSine, 4)), cosine = poly(q, kCosine, 4);
  const Word quarter = hn::ShiftRight<14>(direction_bits);
  const auto odd = hn::RebindMask(d, hn::Ne(hn::And(quarter, hn::Set(w, 1u)), hn::Zero(w)));
  const Word flip_x = hn::ShiftLeft<30>(hn::And(hn::Add(quarter, hn::Set(w, 1u)), hn::Set(w, 2u)));
  const Word flip_y = hn::ShiftLeft<30>(hn::And(quarter, hn::Set(w, 2u)));
  const Float a = hn::IfThenElse(odd, sine, cosine), b = hn::IfThenElse(odd, cosine, sine);
  x = hn::Mul(length, hn::BitCast(d, hn::Xor(hn::BitCast(w, a), flip_x)));
  y = hn::Mul(length, hn::BitCast(d, hn::Xor(hn::BitCast(w, b), flip_y)));
}

}  // namespace

// `counter` and `key` of block 0; `along` is the counter word that counts blocks.
void normals(const std::uint32_t counter[4], const std::uint32_t key[2], int along, float* x,
             float* y) {
  const Floats d;
  const Words w;
  const Word byte = hn::Set(w, 0xffu);
  for (int i = 0; i < kBulkBlocks; i += static_cast<int>(hn::Lanes(d))) {
    Word c[4];
    for (int k = 0; k < 4; ++k) c[k] = hn::Set(w, counter[k]);
    c[along] = hn::Add(c[along], hn::Iota(w, static_cast<std::uint32_t>(i)));
    philox(c, key[0], key[1]);
    const Word third[] = {hn::And(c[3], byte), hn::And(hn::ShiftRight<8>(c[3]), byte),
                          hn::And(hn::ShiftRight<16>(c[3]), byte)};
    for (int j = 0; j < kBulkPairs; ++j) {
      const Word direction = hn::Or(hn::ShiftLeft<8>(hn::And(c[j], byte)), third[j]);
      Float a, b;
      box_muller(hn::ShiftRight<8>(c[j]), direction, a, b);
      hn::Store(a, d, x + j * kBulkBlocks + i);
      hn::Store(b, d, y + j * kBulkBlocks + i);
    }
  }
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lilytank {

HWY_EXPORT(normals);

void bulk_normals(const Draw& draw, bool along_bodies, float* x, float* y) {
  const auto counter = counter_of(draw);
  const auto key = key_of(draw.seed);
  HWY_DYNAMIC_DISPATCH(normals)(counter.data(), key.data(), along_bodies ? 1 : 0, x, y);
}

}  // namespace lilytank
#endif
