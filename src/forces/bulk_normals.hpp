// Many standard normals at once, for gusts and kicks: vector code with the bits of the scalar
// definition.
#pragma once
#include <cstdint>

#include "lilytank/random.hpp"

namespace lilytank {

/// Blocks of random bits, and with them pairs of normals, that one call can make.
constexpr int kBulkBlocks = 24;

/// Four normals (float32, |z| < 5.9) from each of kBulkBlocks Philox blocks: block i has the
/// counter of `draw` with index + i (or body + i, if `along_bodies`). Box and Muller on words (0,1)
/// gives z[0][i], z[1][i]; on words (2,3) z[2][i], z[3][i].
void bulk_normals(const Draw& draw, bool along_bodies, float z[4][kBulkBlocks]);

}  // namespace lilytank
