// Refusals of what does not know the file that its input came from.
#pragma once
#include <filesystem>
#include <string>
#include <utility>

#include "lilytank/error.hpp"

namespace lilytank {

/// Whether a message begins with a file that is there, or with `file`.
inline bool names_file(const std::string& message, const std::string& file) {
  std::error_code ignored;
  return message.starts_with(file) ||
         std::filesystem::exists(message.substr(0, message.find(':')), ignored);
}

/// The value of `work`. An InputError of it that names no file is thrown again as one of `file`.
template <class Work>
decltype(auto) refusals_of(const std::string& file, Work&& work) {
  try {
    return std::forward<Work>(work)();
  } catch (const InputError& e) {
    if (names_file(e.what(), file)) throw;
    throw InputError(SourcePlace{file, 0, 0}, e.what());
  }
}

}  // namespace lilytank
