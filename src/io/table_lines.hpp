// Lines of a table with lookahead.
#pragma once
#include <deque>
#include <string>
#include <string_view>

#include "io/line_source.hpp"

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

}  // namespace lilytank
