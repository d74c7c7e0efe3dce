// Where the names and rows of a text table are, and how its numbers are written.
#pragma once
#include <optional>

namespace lilytank {

/// Values that are not set are found from the file.
struct TableLayout {
  std::optional<int> header_line;     ///< line of the names, from 1; 0: there are no names
  std::optional<int> first_row;       ///< line of the first row, from 1
  std::optional<bool> decimal_comma;  ///< true: 0,5 is a half; false: a comma is never in a number
};

}  // namespace lilytank
