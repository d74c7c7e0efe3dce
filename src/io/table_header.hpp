// The lines before the rows of a table: comments, the separator, the names.
#pragma once
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "io/line_source.hpp"
#include "lilytank/table_layout.hpp"

namespace lilytank {

/// Lines as records: a cell in quotes may go over several lines of the file (RFC 4180).
class TableLines {
 public:
  struct Line {
    std::string text;
    int number = 0;  ///< in the file, from 1; of records of several lines, the first
  };
  /// `lines` must outlive this.
  explicit TableLines(LineSource& lines) : lines_(&lines) {}

  /// The next record, valid until the next call; false at the end of the file. Throws InputError
  /// where a quote is never closed.
  bool next(std::string_view& line);
  /// The record after `i` others, or nothing; next() gives it in its turn.
  const Line* ahead(std::size_t i = 0);
  void drop() { ahead_.pop_front(); }
  /// Of the record that next() gave.
  int line() const { return line_; }
  const std::string& file() const { return lines_->file(); }
  /// The separator, once known: quotes count at the begin of cells.
  void set_separator(char separator) { separator_ = separator; }
  /// Lines that begin with '#' or '%' may have quotes that are never closed.
  void set_comments(bool comments) { comments_ = comments; }

 private:
  bool fetch(std::string_view& line);
  LineSource* lines_;
  std::deque<Line> ahead_;
  std::string current_, joined_;
  int line_ = 0;
  char separator_ = 0;
  bool comments_ = true;
};

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
