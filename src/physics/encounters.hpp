// Pairs of bodies of any worlds that may meet, measured in vector lanes.
#pragma once
#include <cstdint>
#include <vector>

#include "bodies.hpp"
#include "island_block.hpp"

namespace lilytank {

/// What pairs of a world have in common.
struct Surroundings {
  float half = 0, radius = 0, tank = 0;  ///< m: of squares, discs and the tank
  float h = 0;                           ///< s, a slice
};

/// Pairs of one kind, in order of their addition.
class Encounters {
 public:
  /// Which bodies of which world; j = -1: i and the wall.
  struct Pair {
    int world, i, j;
  };
  void clear() { count_ = 0; }
  /// Room for so many pairs.
  void reserve(std::size_t pairs);
  int size() const { return count_; }
  const Pair& operator[](int k) const { return pairs_[static_cast<std::size_t>(k)]; }

  /// Adds bodies as they are at the start of a slice.
  void add(const Bodies& b, const Surroundings& around, Pair pair);
  /// Adds bodies as they are at its end, at rest.
  void add_ends(const Bodies& b, const Surroundings& around, Pair pair);
  /// Calls use(pair) for those between which, on their courses, no more than `spare` (m) stays.
  template <class Use>
  void each_close(PairKind kind, float spare, Use&& use) {
    measure(kind, spare);
    for (int k = 0; k < count_; ++k) {
      if (close_[static_cast<std::size_t>(k)] != 0) use(pairs_[static_cast<std::size_t>(k)]);
    }
  }

  static constexpr int kFields = 20;

 private:
  void measure(PairKind kind, float spare);
  float* room();

  int count_ = 0;
  std::vector<Pair> pairs_;
  std::vector<RowOf<kBlockLanes>> rows_;  // kFields of each kBlockLanes pairs
  std::vector<std::uint8_t> close_;
};

}  // namespace lilytank
