// Which bodies are near which: one search a step, for latches and contacts alike.
#pragma once
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace lilytank {

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
  /// Calls use(j) for the bodies j near body i, ascending, without i.
  template <class Use>
  void around(int i, Use&& use) const {
    if (bodies_ <= kFew)
      each_bit(bits_[i], use);
    else
      for (int k = begin_[i]; k < begin_[i + 1]; ++k) use(who_[k]);
  }
  /// The same for the bodies j > i.
  template <class Use>
  void above(int i, Use&& use) const {
    if (bodies_ <= kFew)
      each_bit(bits_[i] >> i >> 1 << i << 1, use);
    else
      for (int k = above_[i]; k < begin_[i + 1]; ++k) use(who_[k]);
  }
  /// The distance of the last search, m.
  double distance() const { return distance_; }

 private:
  template <class Use>
  static void each_bit(std::uint64_t bits, Use&& use) {
    for (; bits != 0; bits &= bits - 1) use(std::countr_zero(bits));
  }
  void search_grid();
  void sort_into_cells();
  int cell_of(float v) const;

  int bodies_;
  float extent_;
  double distance_ = 0;
  int cells_ = 1;                         // per side
  float per_cell_ = 0;                    // cells per metre
  std::vector<float> own_x_, own_y_;      // in order of bodies
  std::vector<float> x_, y_;              // in order of cells, padded by one vector
  std::vector<int> id_;                   // the bodies in that order
  std::vector<int> cell_, start_;         // cell of each body; where each cell starts in that order
  std::vector<int> begin_, above_, who_;  // body i: [begin_[i], begin_[i + 1]); from above_[i], > i
  std::vector<std::uint64_t> bits_;
};

}  // namespace lilytank
