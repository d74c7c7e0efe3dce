// Reads the flow field for one vector of points: included by files that are compiled once for each
// instruction set, with the same bits from each.
#if defined(LILYTANK_FLOW_LOOKUP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LILYTANK_FLOW_LOOKUP_INL
#undef LILYTANK_FLOW_LOOKUP_INL
#else
#define LILYTANK_FLOW_LOOKUP_INL
#endif

#include <hwy/highway.h>

#include "lilytank/flow_field.hpp"
#include "math/bulk_random_inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {

/// Mean and deviation at one vector of points, m/s.
struct Water {
  Float mu_x, mu_y, sigma_x, sigma_y;
};

/// A field as the kernels read it, with points in cells: cell (i, j) has its centre at (i, j).
struct Lookup {
  explicit Lookup(const FlowField& field)
      : rows(reinterpret_cast<const char*>(field.rows().data())),
        cells(field.cells()),
        nearest(field.interpolation() == Interpolation::nearest),
        extent(static_cast<float>(field.extent())),
        per_metre(static_cast<float>(field.cells() / (2 * field.extent()))) {}

  const char* rows;
  int cells;
  bool nearest;
  float extent, per_metre;  ///< m, 1/m

  /// A coordinate in metres as one in cells.
  HWY_INLINE Float cells_of(Float metres) const {
    const Floats d;
    return hn::Sub(hn::Mul(hn::Add(metres, hn::Set(d, extent)), hn::Set(d, per_metre)),
                   hn::Set(d, 0.5f));
  }
};

/// Points to be read, up to kMostPoints for each lane: where a point's row begins (bytes), and its
/// place between cell centres.
constexpr int kMostPoints = 24;
struct Spots {
  alignas(64) std::int32_t offset[kMostPoints][16];
  Float tx[kMostPoints], ty[kMostPoints];
};

// In-block 4 x 4 transposition: lane 4b + i of vector j goes to lane 4b + j of vector i.
HWY_INLINE void transpose(Float& a, Float& b, Float& c, Float& e) {
  const Floats d;
  const Wide w;
  const auto wide = [&](Float v) { return hn::BitCast(w, v); };
  const auto l0 = wide(hn::InterleaveLower(d, a, b)), u0 = wide(hn::InterleaveUpper(d, a, b));
  const auto l1 = wide(hn::InterleaveLower(d, c, e)), u1 = wide(hn::InterleaveUpper(d, c, e));
  a = hn::BitCast(d, hn::InterleaveLower(w, l0, l1));
  b = hn::BitCast(d, hn::InterleaveUpper(w, l0, l1));
  c = hn::BitCast(d, hn::InterleaveLower(w, u0, u1));
  e = hn::BitCast(d, hn::InterleaveUpper(w, u0, u1));
}

// Four floats (mu_x, mu_y, sigma_x, sigma_y) for each point, (a + ty c) + tx (b + ty e) from the
// row of its cell.
#if HWY_MAX_BYTES == 64
HWY_INLINE Float spread(Float v, const std::int32_t (&lanes)[16]) {
  return hn::TableLookupLanes(v, hn::SetTableIndices(Floats(), lanes));
}

// Points j, 4 + j, 8 + j and 12 + j, one in each block of the result.
template <int j>
HWY_INLINE Float read_four(const char* rows, const std::int32_t* offset, Float tx, Float ty) {
  alignas(64) static constexpr std::int32_t kFirst[16] = {
      j, j, j, j, j, j, j, j, j + 4, j + 4, j + 4, j + 4, j + 4, j + 4, j + 4, j + 4};
  alignas(64) static constexpr std::int32_t kSecond[16] = {
      j + 8,  j + 8,  j + 8,  j + 8,  j + 8,  j + 8,  j + 8,  j + 8,
      j + 12, j + 12, j + 12, j + 12, j + 12, j + 12, j + 12, j + 12};
  alignas(64) static constexpr std::int32_t kAll[16] = {j,      j,      j,      j,     j + 4, j + 4,
                                                        j + 4,  j + 4,  j + 8,  j + 8, j + 8, j + 8,
                                                        j + 12, j + 12, j + 12, j + 12};
  const Floats d;
  const hn::Half<Floats> half;
  const auto row = [&](int k) { return reinterpret_cast<const float*>(rows + offset[k]); };
  // [a b] + ty [c e] of two points.
  const auto along_y = [&](int p, int q, Float y) {
    const auto low = hn::Combine(d, hn::Load(half, row(q)), hn::Load(half, row(p)));
    const auto high = hn::Combine(d, hn::Load(half, row(q) + 8), hn::Load(half, row(p) + 8));
    return hn::Add(low, hn::Mul(high, y));
  };
  const Float one = along_y(j, j + 4, spread(ty, kFirst));
  const Float two = along_y(j + 8, j + 12, spread(ty, kSecond));
  const Float even{_mm512_shuffle_f32x4(one.raw, two.raw, 0x88)};
  const Float odd{_mm512_shuffle_f32x4(one.raw, two.raw, 0xDD)};
  return hn::Add(even, hn::Mul(odd, spread(tx, kAll)));
}

HWY_INLINE Water read_rows(const char* rows, const std::int32_t* offset, Float tx, Float ty) {
  Float a = read_four<0>(rows, offset, tx, ty), b = read_four<1>(rows, offset, tx, ty);
  Float c = read_four<2>(rows, offset, tx, ty), e = read_four<3>(rows, offset, tx, ty);
  transpose(a, b, c, e);
  return {a, b, c, e};
}
#elif HWY_MAX_BYTES == 32
// Points j and 4 + j, one in each block of the result.
template <int j>
HWY_INLINE Float read_two(const char* rows, const std::int32_t* offset, Float tx, const float* ty) {
  const Floats d;
  // [a b] + ty [c e] of a point.
  const auto along_y = [&](int p) {
    const float* row = reinterpret_cast<const float*>(rows + offset[p]);
    return hn::Add(hn::Load(d, row), hn::Mul(hn::Load(d, row + 8), hn::Set(d, ty[p])));
  };
  const Float one = along_y(j), two = along_y(j + 4);
  const Float even = hn::ConcatLowerLower(d, two, one), odd = hn::ConcatUpperUpper(d, two, one);
  return hn::Add(even, hn::Mul(odd, hn::Broadcast<j>(tx)));
}

HWY_INLINE Water read_rows(const char* rows, const std::int32_t* offset, Float tx, Float ty) {
  alignas(32) float y[8];
  hn::Store(ty, Floats(), y);
  Float a = read_two<0>(rows, offset, tx, y), b = read_two<1>(rows, offset, tx, y);
  Float c = read_two<2>(rows, offset, tx, y), e = read_two<3>(rows, offset, tx, y);
  transpose(a, b, c, e);
  return {a, b, c, e};
}
#else
HWY_INLINE Water read_rows(const char* rows, const std::int32_t* offset, Float tx, Float ty) {
  const Floats d;
  const hn::CappedTag<float, 4> four;
  constexpr int kLanes = HWY_MIN(HWY_MAX_BYTES / 4, 16);
  alignas(64) float x[kLanes], y[kLanes], out[4 * kLanes];
  hn::Store(tx, d, x), hn::Store(ty, d, y);
  for (int i = 0; i < static_cast<int>(hn::Lanes(d)); ++i) {
    const float* row = reinterpret_cast<const float*>(rows + offset[i]);
    const auto wx = hn::Set(four, x[i]), wy = hn::Set(four, y[i]);
    const auto low = hn::Add(hn::Load(four, row), hn::Mul(hn::Load(four, row + 8), wy));
    const auto high = hn::Add(hn::Load(four, row + 4), hn::Mul(hn::Load(four, row + 12), wy));
    hn::Store(hn::Add(low, hn::Mul(high, wx)), four, out + 4 * i);
  }
  Water u;
  hn::LoadInterleaved4(d, out, u.mu_x, u.mu_y, u.sigma_x, u.sigma_y);
  return u;
}
#endif

/// Notes point k, given in cells.
HWY_INLINE void locate(const Lookup& field, Float gx, Float gy, int k, Spots& spots) {
  const Floats d;
  const Whole w;
  const Float last = hn::Set(d, static_cast<float>(field.cells - 1));
  const Float most = hn::Set(d, static_cast<float>(field.cells - 2));
  gx = hn::Min(hn::Max(gx, hn::Zero(d)), last), gy = hn::Min(hn::Max(gy, hn::Zero(d)), last);
  if (field.nearest) {
    const Float half = hn::Set(d, 0.5f);
    gx = hn::ConvertTo(d, hn::ConvertTo(w, hn::Add(gx, half)));
    gy = hn::ConvertTo(d, hn::ConvertTo(w, hn::Add(gy, half)));
  }
  const Float ix = hn::Floor(hn::Min(gx, most)), iy = hn::Floor(hn::Min(gy, most));
  const Float row = hn::Add(hn::Mul(iy, hn::Set(d, static_cast<float>(field.cells))), ix);
  // Whole numbers below 2^23 are the low bits of their sum with it: rounding to integers would look
  // after overflows as well.
  const Float unit = hn::Set(d, 8388608.0f);
  const auto whole = hn::Sub(hn::BitCast(w, hn::Add(row, unit)), hn::BitCast(w, unit));
  hn::Store(hn::ShiftLeft<6>(whole), w, spots.offset[k]);
  spots.tx[k] = hn::Sub(gx, ix), spots.ty[k] = hn::Sub(gy, iy);
}

/// The field at the first `count` points noted. Finding all places first and then reading all rows
/// lets the processor overlap what would otherwise be one long chain for each point.
HWY_INLINE void read(const Lookup& field, const Spots& spots, int count, Water* out) {
  for (int k = 0; k < count; ++k)
    out[k] = read_rows(field.rows, spots.offset[k], spots.tx[k], spots.ty[k]);
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
