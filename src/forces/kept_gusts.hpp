// The random numbers of a tick's gusts, kept for the steps that share them.
#pragma once
#include <cstddef>
#include <vector>

#include "math/bulk_random.hpp"

namespace lilytank {

/// One slot for each block of kBulkBodies bodies. A slot's content is a function of its key alone,
/// so a result cannot depend on what was kept.
class KeptGusts {
 public:
  /// Without slots, nothing is kept.
  KeptGusts() = default;
  /// Room for `count` numbers of each of `bodies` bodies.
  KeptGusts(int bodies, int count)
      : count_(count),
        slots_(static_cast<std::size_t>((bodies + kBulkBodies - 1) / kBulkBodies)),
        numbers_(slots_.size() * static_cast<std::size_t>(count)) {}

  /// bulk_normals() of an even count: the numbers kept, or drawn into the slot, or into `buffer`
  /// where there is no room.
  const float* normals(const Draw& draw, int count, float* buffer) {
    const std::size_t slot = draw.body / kBulkBodies;
    if (slot >= slots_.size() || count != count_) {
      bulk_normals(draw, count, buffer);
      return buffer;
    }
    float* out = numbers_[slot * static_cast<std::size_t>(count)].of_bodies;
    Key& key = slots_[slot];
    if (key.seed != draw.seed || key.tick != draw.step) {
      bulk_normals(draw, count, out);
      key = {draw.seed, draw.step};
    }
    return out;
  }

 private:
  struct Key {
    std::uint64_t seed = 0;
    std::int64_t tick = -1;
  };
  struct alignas(64) Number {
    float of_bodies[kBulkBodies];
  };

  int count_ = 0;
  std::vector<Key> slots_;
  std::vector<Number> numbers_;
};

}  // namespace lilytank
