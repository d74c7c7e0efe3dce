// The lines before the rows of a table: comments, the separator, the names.
#pragma once
#include <string>
#include <vector>

#include "io/table_lines.hpp"
#include "lilytank/table_layout.hpp"

namespace lilytank {

struct TableHeader {
  std::vector<std::string> names;
  std::string text;  ///< the line of the names as the file has it; empty if there is none
  int line = 1;      ///< its number
  char separator = ' ';
  bool in_comment =
      false;  ///< the names stand in a comment: columns may be called "1", "2", ... too
};

/// Takes the lines before the first row. Names are in the first line that is neither blank nor a
/// comment ('#', '%'); where that line holds only numbers, in the comment above it (if it has as
/// many cells and no number), or else they are "1", "2", ... Read as well: Excel's "sep=;", the
/// four lines of names of TrackMate, the three or four of DeepLabCut, of which the columns are "x",
/// "y", "likelihood", with the body part before them if there are several ("nose_x"). Throws
/// InputError: no table, control characters in names, no such line.
TableHeader read_table_header(TableLines& lines, const TableLayout& layout);

}  // namespace lilytank
