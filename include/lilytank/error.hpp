// What is wrong with a user's input, in one line that says where and what would be right.
#pragma once
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace lilytank {

/// A place in a user's file; line and column count from 1, 0 means unknown.
struct SourcePlace {
  std::string file;
  int line = 0;
  int column = 0;
  /// "tank.toml:14:3", or as much of it as is known.
  std::string text() const;
};

/// Input that cannot be used. The program prints what() as one line and exits with 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
  InputError(const SourcePlace& place, const std::string& message)
      : std::runtime_error(place.text() + ": " + message) {}
};

/// The candidate nearest to `word` by edits (insert, delete, replace, swap), or empty if none is
/// within a third of the longer one's length.
std::string nearest_word(std::string_view word, std::span<const std::string> candidates);
/// " - did you mean 'K_F'?" or, where nothing is near, the empty string.
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

}  // namespace lilytank
