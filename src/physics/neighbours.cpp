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
  const float *own_x, *own_y;  // in order of bodies
  const int *column, *row;     // cells of bodies
  const int* start;            // where cells begin
  int cells;
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

// Appends those of [first, last) that are near (x, y) and have numbers from `from` on; returns the
// new end. Up to a vector beyond the end may be overwritten.
int* scan(const NeighbourQuery& q, float x, float y, int from, int first, int last, int* out) {
  const Whole w;
  const int lanes = static_cast<int>(hn::Lanes(w));
  for (int k = first; k < last; k += lanes) {
    const auto id = hn::LoadU(w, q.id + k);
    const auto inside = hn::Lt(hn::Iota(w, 0), hn::Set(w, last - k));
    const auto other = hn::And(hn::Gt(id, hn::Set(w, from - 1)), inside);
    const auto take = hn::And(hn::RebindMask(w, near(q, x, y, k)), other);
    hn::StoreU(hn::Compress(id, take), w, out);
    out += hn::CountTrue(w, take);
  }
  return out;
}

// Bodies with numbers from `from` on near body i, ascending; returns their end, or null if fewer
// than `room` may remain behind `out`.
int* scan_cells(const NeighbourQuery& q, int i, int from, int* out, const int* room) {
  const int left = std::max(q.column[i] - 1, 0), right = std::min(q.column[i] + 1, q.cells - 1);
  const int low = std::max(q.row[i] - 1, 0), high = std::min(q.row[i] + 1, q.cells - 1);
  int* const begin = out;
  for (int r = low; r <= high; ++r) {
    const int first = q.start[r * q.cells + left], last = q.start[r * q.cells + right + 1];
    if (room - out < last - first + kWidest) return nullptr;
    out = scan(q, q.own_x[i], q.own_y[i], from, first, last, out);
  }
  std::sort(begin, out);
  return out;
}

// The bodies above each: body i's are who[begin[i]] .. who[begin[i + 1]]. False if there is no
// room.
bool scan_all(const NeighbourQuery& q, int bodies, int* begin, int* who, const int* room) {
  int* out = who;
  for (int i = 0; i < bodies; ++i) {
    begin[i] = static_cast<int>(out - who);
    out = scan_cells(q, i, i + 1, out, room);
    if (out == nullptr) return false;
  }
  begin[bodies] = static_cast<int>(out - who);
  return true;
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lilytank {

HWY_EXPORT(all_bits);
HWY_EXPORT(scan_all);
HWY_EXPORT(scan_cells);

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
  begin_.assign(n + 1, 0), column_.assign(n, 0), row_.assign(n, 0);
  who_.assign(24 * n + 4 * kWidest, 0), found_.assign(n + kWidest, 0);
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
    column_[i] = cell_of(own_x_[i]), row_[i] = cell_of(own_y_[i]);
    ++start_[row_[i] * cells_ + column_[i]];
  }
  int sum = 0;
  for (int& s : start_) sum += s, s = sum;  // ends; filling backwards moves them to the starts
  for (int i = bodies_ - 1; i >= 0; --i) {
    const int k = --start_[row_[i] * cells_ + column_[i]];
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
  HWY_DYNAMIC_DISPATCH(all_bits)(query(), bodies_, bits_.data());
  const std::uint64_t real = bodies_ < 64 ? (std::uint64_t{1} << bodies_) - 1 : ~std::uint64_t{0};
  for (int i = 0; i < bodies_; ++i) bits_[i] &= real & ~(std::uint64_t{1} << i);
}

NeighbourQuery Neighbours::query() const {
  const float reach = static_cast<float>(distance_) + kRounding;
  return {x_.data(),     y_.data(),      id_.data(),  reach * reach, own_x_.data(),
          own_y_.data(), column_.data(), row_.data(), start_.data(), cells_};
}

std::span<const int> Neighbours::scan_around(int i) {
  for (;;) {
    int* const end = HWY_DYNAMIC_DISPATCH(scan_cells)(query(), i, 0, found_.data(),
                                                      found_.data() + found_.size());
    if (end != nullptr) {
      const int* const others = std::remove(found_.data(), end, i);
      return {found_.data(), static_cast<std::size_t>(others - found_.data())};
    }
    found_.resize(2 * found_.size());
  }
}

void Neighbours::search_grid() {
  sort_into_cells();
  while (!HWY_DYNAMIC_DISPATCH(scan_all)(query(), bodies_, begin_.data(), who_.data(),
                                         who_.data() + who_.size()))
    who_.resize(2 * who_.size());
}

}  // namespace lilytank
#endif
