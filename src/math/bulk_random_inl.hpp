// Philox, and Box and Muller, on vectors: included by files that are compiled once for each
// instruction set. Only integer arithmetic and IEEE + - * sqrt, so all sets give the same bits.
#if defined(LILYTANK_BULK_RANDOM_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LILYTANK_BULK_RANDOM_INL
#undef LILYTANK_BULK_RANDOM_INL
#else
#define LILYTANK_BULK_RANDOM_INL
#endif

#include <hwy/highway.h>

#include "bulk_random.hpp"

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kBulkBodies>;
using Words = hn::RebindToUnsigned<Floats>;
using Whole = hn::RebindToSigned<Floats>;
using Wide = hn::RepartitionToWide<Words>;  // 64-bit lanes, half as many
using Float = hn::Vec<Floats>;
using Word = hn::Vec<Words>;
using WideWord = hn::Vec<Wide>;

// Four words for each of Lanes(Words) blocks, kept in the low halves of two vectors of 64-bit
// lanes: a product of 32-bit words then needs no shuffle. The upper halves hold rubbish.
struct Blocks {
  WideWord low[4], high[4];
};

// Philox4x32-10 of `kBlocks` sets of blocks at once: each is one long chain, so several fill the
// processor's pipes.
template <int kBlocks>
HWY_INLINE void philox(Blocks (&b)[kBlocks], const std::uint32_t key[2]) {
  const Words d;
  const Wide w;
  const auto m0 = hn::BitCast(d, hn::Set(w, 0xD2511F53u));
  const auto m1 = hn::BitCast(d, hn::Set(w, 0xCD9E8D57u));
  std::uint32_t k0 = key[0], k1 = key[1];
  const auto turn = [&](WideWord(&c)[4]) {
    const auto p0 = hn::MulEven(hn::BitCast(d, c[0]), m0);
    const auto p1 = hn::MulEven(hn::BitCast(d, c[2]), m1);
    c[0] = hn::Xor3(hn::ShiftRight<32>(p1), c[1], hn::Set(w, k0));
    c[2] = hn::Xor3(hn::ShiftRight<32>(p0), c[3], hn::Set(w, k1));
    c[1] = p1, c[3] = p0;
  };
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < kBlocks; ++i) turn(b[i].low), turn(b[i].high);
    k0 += 0x9E3779B9u;
    k1 += 0xBB67AE85u;
  }
}

HWY_INLINE Word word_of(const Blocks& b, int k) {
  const Words d;
  return hn::ConcatEven(d, hn::BitCast(d, b.high[k]), hn::BitCast(d, b.low[k]));
}

// Counters of the bodies from `first` lanes on: index + block, body + lane.
HWY_INLINE Blocks counters(const std::uint32_t counter[4], std::uint32_t first,
                           std::uint32_t block) {
  const Wide w;
  Blocks b;
  for (int k = 0; k < 4; ++k) b.low[k] = b.high[k] = hn::Set(w, counter[k]);
  b.low[0] = b.high[0] = hn::Set(w, counter[0] + block);
  // An Iota from a number that is not a constant would go through memory.
  b.low[1] = hn::Add(hn::Iota(w, 0), hn::Set(w, counter[1] + first));
  b.high[1] = hn::Add(b.low[1], hn::Set(w, static_cast<std::uint32_t>(hn::Lanes(w))));
  return b;
}

template <int kDegree>
HWY_INLINE Float poly(Float x, const float (&coefficients)[kDegree + 1]) {
  const Floats d;
  Float sum = hn::Set(d, coefficients[kDegree]);
  for (int k = kDegree - 1; k >= 0; --k)
    sum = hn::Add(hn::Mul(sum, x), hn::Set(d, coefficients[k]));
  return sum;
}

// ln u for u in (0, 1). ln(1 + f) / f is a minimax polynomial on [sqrt(1/2) - 1, sqrt(2) - 1] of
// relative error 3e-8.
HWY_INLINE Float log_of(Float u) {
  static constexpr float kLog[9] = {0.999999975f,  -0.499999777f, 0.333341605f,
                                    -0.250029461f, 0.199584171f,  -0.165437379f,
                                    0.149173777f,  -0.144821859f, 0.089599121f};
  const Floats d;
  const Words w;
  const Whole s;
  const Word bits = hn::Sub(hn::BitCast(w, u), hn::Set(w, 0x3f3504f3u));
  const Float e = hn::ConvertTo(d, hn::ShiftRight<23>(hn::BitCast(s, bits)));
  const Word mantissa = hn::Add(hn::And(bits, hn::Set(w, 0x7fffffu)), hn::Set(w, 0x3f3504f3u));
  const Float f = hn::Sub(hn::BitCast(d, mantissa), hn::Set(d, 1.0f));
  return hn::Add(hn::Mul(e, hn::Set(d, 0.693147181f)), hn::Mul(f, poly<8>(f, kLog)));
}

// Box and Muller on one lot of bits: 24 for the length, 16 for the direction.
HWY_INLINE void box_muller(Word length_bits, Word direction_bits, Float& x, Float& y) {
  // Taylor sums, exact to float32 on an eighth of a turn either way.
  static constexpr float kSine[5] = {1.0f, -1.0f / 6, 1.0f / 120, -1.0f / 5040, 1.0f / 362880};
  static constexpr float kCosine[5] = {1.0f, -0.5f, 1.0f / 24, -1.0f / 720, 1.0f / 40320};
  const Floats d;
  const Words w;
  const Whole s;
  const Float u = hn::Mul(hn::Add(hn::ConvertTo(d, hn::BitCast(s, length_bits)), hn::Set(d, 0.5f)),
                          hn::Set(d, 0x1p-24f));
  const Float length = hn::Sqrt(hn::Mul(log_of(u), hn::Set(d, -2.0f)));
  // The low 14 bits are a place in a quarter turn about 0, the upper two say which quarter.
  const Word place = hn::And(direction_bits, hn::Set(w, 0x3fffu));
  const Float t =
      hn::Mul(hn::Sub(hn::ConvertTo(d, hn::BitCast(s, place)), hn::Set(d, 8191.5f)),
              hn::Set(d, static_cast<float>(3.14159265358979 / 32768)));
  const Float q = hn::Mul(t, t);
  const Float sine = hn::Mul(t, poly<4>(q, kSine)), cosine = poly<4>(q, kCosine);
  const Word quarter = hn::ShiftRight<14>(direction_bits);
  const auto odd = hn::RebindMask(d, hn::Ne(hn::And(quarter, hn::Set(w, 1u)), hn::Zero(w)));
  const Word flip_x = hn::ShiftLeft<30>(hn::And(hn::Add(quarter, hn::Set(w, 1u)), hn::Set(w, 2u)));
  const Word flip_y = hn::ShiftLeft<30>(hn::And(quarter, hn::Set(w, 2u)));
  const Float a = hn::IfThenElse(odd, sine, cosine), b = hn::IfThenElse(odd, cosine, sine);
  x = hn::Mul(length, hn::BitCast(d, hn::Xor(hn::BitCast(w, a), flip_x)));
  y = hn::Mul(length, hn::BitCast(d, hn::Xor(hn::BitCast(w, b), flip_y)));
}

// Pair j of a block: see bulk_normals().
HWY_INLINE void normal_pair_of(const Blocks& block, int j, Float& x, Float& y) {
  const Words w;
  const Word byte = hn::Set(w, 0xffu);
  const Word bits = word_of(block, j), rest = word_of(block, 3);
  const Word third = hn::And(j == 0   ? rest
                             : j == 1 ? hn::ShiftRight<8>(rest)
                                      : hn::ShiftRight<16>(rest),
                             byte);
  box_muller(hn::ShiftRight<8>(bits), hn::Or(hn::ShiftLeft<8>(hn::And(bits, byte)), third), x, y);
}

// Numbers [first, count) of the bodies of one vector, from `kBlocks` blocks at most.
template <int kBlocks>
HWY_INLINE void normals_from(const std::uint32_t counter[4], const std::uint32_t key[2],
                             std::uint32_t body, int first, int count, float* out) {
  const Floats d;
  Blocks blocks[kBlocks];
  for (int i = 0; i < kBlocks; ++i)
    blocks[i] = counters(counter, body, static_cast<std::uint32_t>(first / 6 + i));
  philox(blocks, key);
  for (int i = 0; i < kBlocks; ++i) {
    for (int j = 0; j < 3 && first + 6 * i + 2 * j < count; ++j) {
      Float x, y;
      normal_pair_of(blocks[i], j, x, y);
      float* at = out + (first + 6 * i + 2 * j) * kBulkBodies;
      hn::Store(x, d, at), hn::Store(y, d, at + kBulkBodies);
    }
  }
}

// bulk_normals() for the bodies of one vector, from `body` on.
HWY_INLINE void normals_of(const std::uint32_t counter[4], const std::uint32_t key[2],
                           std::uint32_t body, int count, float* out) {
  int first = 0;
  for (; first + 6 < count; first += 12) normals_from<2>(counter, key, body, first, count, out);
  if (first < count) normals_from<1>(counter, key, body, first, count, out);
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
