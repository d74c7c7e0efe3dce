// Files that are larger than the memory.
#pragma once
#include <new>
#include <stdexcept>
#include <string>

#include "lilytank/error.hpp"

namespace lilytank {

/// What `read` returns. Where there is not enough memory for it, throws InputError with the file.
template <class Read>
auto with_enough_memory(const std::string& file, Read&& read) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  throw InputError({file, 0, 0}, "there is not enough memory for what is in it");
}

}  // namespace lilytank
