// Rows of cells between separators, with or without a header.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/line_source.hpp"

namespace lilytank {

/// A table whose first row names its columns. Blank lines and lines that begin with '#' are passed
/// over; cells may be in double quotes and have blanks around them.
class Table {
 public:
  /// Reads the header. `lines` must outlive this. Throws InputError if there is none.
  explicit Table(LineSource& lines);

  const std::vector<std::string>& names() const { return names_; }
  char separator() const { return separator_; }
  /// Where a column is, -1 if there is none of this name. Upper and lower case count.
  int find(std::string_view name) const;
  /// Goes to the next row; false at the end. Throws InputError on a wrong count of cells.
  bool next();

  std::string_view cell(int column) const { return cells_[static_cast<std::size_t>(column)]; }
  /// The cell as a number; NaN where it is empty, nan, NA or infinite: trackers write so what they
  /// did not see. Throws InputError on other text.
  double number(int column) const;
  /// A whole number, also written as "3.0"; nothing where the cell is empty or another text.
  std::optional<std::int64_t> whole(int column) const;
  SourcePlace place(int column) const;
  [[noreturn]] void refuse(int column, const std::string& message) const;
  /// "x 'abc'".
  std::string quoted(int column) const;
  int line() const { return lines_->line(); }
  const std::string& file() const { return lines_->file(); }

 private:
  void split(std::string_view line);
  LineSource* lines_;
  std::vector<std::string> names_;
  std::vector<std::string_view> cells_;
  const char* row_ = nullptr;
  char separator_ = ',';
};

/// The separator that a header line seems to use: tab, semicolon, comma or blank.
char separator_of(std::string_view line);
/// Splits a line at a separator (blank: any run of blanks); trims blanks and quotes.
void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells);

}  // namespace lilytank
