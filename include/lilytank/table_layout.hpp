// Where the names and rows of a text table are, and how its numbers are written.
#pragma once
#include <optional>

namespace lilytank {

/// Values that are not set are found from the file.
struct TableLayout {
  /// Line of the names, from 1; 0: there are no names.
  std::optional<int> header_line;
  /// Line of the first row, from 1.
  std::optional<int> first_row;
  /// True: 0,5 is a half; false: a comma is never in a number.
  std::optional<bool> decimal_comma;
};

}  // namespace lilytank
