// Random numbers for many bodies at once: vector code with the same bits whatever the vectors'
// width.
#pragma once
#include <cstdint>

#include "lilytank/random.hpp"

namespace lilytank {

/// Bodies that one call serves.
constexpr int kBulkBodies = 16;

/// `count` standard normals, float32, for each of the bodies draw.body + 0 .. 15: number k of body
/// i is out[16 k + i]; there must be room for an even count. All are independent. Numbers 8b .. 8b
/// + 7 are four pairs from the Philox block with index draw.index + b, one from each word. Box and
/// Muller: the upper 19 bits are the length, bit 12 the sign of both numbers, bit 11 swaps them,
/// and the lower 11 say where in the quarter turn about 0. Lengths reach 5.27; the law's
/// distribution function differs from a normal one's by 2e-8 at most, the fourth moment by 1e-5 of
/// it. `out` must be aligned to 64 bytes.
void bulk_normals(const Draw& draw, int count, float* out);

/// The first word of random_bits() for each of the bodies draw.body + 0 .. 15; `out` must be
/// aligned to 64 bytes.
void bulk_words(const Draw& draw, std::uint32_t* out);

}  // namespace lilytank
