// Rows of cells between separators.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/line_source.hpp"

namespace lilytank {

/// A table of which the first row names the columns, or is numbers and the columns are called "1",
/// "2", ... Blank lines and lines that begin with '#' or '%' are passed over, but a first line that
/// begins with "% " names columns. Cells may have blanks and double quotes around them.
class Table {
 public:
  /// Reads the first row. `lines` must outlive this. Throws InputError if there is none, or a name
  /// is there twice.
  explicit Table(LineSource& lines);
  /// A table whose columns are known; their separator is that of the first row.
  Table(LineSource& lines, std::vector<std::string> names);

  const std::vector<std::string>& names() const { return names_; }
  /// Where a column is, -1 if there is none of this name. Upper and lower case count.
  int find(std::string_view name) const;
  /// Goes to the next row; false at the end. Throws InputError on a wrong count of cells.
  bool next();

  std::string_view cell(int column) const { return cells_[static_cast<std::size_t>(column)]; }
  /// The cell as a number; NaN where it is empty, nan, NA or infinite: so trackers write what they
  /// did not see. Throws InputError on other text.
  double number(int column) const;
  /// A whole number, also written as "3.0"; nothing where the cell is something else.
  std::optional<std::int64_t> whole(int column) const;
  SourcePlace place(int column) const;
  [[noreturn]] void refuse(int column, const std::string& message) const;
  /// "x 'abc'".
  std::string quoted(int column) const;
  int line() const { return lines_->line(); }
  const std::string& file() const { return lines_->file(); }

 private:
  /// The next line that is not passed over; false at the end.
  bool content(std::string_view& line);
  void split(std::string_view line);
  void check_names() const;
  LineSource* lines_;
  std::vector<std::string> names_;
  std::vector<std::string_view> cells_;
  const char* row_ = nullptr;
  char separator_ = ',';
};

/// The separator that a line seems to use: tab, semicolon, comma or blank.
char separator_of(std::string_view line);
/// Splits a line at a separator (blank: any run of blanks); trims blanks and quotes.
void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells);
/// Seconds of a date and time such as "2009-11-01T12:34:56.789" since 1970; nothing if it is not
/// one. Zones are not looked at.
std::optional<double> parse_date(std::string_view text);

}  // namespace lilytank
