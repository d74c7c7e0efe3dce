// Reads the flow field for one vector of points: included by files that are compiled once for each
// instruction set, with the same bits from each.
#if defined(LILYTANK_FLOW_LOOKUP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LILYTANK_FLOW_LOOKUP_INL
#undef LILYTANK_FLOW_LOOKUP_INL
#else
#define LILYTANK_FLOW_LOOKUP_INL
#endif

#include <hwy/highway.h>

#include "math/bulk_random_inl.hpp"
#include "lilytank/flow_field.hpp"

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

// Four floats (mu_x, mu_y, sigma_x, sigma_y) for each point, summed as (a + ty c) + (tx b + tx ty e)
// from the row of its cell.
#if HWY_MAX_BYTES == 64
HWY_INLINE Water read_rows(const char* rows, const std::int32_t* offset, Float tx, Float ty) {
  const Floats d;
  Float weights[4] = {hn::Set(d, 1.0f), tx, ty, hn::Mul(tx, ty)};
  transpose(weights[0], weights[1], weights[2], weights[3]);
  // Weights of point 4b + j are block b of weights[j]; each goes to a block of its own.
  alignas(64) static constexpr std::int32_t kSpread[4][16] = {
      {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3},
      {4, 4, 4, 4, 5, 5, 5, 5, 6, 6, 6, 6, 7, 7, 7, 7},
      {8, 8, 8, 8, 9, 9, 9, 9, 10, 10, 10, 10, 11, 11, 11, 11},
      {12, 12, 12, 12, 13, 13, 13, 13, 14, 14, 14, 14, 15, 15, 15, 15}};
  Float all[4];
  for (int j = 0; j < 4; ++j) {
    const auto product = [&](int b) {
      const auto row = hn::Load(d, reinterpret_cast<const float*>(rows + offset[4 * b + j]));
      return hn::Mul(row, hn::TableLookupLanes(weights[j], hn::SetTableIndices(d, kSpread[b])));
    };
    const auto halves = [&](Float p, Float q) {
      return hn::Add(hn::ConcatLowerLower(d, q, p), hn::ConcatUpperUpper(d, q, p));
    };
    const Float p = halves(product(0), product(2)), q = halves(product(1), product(3));
    all[j] = hn::Add(hn::OddEvenBlocks(q, p), hn::SwapAdjacentBlocks(hn::OddEvenBlocks(p, q)));
  }
  transpose(all[0], all[1], all[2], all[3]);
  return {all[0], all[1], all[2], all[3]};
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
    const auto wxy = hn::Mul(wx, wy);
    const auto even = hn::Add(hn::Load(four, row), hn::Mul(hn::Load(four, row + 8), wy));
    const auto odd =
        hn::Add(hn::Mul(hn::Load(four, row + 4), wx), hn::Mul(hn::Load(four, row + 12), wxy));
    hn::Store(hn::Add(even, odd), four, out + 4 * i);
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
  const Float ix = hn::ConvertTo(d, hn::ConvertTo(w, hn::Min(gx, most)));
  const Float iy = hn::ConvertTo(d, hn::ConvertTo(w, hn::Min(gy, most)));
  const Float row = hn::Add(hn::Mul(iy, hn::Set(d, static_cast<float>(field.cells))), ix);
  hn::Store(hn::ShiftLeft<6>(hn::ConvertTo(w, row)), w, spots.offset[k]);
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
