// Comma-separated tables read strictly: every complaint has a line and a column.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lilytank/error.hpp"

namespace lilytank {

/// Walks over the rows of a table whose first line is known. Cells are not quoted. Where the last
/// column is "checksum", every row's is compared with the row.
class CsvReader {
 public:
  /// `text` must outlive the reader. Throws InputError if the first line is not one of `headers`.
  CsvReader(std::string_view text, std::string file, const std::vector<std::string>& headers);

  /// Which of `headers` the file has.
  std::size_t header() const { return header_; }
  /// Goes to the next row; false at the end. Throws InputError on a wrong count of cells.
  bool next();

  bool empty(std::size_t column) const { return cells_[column].empty(); }
  std::string_view text(std::size_t column) const { return cells_[column]; }
  /// Cell values; throw InputError where a cell is not a finite number, or is outside low .. high.
  double number(std::size_t column) const;
  float float_number(std::size_t column) const;
  std::int64_t whole(std::size_t column, std::int64_t low, std::int64_t high) const;

  SourcePlace place(std::size_t column) const;
  [[noreturn]] void refuse(std::size_t column, const std::string& message) const;

 private:
  void check_row(std::string_view row) const;
  std::string quoted(std::size_t column) const;
  std::string_view text_;
  std::string file_;
  std::vector<std::string> names_;
  std::vector<std::string_view> cells_;
  std::size_t at_ = 0, header_ = 0;
  int line_ = 1;
  const char* row_ = nullptr;
};

/// The text up to its last line end. A last line without one was cut by a kill, or is being
/// written.
std::string_view whole_lines(std::string_view text);

}  // namespace lilytank
