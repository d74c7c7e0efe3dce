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

// Philox4x32-10 at counters (index, body, step, step): what the bodies and indices of a call share.
// In the first three rounds most words depend on the body alone or on the index alone, so they are
// computed once for each body or as scalars.
class Philox {
 public:
  HWY_INLINE Philox(const std::uint32_t counter[4], const std::uint32_t key[2])
      : index_(counter[0]), body_(counter[1]), last_(counter[3]) {
    std::uint32_t k0 = key[0], k1 = key[1];
    const std::uint64_t p1 = product(counter[2], kM1);
    of_body_ = high(p1) ^ k0, c1_ = low(p1), key_[0] = k1;
    for (int round = 1; round < 10; ++round) {
      k0 += 0x9E3779B9u, k1 += 0xBB67AE85u;
      if (round < 3)
        key_[2 * round - 1] = k0, key_[2 * round] = k1;
      else
        k0_[round - 3] = k0, k1_[round - 3] = k1;
    }
  }

  // What a body contributes to each of its blocks: its word after the first round times the first
  // multiplier.
  struct Body {
    WideWord low, high;
  };
  HWY_INLINE Body body(int lane) const {
    const Wide w;
    const auto lanes = static_cast<std::uint32_t>(hn::Lanes(w));
    const auto first = body_ + static_cast<std::uint32_t>(lane);
    // An Iota from a number that is not a constant would go through memory.
    const auto of = [&](std::uint32_t from) {
      const auto number = hn::Add(hn::Iota(w, 0), hn::Set(w, from));
      return times(hn::Xor(number, hn::Set(w, of_body_)), kM0);
    };
    return {of(first), of(first + lanes)};
  }

  // What a block's index contributes.
  struct Index {
    std::uint32_t second, c0, c2, c3;
  };
  HWY_INLINE Index index(int block) const {
    const std::uint64_t p0 = product(index_ + static_cast<std::uint32_t>(block), kM0);
    const std::uint64_t p1 = product(high(p0) ^ last_ ^ key_[0], kM1);
    const std::uint64_t q0 = product(high(p1) ^ c1_ ^ key_[1], kM0);
    return {low(p0) ^ key_[2], low(p1) ^ key_[3], high(q0) ^ key_[4], low(q0)};
  }

  HWY_INLINE Blocks operator()(const Body& body, const Index& index) const {
    Chain a = start(body.low, index), b = start(body.high, index);
    for (int round = 0; round < 7; ++round) {
      go_on(a, all(k0_[round]), all(k1_[round]));
      go_on(b, all(k0_[round]), all(k1_[round]));
    }
    return {a, b};
  }
  // Two at once: each is one long chain, so two side by side fill the processor's pipes.
  HWY_INLINE void both(const Body (&body)[2], const Index (&index)[2], Blocks (&out)[2]) const {
    Chain a = start(body[0].low, index[0]), b = start(body[0].high, index[0]);
    Chain c = start(body[1].low, index[1]), e = start(body[1].high, index[1]);
    for (int round = 0; round < 7; ++round) {
      go_on(a, all(k0_[round]), all(k1_[round]));
      go_on(b, all(k0_[round]), all(k1_[round]));
      go_on(c, all(k0_[round]), all(k1_[round]));
      go_on(e, all(k0_[round]), all(k1_[round]));
    }
    out[0] = {a, b}, out[1] = {c, e};
  }

 private:
  static constexpr std::uint32_t kM0 = 0xD2511F53u, kM1 = 0xCD9E8D57u;

  static std::uint64_t product(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} * b; }
  static std::uint32_t high(std::uint64_t v) { return static_cast<std::uint32_t>(v >> 32); }
  static std::uint32_t low(std::uint64_t v) { return static_cast<std::uint32_t>(v); }
  static HWY_INLINE WideWord times(WideWord a, std::uint32_t b) {
    return hn::MulEven(hn::BitCast(Words(), a), hn::BitCast(Words(), hn::Set(Wide(), b)));
  }

  static HWY_INLINE WideWord all(std::uint32_t v) {
    return hn::BitCast(Wide(), hn::Set(Words(), v));
  }

  // The state after three rounds.
  static HWY_INLINE Chain start(WideWord body, const Index& index) {
    Chain c;
    c.c1 = times(hn::Xor(hn::ShiftRight<32>(body), all(index.second)), kM1);
    c.c0 = hn::Xor(hn::ShiftRight<32>(c.c1), all(index.c0));
    c.c2 = hn::Xor(body, all(index.c2));
    c.c3 = all(index.c3);
    return c;
  }
  static HWY_INLINE void go_on(Chain& c, WideWord k0, WideWord k1) {
    const auto p0 = times(c.c0, kM0), p1 = times(c.c2, kM1);
    c.c0 = hn::Xor3(hn::ShiftRight<32>(p1), c.c1, k0);
    c.c2 = hn::Xor3(hn::ShiftRight<32>(p0), c.c3, k1);
    c.c1 = p1, c.c3 = p0;
  }

  std::uint32_t index_, body_, last_, of_body_, c1_, key_[5];
  std::uint32_t k0_[7], k1_[7];  // of rounds 3 to 9
};

// Word k of each block.
template <int k>
HWY_INLINE Word word_of(const Blocks& b) {
  const Words d;
  const auto pick = [](const Chain& c) {
    return k == 0 ? c.c0 : k == 1 ? c.c1 : k == 2 ? c.c2 : c.c3;
  };
  return hn::ConcatEven(d, hn::BitCast(d, pick(b.high)), hn::BitCast(d, pick(b.low)));
}

template <int kDegree>
HWY_INLINE Float poly(Float x, const float (&coefficients)[kDegree + 1]) {
  const Floats d;
  Float sum = hn::Set(d, coefficients[kDegree]);
  for (int k = kDegree - 1; k >= 0; --k)
    sum = hn::Add(hn::Mul(sum, x), hn::Set(d, coefficients[k]));
  return sum;
}

// A polynomial with fewer steps in its longest chain than Horner's.
HWY_INLINE Float short_poly(Float x, const float (&c)[6]) {
  const Floats d;
  const auto pair = [&](int k) {
    return hn::Add(hn::Set(d, c[k]), hn::Mul(x, hn::Set(d, c[k + 1])));
  };
  const Float square = hn::Mul(x, x);
  return hn::Add(hn::Add(pair(0), hn::Mul(square, pair(2))),
                 hn::Mul(hn::Mul(square, square), pair(4)));
}

// The root of -2 ln u, u = v / 2^19 in (0, 1); relative error of the logarithm under 1e-5: no
// sample that fits on a disk could tell. ln(1 + f) / f is a minimax polynomial on [sqrt(1/2) - 1,
// sqrt(2) - 1].
HWY_INLINE Float length_of(Float v) {
  static constexpr float kLog[6] = {-2.00001108f, 0.999828104f,  -0.664965376f,
                                    0.507182786f, -0.443375456f, 0.293250656f};
  const Floats d;
  const Words w;
  const Whole s;
  const Word root_half = hn::Set(w, 0x3f3504f3u), octaves = hn::Set(w, 19u << 23);
  const Word bits = hn::Sub(hn::BitCast(w, v), hn::Add(root_half, octaves));
  const Float e = hn::ConvertTo(d, hn::ShiftRight<23>(hn::BitCast(s, bits)));
  const Word mantissa = hn::Add(hn::And(bits, hn::Set(w, 0x7fffffu)), root_half);
  const Float f = hn::Sub(hn::BitCast(d, mantissa), hn::Set(d, 1.0f));
  return hn::Sqrt(hn::Add(hn::Mul(e, hn::Set(d, -1.38629436f)), hn::Mul(f, short_poly(f, kLog))));
}

// Lane by lane, by the sign bit of `sign` alone: as floats, -0 and NaN would depend on the set.
HWY_INLINE Float where_signed(Float sign, Float yes, Float no) {
  const Whole s;
  return hn::BitCast(Floats(), hn::IfNegativeThenElse(hn::BitCast(s, sign), hn::BitCast(s, yes),
                                                      hn::BitCast(s, no)));
}

// Box and Muller: the pair of a word, see bulk_normals().
HWY_INLINE void store_pair(Word bits, float* out) {
  // Minimax on an eighth of a turn either way, errors under 1e-5. The place is an odd number of
  // 2^14ths of a turn.
  static constexpr float kUnit = static_cast<float>(3.14159265358979 / 4096), kTwo = kUnit * kUnit;
  static constexpr float kSine[3] = {0.999998569f * kUnit, -0.166624802f * kUnit * kTwo,
                                     0.00815163557f * kUnit * kTwo * kTwo};
  static constexpr float kCosine[3] = {0.999990035f, -0.49970814f * kTwo,
                                       0.0403985359f * kTwo * kTwo};
  const Floats d;
  const Words w;
  const Whole s;
  const auto number = [&](Word v) { return hn::ConvertTo(d, hn::BitCast(s, v)); };
  const Float length = length_of(hn::Add(number(hn::ShiftRight<13>(bits)), hn::Set(d, 0.5f)));
  const Float t = hn::Sub(number(hn::And(bits, hn::Set(w, 0x7ffu))), hn::Set(d, 1023.5f));
  const Float q = hn::Mul(t, t);
  const Float sine = hn::Mul(t, poly<2>(q, kSine)), cosine = poly<2>(q, kCosine);
  const Float way = hn::CopySignToAbs(length, hn::BitCast(d, hn::ShiftLeft<19>(bits)));
  const Float swap = hn::BitCast(d, hn::ShiftLeft<20>(bits));
  hn::Store(hn::Mul(way, where_signed(swap, sine, cosine)), d, out);
  hn::Store(hn::Mul(way, where_signed(swap, cosine, sine)), d, out + kBulkBodies);
}

// The first `count` numbers of a block.
HWY_INLINE void store_numbers(const Blocks& block, int count, float* out) {
  store_pair(word_of<0>(block), out);
  if (count > 2) store_pair(word_of<1>(block), out + 2 * kBulkBodies);
  if (count > 4) store_pair(word_of<2>(block), out + 4 * kBulkBodies);
  if (count > 6) store_pair(word_of<3>(block), out + 6 * kBulkBodies);
}

// A call for few numbers is faster if only what these need is loaded.
static HWY_NOINLINE void store_last(const Blocks& block, int count, float* out) {
  store_numbers(block, count, out);
}

// bulk_normals().
HWY_INLINE void normals_of_all(const std::uint32_t counter[4], const std::uint32_t key[2],
                               int count, float* out) {
  constexpr int kNumbers = 8, kEach = kNumbers * kBulkBodies;  // of a block
  const int lanes = static_cast<int>(hn::Lanes(Floats()));
  const Philox philox(counter, key);
  Blocks blocks[2];
  if (lanes == kBulkBodies) {
    const auto body = philox.body(0);
    for (int done = 0, block = 0; done < count;
         done += 2 * kNumbers, block += 2, out += 2 * kEach) {
      if (count - done <= kNumbers) {
        store_last(philox(body, philox.index(block)), count - done, out);
        return;
      }
      philox.both({body, body}, {philox.index(block), philox.index(block + 1)}, blocks);
      store_numbers(blocks[0], kNumbers, out);
      store_numbers(blocks[1], count - done - kNumbers, out + kEach);
    }
    return;
  }
  for (int i = 0; i < kBulkBodies; i += 2 * lanes) {
    const auto body = philox.body(i), next = philox.body(i + lanes);
    float* to = out + i;
    for (int done = 0, block = 0; done < count; done += kNumbers, ++block, to += kEach) {
      const auto index = philox.index(block);
      philox.both({body, next}, {index, index}, blocks);
      store_numbers(blocks[0], count - done, to);
      store_numbers(blocks[1], count - done, to + lanes);
    }
  }
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
