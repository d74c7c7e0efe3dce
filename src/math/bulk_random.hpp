// Random numbers for many bodies at once: vector code with the same bits whatever the vectors'
// width.
#pragma once
#include <cstdint>

#include "lilytank/random.hpp"

namespace lilytank {

/// Bodies that one call serves.
constexpr int kBulkBodies = 16;

/// `count` standard normals, float32, for each of the bodies draw.body + 0 .. 15: number k of body
/// i is out[16 k + i]; there must be room for an even count. All are independent. Numbers 6b .. 6b
/// + 5 are three pairs from the Philox block with index draw.index + b, whose words w are cut into
/// three lots of 42 bits. Lot j takes 24 bits for the length, the upper ones of w[j], and 18 for
/// the direction: byte j of w[3] above the lowest byte of w[j] say where in the quarter turn about
/// 0, bit 28 - j of w[3] swaps the two numbers, and bit 31 - j is their sign. Box and Muller;
/// lengths reach 5.9.
/// `out` must be aligned to 64 bytes.
void bulk_normals(const Draw& draw, int count, float* out);

/// The first word of random_bits() for each of the bodies draw.body + 0 .. 15; `out` must be
/// aligned to 64 bytes.
void bulk_words(const Draw& draw, std::uint32_t* out);

}  // namespace lilytank
