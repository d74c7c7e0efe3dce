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
  /// Whether all points within `reach` cells of these (in cells) lie between the outermost cell
  /// centres of a bilinear field.
  HWY_INLINE bool surrounds(Float gx, Float gy, float reach) const {
    const Floats d;
    const Float first = hn::Set(d, reach), last = hn::Set(d, static_cast<float>(cells - 1) - reach);
    const Float least = hn::Min(gx, gy), most = hn::Max(gx, gy);
    return !nearest && hn::AllTrue(d, hn::And(hn::Ge(least, first), hn::Lt(most, last)));
  }
};

/// Points to be read, up to kMostPoints for each lane: where a point's row begins (bytes), and its
/// place between cell centres.
constexpr int kMostPoints = 24;
struct Spots {
  alignas(64) std::int32_t offset[kMostPoints][kBulkBodies];
  alignas(64) float tx[kMostPoints][kBulkBodies], ty[kMostPoints][kBulkBodies];
};

// Four floats (mu_x, mu_y, sigma_x, sigma_y) for each point, (a + ty c) + tx (b + ty e) from the
// row of its cell.
#if HWY_MAX_BYTES >= 32
// Wider vectors would need more shuffles.
using Eight = hn::CappedTag<float, 8>;
using EightFloats = hn::Vec<Eight>;

// In-block 4 x 4 transposition: lane 4b + i of vector j goes to lane 4b + j of vector i.
HWY_INLINE void transpose(EightFloats& a, EightFloats& b, EightFloats& c, EightFloats& e) {
  const Eight d;
  const hn::RepartitionToWide<Eight> w;
  const auto wide = [&](EightFloats v) { return hn::BitCast(w, v); };
  const auto l0 = wide(hn::InterleaveLower(d, a, b)), u0 = wide(hn::InterleaveUpper(d, a, b));
  const auto l1 = wide(hn::InterleaveLower(d, c, e)), u1 = wide(hn::InterleaveUpper(d, c, e));
  a = hn::BitCast(d, hn::InterleaveLower(w, l0, l1));
  b = hn::BitCast(d, hn::InterleaveUpper(w, l0, l1));
  c = hn::BitCast(d, hn::InterleaveLower(w, u0, u1));
  e = hn::BitCast(d, hn::InterleaveUpper(w, u0, u1));
}

// Points j and 4 + j, one in each block of the result.
template <int j>
HWY_INLINE EightFloats read_two(const char* rows, const std::int32_t* offset, EightFloats tx,
                                const float* ty) {
  const Eight d;
  // [a b] + ty [c e] of a point.
  const auto along_y = [&](int p) {
    const float* row = reinterpret_cast<const float*>(rows + offset[p]);
    return hn::Add(hn::Load(d, row), hn::Mul(hn::Load(d, row + 8), hn::Set(d, ty[p])));
  };
  const auto one = along_y(j), two = along_y(j + 4);
  const auto even = hn::ConcatLowerLower(d, two, one), odd = hn::ConcatUpperUpper(d, two, one);
  return hn::Add(even, hn::Mul(odd, hn::Broadcast<j>(tx)));
}

struct EightWaters {
  EightFloats v[4];
};
HWY_INLINE EightWaters read_eight(const char* rows, const std::int32_t* offset, const float* tx,
                                  const float* ty) {
  const auto x = hn::Load(Eight(), tx);
  EightWaters u{{read_two<0>(rows, offset, x, ty), read_two<1>(rows, offset, x, ty),
                 read_two<2>(rows, offset, x, ty), read_two<3>(rows, offset, x, ty)}};
  transpose(u.v[0], u.v[1], u.v[2], u.v[3]);
  return u;
}

HWY_INLINE Water read_rows(const char* rows, const std::int32_t* offset, const float* tx,
                           const float* ty) {
  const EightWaters u = read_eight(rows, offset, tx, ty);
#if HWY_MAX_BYTES == 32
  return {u.v[0], u.v[1], u.v[2], u.v[3]};
#else
  const EightWaters w = read_eight(rows, offset + 8, tx + 8, ty + 8);
  const auto both = [&](int k) { return hn::Combine(Floats(), w.v[k], u.v[k]); };
  return {both(0), both(1), both(2), both(3)};
#endif
}
#else
HWY_INLINE Water read_rows(const char* rows, const std::int32_t* offset, const float* tx,
                           const float* ty) {
  const Floats d;
  const hn::CappedTag<float, 4> four;
  alignas(64) float out[4 * kBulkBodies];
  for (int i = 0; i < static_cast<int>(hn::Lanes(d)); ++i) {
    const float* row = reinterpret_cast<const float*>(rows + offset[i]);
    const auto wx = hn::Set(four, tx[i]), wy = hn::Set(four, ty[i]);
    const auto low = hn::Add(hn::Load(four, row), hn::Mul(hn::Load(four, row + 8), wy));
    const auto high = hn::Add(hn::Load(four, row + 4), hn::Mul(hn::Load(four, row + 12), wy));
    hn::Store(hn::Add(low, hn::Mul(high, wx)), four, out + 4 * i);
  }
  Water u;
  hn::LoadInterleaved4(d, out, u.mu_x, u.mu_y, u.sigma_x, u.sigma_y);
  return u;
}
#endif

/// Notes point k, given in cells. `kInside`: all lanes' points are known to lie between the
/// outermost cell centres of a bilinear field.
template <bool kInside = false>
HWY_INLINE void locate(const Lookup& field, Float gx, Float gy, int k, Spots& spots) {
  const Floats d;
  const Whole w;
  Float x = gx, y = gy;
  if (!kInside) {
    const Float last = hn::Set(d, static_cast<float>(field.cells - 1));
    const Float most = hn::Set(d, static_cast<float>(field.cells - 2));
    gx = hn::Min(hn::Max(gx, hn::Zero(d)), last), gy = hn::Min(hn::Max(gy, hn::Zero(d)), last);
    if (field.nearest) {
      const Float half = hn::Set(d, 0.5f);
      gx = hn::ConvertTo(d, hn::ConvertTo(w, hn::Add(gx, half)));
      gy = hn::ConvertTo(d, hn::ConvertTo(w, hn::Add(gy, half)));
    }
    x = hn::Min(gx, most), y = hn::Min(gy, most);
  }
  const Float ix = hn::Floor(x), iy = hn::Floor(y);
  const Float row = hn::Add(hn::Mul(iy, hn::Set(d, static_cast<float>(field.cells))), ix);
  // Whole numbers below 2^23 are the low bits of their sum with it: rounding to integers would look
  // after overflows as well.
  const Float unit = hn::Set(d, 8388608.0f);
  const auto whole = hn::Sub(hn::BitCast(w, hn::Add(row, unit)), hn::BitCast(w, unit));
  hn::Store(hn::ShiftLeft<6>(whole), w, spots.offset[k]);
  hn::Store(hn::Sub(gx, ix), d, spots.tx[k]), hn::Store(hn::Sub(gy, iy), d, spots.ty[k]);
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
