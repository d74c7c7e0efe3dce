#include "neighbours.hpp"

#include <algorithm>
#include <cmath>

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
  float reach2;
  const float *then_x, *then_y;  // in order of bodies
  const int *column, *row;       // cells of bodies
  const int* start;              // where cells begin
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
HWY_INLINE hn::Mask<Floats> near(const float* xs, const float* ys, int k, float x, float y,
                                 float reach2) {
  const Floats d;
  const auto dx = hn::Sub(hn::LoadU(d, xs + k), hn::Set(d, x));
  const auto dy = hn::Sub(hn::LoadU(d, ys + k), hn::Set(d, y));
  return hn::Lt(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Set(d, reach2));
}

// Appends those of [first, last) that are near body i, without i itself; returns the new end. Up to
// a vector beyond the end may be overwritten. One vector is looked at even of an empty range:
// whether there are any cannot be foretold, whether there are more than a vector can.
int* scan(const NeighbourQuery& q, int i, int first, int last, int* out) {
  const Whole w;
  const int lanes = static_cast<int>(hn::Lanes(w));
  const float x = q.then_x[i], y = q.then_y[i];
  int k = first;
  do {
    const auto id = hn::LoadU(w, q.id + k);
    const auto inside = hn::Lt(hn::Iota(w, 0), hn::Set(w, last - k));
    const auto other = hn::AndNot(hn::Eq(id, hn::Set(w, i)), inside);
    const auto take = hn::And(hn::RebindMask(w, near(q.x, q.y, k, x, y, q.reach2)), other);
    hn::StoreU(hn::Compress(id, take), w, out);
    out += hn::CountTrue(w, take);
    k += lanes;
  } while (k < last);
  return out;
}

// Bodies near body i, ascending; returns their end, or null if there may be no room before `room`.
int* scan_cells(const NeighbourQuery& q, int i, int* out, const int* room) {
  const int left = std::max(q.column[i] - 1, 0), right = std::min(q.column[i] + 1, q.cells - 1);
  const int low = std::max(q.row[i] - 1, 0), high = std::min(q.row[i] + 1, q.cells - 1);
  int* const begin = out;
  for (int r = low; r <= high; ++r) {
    const int first = q.start[r * q.cells + left], last = q.start[r * q.cells + right + 1];
    if (room - out < last - first + kWidest) return nullptr;
    out = scan(q, i, first, last, out);
  }
  std::sort(begin, out);
  return out;
}

// The bodies near each: body i's are who[begin[i]] .. who[begin[i + 1]], from above[i] on those
// above it. False if there is no room.
bool scan_all(const NeighbourQuery& q, int bodies, int* begin, int* above, int* who,
              const int* room) {
  int* out = who;
  for (int i = 0; i < bodies; ++i) {
    int* const first = out;
    begin[i] = static_cast<int>(first - who);
    out = scan_cells(q, i, out, room);
    if (out == nullptr) return false;
    above[i] = static_cast<int>(std::upper_bound(first, out, i) - who);
  }
  begin[bodies] = static_cast<int>(out - who);
  return true;
}

// The square of the longest way from (then_x, then_y) to (x, y), m^2.
float longest_way2(const float* x, const float* y, const float* then_x, const float* then_y,
                   int bodies) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  auto most = hn::Zero(d);
  for (int k = 0; k < bodies; k += lanes) {
    const auto dx = hn::Sub(hn::LoadU(d, x + k), hn::LoadU(d, then_x + k));
    const auto dy = hn::Sub(hn::LoadU(d, y + k), hn::LoadU(d, then_y + k));
    most = hn::Max(most, hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)));
  }
  return hn::GetLane(hn::MaxOfLanes(d, most));
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lilytank {

HWY_EXPORT(scan_all);
HWY_EXPORT(longest_way2);

namespace {
constexpr float kRounding = 3e-6f;  // m, more than float32 can be wrong by in any tank
constexpr float kMargin = 35e-3f;   // m, lists are made for so much more than is asked: larger, and
                                    // they are longer; smaller, and they serve for fewer steps
}  // namespace

Neighbours::Neighbours(int bodies, double extent)
    : bodies_(bodies), extent_(static_cast<float>(extent)) {
  const auto n = static_cast<std::size_t>(bodies);
  x_.assign(n + kWidest, 0), y_.assign(n + kWidest, 0);
  then_x_ = cell_x_ = x_, then_y_ = cell_y_ = y_, id_.assign(n + kWidest, -1);
  begin_.assign(n + 1, 0), above_.assign(n, 0), column_.assign(n, 0), row_.assign(n, 0);
  who_.assign(48 * n + 4 * kWidest, 0);  // enough for packed modules
  start_.reserve(4 * n + 4);
}

int Neighbours::cell_of(float v) const {
  const float k = (v + extent_) * per_cell_;
  return static_cast<int>(std::clamp(k, 0.0f, static_cast<float>(cells_ - 1)));
}

// Counting sort: bodies of a cell, and cells of a row, lie side by side.
void Neighbours::sort_into_cells() {
  const int most = static_cast<int>(2 * std::sqrt(static_cast<float>(bodies_)));
  cells_ = std::clamp(static_cast<int>(2 * extent_ / (listed_ + kRounding)), 1, most);
  per_cell_ = static_cast<float>(cells_) / (2 * extent_);
  start_.assign(static_cast<std::size_t>(cells_ * cells_) + 1, 0);
  for (int i = 0; i < bodies_; ++i) {
    column_[i] = cell_of(then_x_[i]), row_[i] = cell_of(then_y_[i]);
    ++start_[row_[i] * cells_ + column_[i]];
  }
  int sum = 0;
  for (int& s : start_) sum += s, s = sum;  // ends; filling backwards moves them to the starts
  for (int i = bodies_ - 1; i >= 0; --i) {
    const int k = --start_[row_[i] * cells_ + column_[i]];
    cell_x_[k] = then_x_[i], cell_y_[k] = then_y_[i], id_[k] = i;
  }
}

void Neighbours::search(const float* x, const float* y, double distance) {
  distance_ = distance;
  const float reach = static_cast<float>(distance) + kRounding;
  reach2_ = reach * reach;
  std::copy(x, x + bodies_, x_.begin()), std::copy(y, y + bodies_, y_.begin());
  if (!lists_serve()) make_lists();
}

// True if no two bodies can have come within the distance that is asked since the lists were made.
bool Neighbours::lists_serve() const {
  const float spare = 0.5f * (listed_ - static_cast<float>(distance_)) - kRounding;
  if (!(spare > 0)) return false;
  return HWY_DYNAMIC_DISPATCH(longest_way2)(x_.data(), y_.data(), then_x_.data(), then_y_.data(),
                                            bodies_) <= spare * spare;
}

NeighbourQuery Neighbours::query() const {
  const float reach = listed_ + kRounding;
  return {cell_x_.data(), cell_y_.data(), id_.data(),  reach * reach, then_x_.data(),
          then_y_.data(), column_.data(), row_.data(), start_.data(), cells_};
}

void Neighbours::make_lists() {
  listed_ = static_cast<float>(distance_) + kMargin;
  then_x_ = x_, then_y_ = y_;
  sort_into_cells();
  while (!HWY_DYNAMIC_DISPATCH(scan_all)(query(), bodies_, begin_.data(), above_.data(),
                                         who_.data(), who_.data() + who_.size()))
    who_.resize(2 * who_.size());
}

}  // namespace lilytank
#endif
