// Errors in a user's input: one line that names the place, the value and the nearest valid word;
// and the end of a job by a stop signal.
#pragma once
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace lilytank {

/// A place in a user's file. Lines and columns count from 1; 0 means unknown.
struct SourcePlace {
  std::string file;  ///< path as the user gave it
  int line = 0;      ///< from 1; 0: unknown
  int column = 0;    ///< from 1; 0: unknown
  /// "tank.toml:14:3"; "tank.toml:14" without a column, "tank.toml" without a line.
  std::string text() const;
};

/// Input that cannot be used. Readers of files and functions that check a user's settings throw it;
/// misuse of the library by its caller is std::invalid_argument. The program prints what() as one
/// line and exits with 2.
class InputError : public std::runtime_error {
 public:
  /// An error without a place, for values that no file holds.
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
  /// what() is "file:line:column: message".
  InputError(const SourcePlace& place, const std::string& message)
      : std::runtime_error(place.text() + ": " + message) {}
};

/// Thrown where a stop signal ended a job early. Finished work is kept: the same call, and the same
/// command, resumes it. The program prints what() as one line and exits with 3.
class Stopped : public std::runtime_error {
 public:
  explicit Stopped(const std::string& message =
                       "stopped; finished work is kept, and the same command resumes it")
      : std::runtime_error(message) {}
};

/// The candidate with the least edit distance to `word` (insert, delete, replace, swap of
/// neighbours: Damerau and Levenshtein); the first of equal ones. Empty if none is within a third
/// of the longer word's length.
std::string nearest_word(std::string_view word, std::span<const std::string> candidates);

/// " - did you mean 'K_F'?", to append to a message. Empty if no candidate is near.
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

}  // namespace lilytank
