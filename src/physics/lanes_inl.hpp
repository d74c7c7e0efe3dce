// Vectors of float32 with operators, for code in which a lane is one island or one pair: included
// within a namespace by files that are compiled once for each instruction set, with LILYTANK_LANES
// at most that many lanes. Only + - * / sqrt and comparisons, so all widths give the same bits; no
// operation crosses lanes except any().
#if LILYTANK_LANES == 1  // a crowd by itself: the same as below, without vectors
struct F {
  float v;
  HWY_INLINE F(float all) : v(all) {}
  F() = default;
};
struct Mask {
  bool m;
};
struct Whole {
  std::int32_t v;
  Whole() = default;
  HWY_INLINE Whole(std::int32_t all) : v(all) {}
};

HWY_INLINE F operator+(F a, F b) {
  return a.v + b.v;
}
HWY_INLINE F operator-(F a, F b) {
  return a.v - b.v;
}
HWY_INLINE F operator*(F a, F b) {
  return a.v * b.v;
}
HWY_INLINE F operator/(F a, F b) {
  return a.v / b.v;
}
HWY_INLINE F operator-(F a) {
  return -a.v;
}
HWY_INLINE Mask operator<(F a, F b) {
  return {a.v < b.v};
}
HWY_INLINE Mask operator>(F a, F b) {
  return {a.v > b.v};
}
HWY_INLINE Mask operator<=(F a, F b) {
  return {a.v <= b.v};
}
HWY_INLINE Mask operator>=(F a, F b) {
  return {a.v >= b.v};
}
HWY_INLINE Mask operator==(F a, F b) {
  return {a.v == b.v};
}
HWY_INLINE Mask operator!=(F a, F b) {
  return {a.v != b.v};
}
HWY_INLINE Mask operator&(Mask a, Mask b) {
  return {a.m && b.m};
}
HWY_INLINE Mask operator|(Mask a, Mask b) {
  return {a.m || b.m};
}
HWY_INLINE Mask operator~(Mask a) {
  return {!a.m};
}
HWY_INLINE Whole operator+(Whole a, Whole b) {
  return a.v + b.v;
}
HWY_INLINE Whole operator-(Whole a, Whole b) {
  return a.v - b.v;
}
HWY_INLINE Whole operator&(Whole a, Whole b) {
  return a.v & b.v;
}
HWY_INLINE F abs(F a) {
  return std::fabs(a.v);
}
HWY_INLINE F root(F a) {
  return std::sqrt(a.v);
}
HWY_INLINE F floor(F a) {
  return std::floor(a.v);
}
HWY_INLINE F lesser(F a, F b) {
  return a.v < b.v ? a.v : b.v;
}
HWY_INLINE F greater(F a, F b) {
  return a.v > b.v ? a.v : b.v;
}
HWY_INLINE F choose(Mask m, F yes, F no) {
  return m.m ? yes.v : no.v;
}
HWY_INLINE F choose(Mask m, float yes, float no) {
  return m.m ? yes : no;
}
HWY_INLINE F keep(Mask m, F yes) {
  return m.m ? yes.v : 0.0f;
}
HWY_INLINE Whole choose(Mask m, Whole yes, Whole no) {
  return m.m ? yes : no;
}
HWY_INLINE Mask choose(Mask m, Mask yes, Mask no) {
  return m.m ? yes : no;
}
HWY_INLINE Mask none() {
  return {false};
}
HWY_INLINE bool any(Mask m) {
  return m.m;
}
HWY_INLINE Mask has_bit(Whole bits, Whole bit) {
  return {(bits.v >> bit.v & 1) != 0};
}
HWY_INLINE F gather(const float* rows, Whole index) {
  return rows[index.v];
}
HWY_INLINE void scatter(F value, float* rows, Whole index) {
  rows[index.v] = value.v;
}
HWY_INLINE Mask operator==(Whole a, Whole b) {
  return {a.v == b.v};
}
HWY_INLINE Mask operator>(Whole a, Whole b) {
  return {a.v > b.v};
}
HWY_INLINE F load(const float* from) {
  return *from;
}
HWY_INLINE void store(F value, float* to) {
  *to = value.v;
}
HWY_INLINE Whole load(const std::int32_t* from) {
  return *from;
}
HWY_INLINE void store(Whole value, std::int32_t* to) {
  *to = value.v;
}
HWY_INLINE F float_of(Mask m) {
  return std::bit_cast<float>(m.m ? -1 : 0);
}
HWY_INLINE Mask mask_of(F bits) {
  return {std::bit_cast<std::int32_t>(bits.v) < 0};
}
HWY_INLINE Whole whole_of(F a) {
  return static_cast<std::int32_t>(a.v);
}
HWY_INLINE std::size_t width() {
  return 1;
}
#else
using FloatTag = hn::CappedTag<float, LILYTANK_LANES>;
using WholeTag = hn::RebindToSigned<FloatTag>;

/// One number of each lane.
struct F {
  hn::Vec<FloatTag> v;
  HWY_INLINE F(hn::Vec<FloatTag> raw) : v(raw) {}
  HWY_INLINE F(float all) : v(hn::Set(FloatTag(), all)) {}
  F() = default;
};
/// One yes or no of each lane.
struct Mask {
  hn::Mask<FloatTag> m;
};
/// One int32 of each lane.
struct Whole {
  hn::Vec<WholeTag> v;
  Whole() = default;
  HWY_INLINE Whole(hn::Vec<WholeTag> raw) : v(raw) {}
  HWY_INLINE Whole(std::int32_t all) : v(hn::Set(WholeTag(), all)) {}
};

HWY_INLINE F operator+(F a, F b) {
  return hn::Add(a.v, b.v);
}
HWY_INLINE F operator-(F a, F b) {
  return hn::Sub(a.v, b.v);
}
HWY_INLINE F operator*(F a, F b) {
  return hn::Mul(a.v, b.v);
}
HWY_INLINE F operator/(F a, F b) {
  return hn::Div(a.v, b.v);
}
HWY_INLINE F operator-(F a) {
  return hn::Neg(a.v);
}
HWY_INLINE Mask operator<(F a, F b) {
  return {hn::Lt(a.v, b.v)};
}
HWY_INLINE Mask operator>(F a, F b) {
  return {hn::Gt(a.v, b.v)};
}
HWY_INLINE Mask operator<=(F a, F b) {
  return {hn::Le(a.v, b.v)};
}
HWY_INLINE Mask operator>=(F a, F b) {
  return {hn::Ge(a.v, b.v)};
}
HWY_INLINE Mask operator==(F a, F b) {
  return {hn::Eq(a.v, b.v)};
}
HWY_INLINE Mask operator!=(F a, F b) {
  return {hn::Ne(a.v, b.v)};
}
HWY_INLINE Mask operator&(Mask a, Mask b) {
  return {hn::And(a.m, b.m)};
}
HWY_INLINE Mask operator|(Mask a, Mask b) {
  return {hn::Or(a.m, b.m)};
}
HWY_INLINE Mask operator~(Mask a) {
  return {hn::Not(a.m)};
}
HWY_INLINE Whole operator+(Whole a, Whole b) {
  return hn::Add(a.v, b.v);
}
HWY_INLINE Whole operator-(Whole a, Whole b) {
  return hn::Sub(a.v, b.v);
}
HWY_INLINE Whole operator&(Whole a, Whole b) {
  return hn::And(a.v, b.v);
}

HWY_INLINE F abs(F a) {
  return hn::Abs(a.v);
}
HWY_INLINE F root(F a) {
  return hn::Sqrt(a.v);
}
HWY_INLINE F floor(F a) {
  return hn::Floor(a.v);
}
/// The lesser and the greater; `b` where they are equal or `a` is not a number.
HWY_INLINE F lesser(F a, F b) {
  return hn::IfThenElse(hn::Lt(a.v, b.v), a.v, b.v);
}
HWY_INLINE F greater(F a, F b) {
  return hn::IfThenElse(hn::Gt(a.v, b.v), a.v, b.v);
}
HWY_INLINE F choose(Mask m, F yes, F no) {
  return hn::IfThenElse(m.m, yes.v, no.v);
}
HWY_INLINE F choose(Mask m, float yes, float no) {
  return choose(m, F(yes), F(no));
}
/// `yes`, or 0.
HWY_INLINE F keep(Mask m, F yes) {
  return hn::IfThenElseZero(m.m, yes.v);
}
HWY_INLINE Whole choose(Mask m, Whole yes, Whole no) {
  return hn::IfThenElse(hn::RebindMask(WholeTag(), m.m), yes.v, no.v);
}
HWY_INLINE Mask choose(Mask m, Mask yes, Mask no) {
  return (m & yes) | (~m & no);
}
HWY_INLINE Mask none() {
  return {hn::MaskFromVec(hn::Zero(FloatTag()))};
}
HWY_INLINE bool any(Mask m) {
  return !hn::AllFalse(FloatTag(), m.m);
}
/// Bit number `bit`, 0 to 3, of `bits`.
HWY_INLINE Mask has_bit(Whole bits, Whole bit) {
  const auto one = hn::Set(WholeTag(), 1);
  const auto set = hn::And(hn::Shr(bits.v, bit.v), one);
  return {hn::RebindMask(FloatTag(), hn::Eq(set, one))};
}
/// Numbers from rows of any movers: `index` counts floats from the first lane of the first row.
HWY_INLINE F gather(const float* rows, Whole index) {
  return hn::GatherIndex(FloatTag(), rows, index.v);
}
HWY_INLINE void scatter(F value, float* rows, Whole index) {
  hn::ScatterIndex(value.v, FloatTag(), rows, index.v);
}
HWY_INLINE Mask operator==(Whole a, Whole b) {
  return {hn::RebindMask(FloatTag(), hn::Eq(a.v, b.v))};
}

HWY_INLINE Mask operator>(Whole a, Whole b) {
  return {hn::RebindMask(FloatTag(), hn::Gt(a.v, b.v))};
}
/// Reads and writes lanes from an aligned place on.
HWY_INLINE F load(const float* from) {
  return hn::Load(FloatTag(), from);
}
HWY_INLINE void store(F value, float* to) {
  hn::Store(value.v, FloatTag(), to);
}
HWY_INLINE Whole load(const std::int32_t* from) {
  return hn::Load(WholeTag(), from);
}
HWY_INLINE void store(Whole value, std::int32_t* to) {
  hn::Store(value.v, WholeTag(), to);
}
/// Yes and no as bits, all or none, and back.
HWY_INLINE F float_of(Mask m) {
  return hn::VecFromMask(FloatTag(), m.m);
}
HWY_INLINE Mask mask_of(F bits) {
  return {hn::MaskFromVec(bits.v)};
}
HWY_INLINE Whole whole_of(F a) {
  return hn::ConvertTo(WholeTag(), a.v);
}
HWY_INLINE std::size_t width() {
  return hn::Lanes(FloatTag());
}
#endif

HWY_INLINE F& operator+=(F& a, F b) {
  return a = a + b;
}
HWY_INLINE F& operator-=(F& a, F b) {
  return a = a - b;
}
HWY_INLINE F& operator*=(F& a, F b) {
  return a = a * b;
}
HWY_INLINE Mask& operator&=(Mask& a, Mask b) {
  return a = a & b;
}
HWY_INLINE Mask& operator|=(Mask& a, Mask b) {
  return a = a | b;
}
HWY_INLINE F sign(F a) {
  return choose(a < 0.0f, -1.0f, 1.0f);
}
HWY_INLINE F length(F x, F y) {
  return root(x * x + y * y);
}

/// cos and sin of a small angle from its Taylor sums; errors below 2e-8 for |a| <= 0.25.
HWY_INLINE void series(F a, F& c, F& s) {
  const F q = a * a;
  s = a * (1.0f - (1.0f / 6) * q * (1.0f - (1.0f / 20) * q * (1.0f - (1.0f / 42) * q)));
  c = 1.0f - 0.5f * q * (1.0f - (1.0f / 12) * q * (1.0f - (1.0f / 30) * q));
}

// The same for angles up to a few radians: an eighth of it, doubled three times.
static HWY_NOINLINE void series_of_large(F a, F& c, F& s) {
  series(0.125f * a, c, s);
  for (int k = 0; k < 3; ++k) {
    const F twice = 2.0f * s, half = c;
    c = 1.0f - twice * s, s = twice * half;
  }
}

/// Turns (c, s) by `angle` (rad), length kept at 1, where `on`; elsewhere not a bit changes.
HWY_INLINE void turn(F& c, F& s, F angle, Mask on) {
  F tc, ts;
  series(angle, tc, ts);
  const Mask large = on & (abs(angle) > 0.25f);
  if (any(large)) {
    F lc, ls;
    series_of_large(angle, lc, ls);
    tc = choose(large, lc, tc), ts = choose(large, ls, ts);
  }
  const F nc = c * tc - s * ts, ns = c * ts + s * tc;
  const F scale = 1.5f - 0.5f * (nc * nc + ns * ns);
  c = choose(on, nc * scale, c), s = choose(on, ns * scale, s);
}
