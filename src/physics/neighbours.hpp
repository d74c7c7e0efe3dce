// Which bodies are near which: one search a step, for latches and contacts alike.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace lilytank {

struct NeighbourQuery;

/// For every body, the bodies with centres nearer than a distance. Lists are found on a
/// uniform grid, for a distance that is larger by a margin, and serve all searches until bodies
/// have moved by that margin; every pair is tested anew, so no result depends on the age
/// of a list. Float32 and vector code; a pair that misses the distance by a few micrometres may be
/// reported too, so users test what they need for themselves.
class Neighbours {
 public:
  /// For `bodies` bodies within a square of half-width `extent` (m; those outside count as at its
  /// rim).
  Neighbours(int bodies, double extent);

  /// Takes the centres of a moment (m, one for each body).
  void search(const float* x, const float* y, double distance);
  /// Calls use(j) for the bodies j > i near body i, ascending.
  template <class Use>
  void above(int i, Use&& use) const {
    each_listed(i, above_[i], use);
  }
  /// The same for all bodies near body i, without i itself.
  template <class Use>
  void around(int i, Use&& use) const {
    each_listed(i, begin_[i], use);
  }
  /// The distance of the last search, m.
  double distance() const { return distance_; }

 private:
  // Those listed for body i from place k on that are near it now.
  template <class Use>
  void each_listed(int i, int k, Use& use) const {
    const float x = x_[i], y = y_[i];
    for (; k < begin_[i + 1]; ++k) {
      const int j = who_[k];
      const float dx = x_[j] - x, dy = y_[j] - y;
      if (dx * dx + dy * dy < reach2_) use(j);
    }
  }
  bool lists_serve() const;
  void make_lists();
  NeighbourQuery query() const;
  void sort_into_cells();
  int cell_of(float v) const;

  int bodies_;
  float extent_;
  double distance_ = 0;
  float reach2_ = 0;          // m^2, of the last search, rounding allowed for
  std::vector<float> x_, y_;  // in order of bodies, padded by one vector
  // Lists, and the places for which they were made.
  float listed_ = -1;                     // m, distance of the lists; negative: there are none
  std::vector<float> then_x_, then_y_;    // in order of bodies
  std::vector<int> begin_, who_, above_;  // near body i: who_[begin_[i], begin_[i + 1]), ascending;
                                          // above_[i]: where those above i begin
  int cells_ = 1;                         // per side
  float per_cell_ = 0;                    // cells per metre
  std::vector<float> cell_x_, cell_y_;    // in order of cells, padded by one vector
  std::vector<int> id_;                   // the bodies in that order
  std::vector<int> column_, row_;         // cell of each body
  std::vector<int> start_;                // where each cell begins in the order of cells
};

}  // namespace lilytank
