// The state of a search as lines "key value value ...", read back exactly.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lilytank/error.hpp"

namespace lilytank {

class StateWriter {
 public:
  /// `kind`: which search.
  explicit StateWriter(std::string_view kind);
  void word(std::string_view key, std::string_view value);
  void whole(std::string_view key, std::int64_t value);
  void number(std::string_view key, double value);
  void wholes(std::string_view key, std::span<const std::int64_t> values);
  void numbers(std::string_view key, std::span<const double> values);
  /// All lines and a hash of them. The writer is used up.
  std::string finish();

 private:
  std::string text_;
};

/// Reads what StateWriter wrote, line by line in the same order. All functions throw InputError at
/// the line if it is not what is expected.
class StateReader {
 public:
  StateReader(std::string_view text, std::string file);
  const std::string& kind() const { return kind_; }
  std::string word(std::string_view key);
  std::int64_t whole(std::string_view key, std::int64_t low, std::int64_t high);
  double number(std::string_view key);
  std::vector<std::int64_t> wholes(std::string_view key);
  /// As many as there are, or just `count`.
  std::vector<double> numbers(std::string_view key);
  std::vector<double> numbers(std::string_view key, std::size_t count);
  /// All lines are read.
  void end();
  [[noreturn]] void refuse(const std::string& message) const;

 private:
  std::vector<std::string_view> values(std::string_view key);
  std::string_view next_line();
  std::string_view rest_;
  std::string file_, kind_;
  int line_ = 0;
};

}  // namespace lilytank
