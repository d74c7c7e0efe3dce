// Rows of cells between separators: the one reader of recordings, point bodies, flow grids and
// poses.
#pragma once
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/cells.hpp"
#include "io/table_header.hpp"

namespace lilytank {

/// A table as read_table_header() finds it. Of the lines below the names, blank ones and rows of
/// empty cells are passed over; a line that begins with '#' or '%' is a row if it has as many cells
/// as the table, else it is passed over and counted. Cells follow RFC 4180; rows may have empty
/// cells more than there are names.
class Table {
 public:
  /// Reads the lines before the rows. `lines` must outlive this. Throws InputError.
  explicit Table(LineSource& lines, const TableLayout& layout = {});

  const std::vector<std::string>& names() const { return header_.names; }
  /// The line of names as the file has it; empty if there is none.
  const std::string& header() const { return header_.text; }
  int header_line() const { return header_.line; }
  /// Calls the columns otherwise than the file does.
  void rename(std::vector<std::string> names);
  /// Where a column is, -1 if there is none of this name. Upper and lower case count. Of a repeated
  /// name it is the first column; reading a cell of it throws InputError where the others differ.
  int find(std::string_view name) const;

  /// Where the columns of these names are, in any order; others are refused, but for those without
  /// a name. `what` is the kind of the table: "a flow grid". Throws InputError.
  std::vector<int> fixed_columns(const std::vector<std::string>& wanted,
                                 const std::string& what) const;

  /// Goes to the next row; false at the end. Throws InputError on a wrong count of cells.
  bool next();
  /// Rows of empty cells between the last row and this one: frames in which nothing was seen, where
  /// a row is a frame.
  std::int64_t empty_rows_before() const { return empty_rows_; }
  /// Lines taken for comments so far, below the names.
  std::int64_t comment_lines() const { return comment_lines_; }

  std::string_view cell(int column) const {
    if (!twins_.empty()) check_twins(column);
    return cells_[column];
  }
  /// Whether the cell is empty or a word for "not seen".
  bool not_seen(int column) const { return is_not_seen(cell(column)); }
  /// The cell with a decimal point where it has a decimal comma; valid until the next call.
  std::string_view plain(int column) const;
  /// The cell as a number; NaN where it is a word for "not seen". Throws InputError on other text.
  double number(int column) const;
  /// The same, but words for "not seen" are refused as well.
  double finite(int column) const;
  /// A whole number, also written as "3.0"; nothing where the cell is something else.
  std::optional<std::int64_t> whole(int column) const;

  SourcePlace place(int column) const;
  [[noreturn]] void refuse(int column, const std::string& message) const;
  /// "x 'abc'".
  std::string quoted(int column) const;
  int line() const { return lines_.line(); }
  const std::string& file() const { return lines_.file(); }

 private:
  struct Twins {
    int first = 0, other = 0;
  };
  bool split(std::string_view line);
  bool row(std::string_view line);
  void find_decimals();
  void find_twins();
  void check_twins(int column) const;
  std::optional<double> value(int column) const;
  std::string comma_hint(std::string_view text) const;
  TableLines lines_;
  TableLayout layout_;
  TableHeader header_;
  std::vector<std::string_view> cells_;
  std::deque<std::string> store_;  ///< of cells with doubled quotes
  std::vector<Twins> twins_;       ///< columns of the same name
  std::string_view row_;
  mutable std::string plain_;
  bool decimal_comma_ = false;
  std::int64_t empty_rows_ = 0, comment_lines_ = 0;
};

}  // namespace lilytank
