#include "neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

// Compiled once for each instruction set, with the same result from each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "physics/neighbours.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef LILYTANK_NEIGHBOURS_QUERY
#define LILYTANK_NEIGHBOURS_QUERY
namespace lilytank {
// Bodies in order of cells, and what is asked of them.
struct NeighbourQuery {
  const float *x, *y;  // padded by one vector
  const int* id;
  float distance2;
};
constexpr int kWidest = 16;  // lanes of a vector
}  // namespace lilytank
#endif

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kWidest>;
using Whole = hn::RebindToSigned<Floats>;

// Which of the vector from k on are near (x, y).
HWY_INLINE hn::Mask<Floats> near(const NeighbourQuery& q, float x, float y, int k) {
  const Floats d;
  const auto dx = hn::Sub(hn::LoadU(d, q.x + k), hn::Set(d, x));
  const auto dy = hn::Sub(hn::LoadU(d, q.y + k), hn::Set(d, y));
  return hn::Lt(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Set(d, q.distance2));
}

HWY_INLINE std::uint64_t bits_of(hn::Mask<Floats> mask) {
#if HWY_MAX_BYTES == 64
  return mask.raw;
#else
  std::uint8_t part[8] = {};
  hn::StoreMaskBits(Floats(), mask, part);
  std::uint64_t word = 0;
  std::memcpy(&word, part, sizeof word);
  return word;
#endif
}

// Bits of the bodies near each of up to 64, those beyond the last included.
void all_bits(const NeighbourQuery& q, int bodies, std::uint64_t* bits) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int i = 0; i < bodies; ++i) {
    std::uint64_t sum = 0;
    for (int k = 0; k < bodies; k += lanes) {
      sum |= bits_of(near(q, q.x[i], q.y[i], k)) << k;
    }
    bits[i] = sum;
  }
}

// Appends those of [first, last) that are near (x, y), without body `self`; returns the new end.
// Up to a vector beyond the end may be overwritten.
int* scan(const NeighbourQuery& q, float x, float y, int self, int first, int last, int* out) {
  const Whole w;
  const int lanes = static_cast<int>(hn::Lanes(w));
  for (int k = first; k < last; k += lanes) {
    const auto id = hn::LoadU(w, q.id + k);
    const auto inside = hn::Lt(hn::Iota(w, 0), hn::Set(w, last - k));
    const auto other = hn::And(hn::Ne(id, hn::Set(w, self)), inside);
    const auto take = hn::And(hn::RebindMask(w, near(q, x, y, k)), other);
    hn::StoreU(hn::Compress(id, take), w, out);
    out += hn::CountTrue(w, take);
  }
  return out;
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lilytank {

HWY_EXPORT(all_bits);
HWY_EXPORT(scan);

namespace {
constexpr float kRounding = 3e-6f;  // m, more than float32 can be wrong by in any tank
}

Neighbours::Neighbours(int bodies, double extent)
    : bodies_(bodies), extent_(static_cast<float>(extent)) {
  const auto n = static_cast<std::size_t>(bodies);
  own_x_.assign(n, 0), own_y_.assign(n, 0);
  x_.assign(n + kWidest, 0), y_.assign(n + kWidest, 0), id_.assign(n + kWidest, -1);
  for (int i = 0; i < bodies; ++i) id_[i] = i;
  if (bodies <= kFew) {
    bits_.assign(n, 0);
    return;
  }
  begin_.assign(n + 1, 0), above_.assign(n, 0), cell_.assign(n, 0);
  who_.assign(20 * n + 4 * kWidest, 0);
  start_.reserve(4 * n + 4);
}

int Neighbours::cell_of(float v) const {
  const float k = (v + extent_) * per_cell_;
  return static_cast<int>(std::clamp(k, 0.0f, static_cast<float>(cells_ - 1)));
}

// Counting sort: bodies of a cell, and cells of a row, lie side by side.
void Neighbours::sort_into_cells() {
  const float pitch = static_cast<float>(distance_) + kRounding;
  const int most = static_cast<int>(2 * std::sqrt(static_cast<float>(bodies_)));
  cells_ = std::clamp(static_cast<int>(2 * extent_ / pitch), 1, most);
  per_cell_ = static_cast<float>(cells_) / (2 * extent_);
  start_.assign(static_cast<std::size_t>(cells_ * cells_) + 1, 0);
  for (int i = 0; i < bodies_; ++i) {
    cell_[i] = cell_of(own_y_[i]) * cells_ + cell_of(own_x_[i]);
    ++start_[cell_[i]];
  }
  int sum = 0;
  for (int& s : start_) sum += s, s = sum;  // ends; filling backwards moves them to the starts
  for (int i = bodies_ - 1; i >= 0; --i) {
    const int k = --start_[cell_[i]];
    x_[k] = own_x_[i], y_[k] = own_y_[i], id_[k] = i;
  }
}

void Neighbours::search(std::span<const double> x, std::span<const double> y, double distance) {
  distance_ = distance;
  const bool few = bodies_ <= kFew;
  float *to_x = few ? x_.data() : own_x_.data(), *to_y = few ? y_.data() : own_y_.data();
  for (int i = 0; i < bodies_; ++i)
    to_x[i] = static_cast<float>(x[i]), to_y[i] = static_cast<float>(y[i]);
  if (!few) return search_grid();
  const float reach = static_cast<float>(distance) + kRounding;
  HWY_DYNAMIC_DISPATCH(all_bits)
  ({x_.data(), y_.data(), nullptr, reach * reach}, bodies_, bits_.data());
  const std::uint64_t real = bodies_ < 64 ? (std::uint64_t{1} << bodies_) - 1 : ~std::uint64_t{0};
  for (int i = 0; i < bodies_; ++i) bits_[i] &= real & ~(std::uint64_t{1} << i);
}

void Neighbours::search_grid() {
  sort_into_cells();
  const float reach = static_cast<float>(distance_) + kRounding;
  const NeighbourQuery query{x_.data(), y_.data(), id_.data(), reach * reach};
  const auto scan_cells = HWY_DYNAMIC_DISPATCH(scan);
  int size = 0;
  for (int i = 0; i < bodies_; ++i) {
    begin_[i] = size;
    const int column = cell_[i] % cells_, row = cell_[i] / cells_;
    const int left = std::max(column - 1, 0), right = std::min(column + 1, cells_ - 1);
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, cells_ - 1); ++r) {
      const int first = start_[r * cells_ + left], last = start_[r * cells_ + right + 1];
      if (static_cast<int>(who_.size()) < size + last - first + kWidest)
        who_.resize(2 * who_.size() + static_cast<std::size_t>(last - first));
      int* out = who_.data() + size;
      size += static_cast<int>(scan_cells(query, own_x_[i], own_y_[i], i, first, last, out) - out);
    }
    const auto end = who_.begin() + size;
    std::sort(who_.begin() + begin_[i], end);
    above_[i] = static_cast<int>(std::upper_bound(who_.begin() + begin_[i], end, i) - who_.begin());
  }
  begin_[bodies_] = size;
}

}  // namespace lilytank
#endif
