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

// Four words for each of as many blocks as there are 64-bit lanes, in their low halves: a product
// of 32-bit words then needs no shuffle. The upper halves hold rubbish.
struct Chain {
  WideWord c0, c1, c2, c3;
};
// The blocks of one vector of bodies.
struct Blocks {
  Chain low, high;
};

HWY_INLINE void philox_round(Chain& c, Word m0, Word m1, WideWord k0, WideWord k1) {
  const Words d;
  const auto p0 = hn::MulEven(hn::BitCast(d, c.c0), m0);
  const auto p1 = hn::MulEven(hn::BitCast(d, c.c2), m1);
  c.c0 = hn::Xor3(hn::ShiftRight<32>(p1), c.c1, k0);
  c.c2 = hn::Xor3(hn::ShiftRight<32>(p0), c.c3, k1);
  c.c1 = p1, c.c3 = p0;
}

// Philox4x32-10 of one or two sets of blocks: each is one long chain, so several side by side fill
// the processor's pipes. Copies, so that the compiler keeps them in registers.
template <int kSets>
HWY_INLINE void philox(Blocks* sets, const std::uint32_t key[2]) {
  const Words d;
  const Wide w;
  const auto m0 = hn::BitCast(d, hn::Set(w, 0xD2511F53u));
  const auto m1 = hn::BitCast(d, hn::Set(w, 0xCD9E8D57u));
  Chain a = sets[0].low, b = sets[0].high, c = sets[kSets - 1].low, e = sets[kSets - 1].high;
  std::uint32_t key0 = key[0], key1 = key[1];
  for (int round = 0; round < 10; ++round) {
    const auto k0 = hn::Set(w, key0), k1 = hn::Set(w, key1);
    philox_round(a, m0, m1, k0, k1);
    philox_round(b, m0, m1, k0, k1);
    if (kSets == 2) {
      philox_round(c, m0, m1, k0, k1);
      philox_round(e, m0, m1, k0, k1);
    }
    key0 += 0x9E3779B9u;
    key1 += 0xBB67AE85u;
  }
  if (kSets == 2) sets[1] = {c, e};
  sets[0] = {a, b};
}

// Word k of each block.
template <int k>
HWY_INLINE Word word_of(const Blocks& b) {
  const Words d;
  const auto pick = [](const Chain& c) {
    return k == 0 ? c.c0 : k == 1 ? c.c1 : k == 2 ? c.c2 : c.c3;
  };
  return hn::ConcatEven(d, hn::BitCast(d, pick(b.high)), hn::BitCast(d, pick(b.low)));
}

// Counters of the bodies from `first` lanes on: index + block, body + lane.
HWY_INLINE Blocks counters(const std::uint32_t counter[4], std::uint32_t first,
                           std::uint32_t block) {
  const Wide w;
  Blocks b;
  b.low.c0 = b.high.c0 = hn::Set(w, counter[0] + block);
  // An Iota from a number that is not a constant would go through memory.
  b.low.c1 = hn::Add(hn::Iota(w, 0), hn::Set(w, counter[1] + first));
  b.high.c1 = hn::Add(b.low.c1, hn::Set(w, static_cast<std::uint32_t>(hn::Lanes(w))));
  b.low.c2 = b.high.c2 = hn::Set(w, counter[2]);
  b.low.c3 = b.high.c3 = hn::Set(w, counter[3]);
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

// ln u for u in (0, 1), relative error under 1e-5: no sample that fits on a disk could tell. ln(1 +
// f) / f is a minimax polynomial on [sqrt(1/2) - 1, sqrt(2) - 1].
HWY_INLINE Float log_of(Float u) {
  static constexpr float kLog[6] = {1.00000554f,   -0.499914052f, 0.332482688f,
                                    -0.253591391f, 0.221687748f,  -0.146625336f};
  const Floats d;
  const Words w;
  const Whole s;
  const Word bits = hn::Sub(hn::BitCast(w, u), hn::Set(w, 0x3f3504f3u));
  const Float e = hn::ConvertTo(d, hn::ShiftRight<23>(hn::BitCast(s, bits)));
  const Word mantissa = hn::Add(hn::And(bits, hn::Set(w, 0x7fffffu)), hn::Set(w, 0x3f3504f3u));
  const Float f = hn::Sub(hn::BitCast(d, mantissa), hn::Set(d, 1.0f));
  return hn::Add(hn::Mul(e, hn::Set(d, 0.693147181f)), hn::Mul(f, poly<5>(f, kLog)));
}

// Box and Muller on one lot of bits: 24 for the length, 16 for the direction.
HWY_INLINE void box_muller(Word length_bits, Word direction_bits, Float& x, Float& y) {
  // Minimax on an eighth of a turn either way, errors under 1e-5.
  static constexpr float kSine[3] = {0.999998569f, -0.166624802f, 0.00815163557f};
  static constexpr float kCosine[3] = {0.999990035f, -0.49970814f, 0.0403985359f};
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
  const Float sine = hn::Mul(t, poly<2>(q, kSine)), cosine = poly<2>(q, kCosine);
  const Word quarter = hn::ShiftRight<14>(direction_bits);
  const auto odd = hn::RebindMask(d, hn::Ne(hn::And(quarter, hn::Set(w, 1u)), hn::Zero(w)));
  const Word flip_x = hn::ShiftLeft<30>(hn::And(hn::Add(quarter, hn::Set(w, 1u)), hn::Set(w, 2u)));
  const Word flip_y = hn::ShiftLeft<30>(hn::And(quarter, hn::Set(w, 2u)));
  const Float a = hn::IfThenElse(odd, sine, cosine), b = hn::IfThenElse(odd, cosine, sine);
  x = hn::Mul(length, hn::BitCast(d, hn::Xor(hn::BitCast(w, a), flip_x)));
  y = hn::Mul(length, hn::BitCast(d, hn::Xor(hn::BitCast(w, b), flip_y)));
}

// Pair j of a block: see bulk_normals(). `rest` is word 3.
template <int j>
HWY_INLINE void store_pair(const Blocks& block, Word rest, float* out) {
  const Floats d;
  const Words w;
  const Word byte = hn::Set(w, 0xffu), bits = word_of<j>(block);
  const Word third = hn::And(hn::ShiftRight<8 * j>(rest), byte);
  Float x, y;
  box_muller(hn::ShiftRight<8>(bits), hn::Or(hn::ShiftLeft<8>(hn::And(bits, byte)), third), x, y);
  hn::Store(x, d, out + 2 * j * kBulkBodies), hn::Store(y, d, out + (2 * j + 1) * kBulkBodies);
}

// The first `count` (up to six) numbers of a block. Not inlined: it would take most of the time to
// compile, and run no faster.
static HWY_NOINLINE void store_numbers(const Blocks& block, int count, float* out) {
  const Word rest = word_of<3>(block);
  store_pair<0>(block, rest, out);
  if (count > 2) store_pair<1>(block, rest, out);
  if (count > 4) store_pair<2>(block, rest, out);
}

// The numbers of the bodies of one vector, from `body` on.
HWY_INLINE void normals_of(const std::uint32_t counter[4], const std::uint32_t key[2],
                           std::uint32_t body, int count, float* out) {
  constexpr int kEach = 6 * kBulkBodies;
  const int full = count / 12;
  for (int k = 0; k < full; ++k, out += 2 * kEach) {
    const auto index = static_cast<std::uint32_t>(2 * k);
    Blocks sets[2] = {counters(counter, body, index), counters(counter, body, index + 1)};
    philox<2>(sets, key);
    store_numbers(sets[0], 6, out);
    store_numbers(sets[1], 6, out + kEach);
  }
  for (int done = 12 * full; done < count; done += 6, out += kEach) {
    Blocks set = counters(counter, body, static_cast<std::uint32_t>(done / 6));
    philox<1>(&set, key);
    store_numbers(set, count - done, out);
  }
}

// bulk_normals(). Where one block each is enough, two vectors of bodies are drawn side by side.
HWY_INLINE void normals_of_all(const std::uint32_t counter[4], const std::uint32_t key[2],
                               int count, float* out) {
  const int lanes = static_cast<int>(hn::Lanes(Floats()));
  if (count > 6 || lanes == kBulkBodies) {
    for (int i = 0; i < kBulkBodies; i += lanes)
      normals_of(counter, key, static_cast<std::uint32_t>(i), count, out + i);
    return;
  }
  for (int i = 0; i < kBulkBodies; i += 2 * lanes) {
    Blocks sets[2] = {counters(counter, static_cast<std::uint32_t>(i), 0),
                      counters(counter, static_cast<std::uint32_t>(i + lanes), 0)};
    philox<2>(sets, key);
    store_numbers(sets[0], count, out + i);
    store_numbers(sets[1], count, out + i + lanes);
  }
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
