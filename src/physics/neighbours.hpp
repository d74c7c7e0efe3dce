// Which bodies are near which: one search a step, for latches and contacts alike.
#pragma once
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace lilytank {

struct NeighbourQuery;

/// For every body, the bodies whose centres are nearer than a distance: bits for few bodies, lists
/// from a uniform grid for many, with the same result. Float32 and vector code; a pair that misses
/// the distance by a few micrometres may be listed too, so users test what they need for
/// themselves.
class Neighbours {
 public:
  static constexpr int kFew = 64;  ///< up to so many bodies the grid does not pay

  /// For `bodies` bodies within a square of half-width `extent` (m; those outside count as at its
  /// rim).
  Neighbours(int bodies, double extent);

  /// Takes the centres of a moment (m, one for each body).
  void search(std::span<const double> x, std::span<const double> y, double distance);
  /// Calls use(j) for the bodies j > i near body i, ascending.
  template <class Use>
  void above(int i, Use&& use) const {
    if (bodies_ <= kFew)
      each_bit(bits_[i] >> i >> 1 << i << 1, use);
    else
      for (int k = begin_[i]; k < begin_[i + 1]; ++k) use(who_[k]);
  }
  /// The same for all bodies near body i, without i itself; not to be called from `use`.
  template <class Use>
  void around(int i, Use&& use) {
    if (bodies_ <= kFew)
      each_bit(bits_[i], use);
    else
      for (const int j : scan_around(i)) use(j);
  }
  /// The distance of the last search, m.
  double distance() const { return distance_; }

 private:
  template <class Use>
  static void each_bit(std::uint64_t bits, Use&& use) {
    for (; bits != 0; bits &= bits - 1) use(std::countr_zero(bits));
  }
  void search_grid();
  std::span<const int> scan_around(int i);
  NeighbourQuery query() const;
  void sort_into_cells();
  int cell_of(float v) const;

  int bodies_;
  float extent_;
  double distance_ = 0;
  int cells_ = 1;                     // per side
  float per_cell_ = 0;                // cells per metre
  std::vector<float> own_x_, own_y_;  // in order of bodies
  std::vector<float> x_, y_;          // in order of cells, padded by one vector
  std::vector<int> id_;               // the bodies in that order
  std::vector<int> column_, row_;     // cell of each body
  std::vector<int> start_;            // where each cell begins in the order of cells
  std::vector<int> begin_, who_;      // above body i: who_[begin_[i], begin_[i + 1])
  std::vector<int> found_;            // of scan_around()
  std::vector<std::uint64_t> bits_;
};

}  // namespace lilytank
