// What a program asks of the heap, counted at malloc.
#pragma once
#include <cstdint>

namespace lilytank::bench {

/// Calls of malloc, calloc, realloc and their aligned kin so far, by anyone in this program.
std::int64_t heap_calls();
/// Bytes that are handed out at the moment.
std::int64_t heap_bytes();

}  // namespace lilytank::bench
