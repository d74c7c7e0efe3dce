// Many standard normals at once, for gusts and kicks: vector code with the same bits whatever the
// vectors' width.
#pragma once
#include <cstdint>

#include "lilytank/random.hpp"

namespace lilytank {

/// Philox blocks of one call, and the pairs of normals that each gives.
constexpr int kBulkBlocks = 16;
constexpr int kBulkPairs = 3;

/// kBulkBlocks * kBulkPairs pairs of independent standard normals, float32: pair j of block i is
/// x[j * kBulkBlocks + i] and y[...]. Block i has the counter of `draw` with index + i (or body +
/// i, if `along_bodies`). Its four words w are cut into three lots of 40 bits: lot j takes 24 bits
/// for the length, the upper ones of w[j], and 16 for the direction, the lowest byte of w[j] above
/// byte j of w[3]. Box and Muller; lengths reach 5.9. x and y must be aligned to 64 bytes.
void bulk_normals(const Draw& draw, bool along_bodies, float* x, float* y);

}  // namespace lilytank
