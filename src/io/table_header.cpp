#include "io/table_header.hpp"

#include <algorithm>
#include <cstring>

#include "io/cells.hpp"
#include "io/time_text.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kLongestRecord = 1 << 16;

constexpr std::size_t kMostColumns = 20000;

using Line = TableLines::Line;
using Cells = std::vector<std::string>;

Cells cells_of(std::string_view line, char separator, const SourcePlace& place) {
  std::vector<std::string_view> cells;
  std::deque<std::string> store;
  split_cells(line, separator, cells, store, place);
  return {cells.begin(), cells.end()};
}

bool is_empty(const Cells& cells) {
  return std::all_of(cells.begin(), cells.end(), [](const auto& cell) { return cell.empty(); });
}

/// Whether cells are those of a row: numbers, dates, or words for "not seen".
bool are_numbers(const Cells& cells) {
  return !is_empty(cells) && std::all_of(cells.begin(), cells.end(), [](const auto& cell) {
    return is_number_cell(cell) || parse_date(cell);
  });
}

bool holds_number(const Cells& cells) {
  return std::any_of(cells.begin(), cells.end(),
                     [](const auto& cell) { return !is_not_seen(cell) && is_number_cell(cell); });
}

bool contains(const Cells& cells, std::string_view name) {
  return std::find(cells.begin(), cells.end(), name) != cells.end();
}

bool same_throughout(const Cells& cells) {
  return cells.size() < 3 ||
         std::all_of(cells.begin() + 2, cells.end(), [&](const auto& c) { return c == cells[1]; });
}

/// The separator of Excel's line "sep=;", 0 if this is none.
char excel_separator(std::string_view line) {
  line = trimmed(line);
  if (line.size() > 1 && line.front() == '"' && line.back() == '"') {
    line = line.substr(1, line.size() - 2);
  }
  const bool named = line.size() == 5 && in_small_letters(line.substr(0, 4)) == "sep=";
  const bool tab = in_small_letters(line) == "sep=";  // its tab is cut as a blank
  return named ? line[4] : tab ? '\t' : 0;
}

class HeaderReader {
 public:
  HeaderReader(TableLines& lines, const TableLayout& layout) : lines_(lines), layout_(layout) {}

  TableHeader read() {
    take_excel_line();
    if (layout_.header_line.value_or(0) > 0) {
      go_to(*layout_.header_line, "header_line");
      take_names(*lines_.ahead());
    } else {
      find_names();
    }
    if (!out_.text.empty()) take_more_names();
    if (layout_.first_row) go_to(*layout_.first_row, "first_row");
    check_names();
    return std::move(out_);
  }

 private:
  void take_excel_line() {
    std::size_t i = 0;
    while (lines_.ahead(i) != nullptr && trimmed(lines_.ahead(i)->text).empty()) ++i;
    if (lines_.ahead(i) == nullptr) return;
    fixed_separator_ = excel_separator(lines_.ahead(i)->text);
    if (fixed_separator_ == 0) return;
    while (i-- > 0) lines_.drop();
    lines_.drop();
  }

  void go_to(int number, const std::string& key) {
    int last = 0;
    while (lines_.ahead() != nullptr && lines_.ahead()->number < number) {
      last = lines_.ahead()->number;
      lines_.drop();
    }
    if (lines_.ahead() != nullptr && lines_.ahead()->number == number) return;
    const bool record = lines_.ahead() != nullptr;
    throw InputError({lines_.file(), 0, 0},
                     key + " = " + std::to_string(number) +
                         (record ? ": this line is within a cell in quotes"
                                 : ", but there are " + std::to_string(last) + " lines"));
  }

  SourcePlace place(const Line& line) const { return {lines_.file(), line.number, 1}; }

  /// The first line from the i-th on that is no comment and not blank.
  const Line* content(std::size_t i) {
    const Line* line = nullptr;
    while ((line = lines_.ahead(i++)) != nullptr) {
      const std::string_view text = trimmed(line->text);
      const bool empty = text.find_first_not_of(";,\t \"") == std::string_view::npos;
      if (!empty && text.front() != '#' && text.front() != '%') return line;
    }
    return nullptr;
  }

  char separator_for(const Line& names, const Line* row) const {
    if (fixed_separator_ != 0) return fixed_separator_;
    return separator_of(names.text, row == nullptr ? std::string_view(names.text) : row->text);
  }

  // In the first line with cells; or, where that holds numbers, in the comment above it, or
  // nowhere.
  void find_names() {
    Line comment;
    while (const Line* line = lines_.ahead()) {
      const std::string_view text = trimmed(line->text);
      if (text.starts_with('#') || text.starts_with('%')) comment = *line;
      if (line == content(0)) break;
      lines_.drop();
    }
    const Line* first = lines_.ahead();
    if (first == nullptr) {
      if (!is_swistrack(comment))
        throw InputError({lines_.file(), 1, 1}, "there is no table in it");
      return take_comment(comment, names_of_comment(comment, ' '));
    }
    out_.separator = separator_for(*first, content(1));
    const Cells cells = cells_of(first->text, out_.separator, place(*first));
    if (!layout_.header_line && !are_numbers(cells)) return take_names(*first);
    out_.line = first->number;
    for (std::size_t i = 0; i < cells.size(); ++i) out_.names.push_back(std::to_string(i + 1));
    if (layout_.header_line || comment.text.empty()) return;
    const Cells names = names_of_comment(comment, out_.separator);
    const bool fit = cells.size() > 1 && names.size() == cells.size() && !holds_number(names);
    if (fit || is_swistrack(comment)) take_comment(comment, names);
  }

  static bool is_swistrack(const Line& comment) {
    return trimmed(comment.text).starts_with("% Frame number");
  }

  // "% Frame number  x  y": between tabs, or two blanks apart as the names have blanks in them.
  Cells names_of_comment(const Line& comment, char separator) const {
    std::string text(trimmed(trimmed(comment.text).substr(1)));
    const Cells plain = cells_of(text, separator, place(comment));
    if (separator != ' ' && plain.size() > 1) return plain;
    for (auto at = text.find("  "); at != std::string::npos; at = text.find("  ")) {
      text.replace(at, std::min(text.find_first_not_of(' ', at), text.size()) - at, "\t");
    }
    return cells_of(text, separator_of(text, text), place(comment));
  }

  void take_comment(const Line& comment, const Cells& names) {
    out_.text = comment.text, out_.line = comment.number, out_.names = names;
    out_.in_comment = true;
  }

  void take_names(const Line& line) {
    out_.separator = separator_for(line, content(1));
    out_.text = line.text, out_.line = line.number;
    std::string_view text = trimmed(line.text);
    const bool comment = text.starts_with('#') || text.starts_with('%');
    if (layout_.header_line && comment) text.remove_prefix(1);
    out_.names =
        cells_of(layout_.header_line && comment ? text : line.text, out_.separator, place(line));
    lines_.drop();
  }

  Cells ahead_cells() {
    const Line* line = lines_.ahead();
    return line == nullptr ? Cells{} : cells_of(line->text, out_.separator, place(*line));
  }

  void take_more_names() {
    const Cells next = ahead_cells();
    if (next.empty()) return;
    const std::string first = in_small_letters(next.front());
    const bool deeplabcut = in_small_letters(out_.names.front()) == "scorer";
    if (deeplabcut && (first == "individuals" || first == "bodyparts")) return take_deeplabcut();
    if (!contains(out_.names, "POSITION_X") || !contains(out_.names, "POSITION_Y")) return;
    // TrackMate: names, short names, units.
    for (int i = 0; i < 3 && lines_.ahead() != nullptr; ++i) {
      const Cells cells = ahead_cells();
      if (holds_number(cells) || cells.size() != out_.names.size() || is_empty(cells)) return;
      lines_.drop();
    }
  }

  void take_deeplabcut() {
    std::vector<Cells> parts;
    for (const char* word : {"individuals", "bodyparts", "coords"}) {
      const Cells cells = ahead_cells();
      if (cells.empty() || in_small_letters(cells.front()) != word) continue;
      if (cells.size() != out_.names.size()) {
        throw InputError(place(*lines_.ahead()), std::to_string(cells.size()) +
                                                     " columns instead of " +
                                                     std::to_string(out_.names.size()));
      }
      const bool coordinates = std::string_view(word) == "coords";
      if (coordinates || !same_throughout(cells)) parts.push_back(cells);
      lines_.drop();
    }
    out_.names.front() = "frame";
    for (std::size_t c = 1; c < out_.names.size(); ++c) {
      out_.names[c] = joined(parts, "_", [&](const Cells& cells) { return cells[c]; });
    }
  }

  void check_names() {
    for (std::string& name : out_.names) std::replace(name.begin(), name.end(), '\n', ' ');
    const SourcePlace where{lines_.file(), out_.line, 1};
    if (out_.names.size() > kMostColumns) {
      throw InputError(where, std::to_string(out_.names.size()) + " columns: more than " +
                                  std::to_string(kMostColumns));
    }
    for (std::size_t c = 0; c < out_.names.size(); ++c) {
      for (const char letter : out_.names[c]) {
        if (static_cast<unsigned char>(letter) >= 32 && letter != 127) continue;
        throw InputError(where, "the name of column " + std::to_string(c + 1) +
                                    " holds a control character (byte " +
                                    std::to_string(static_cast<unsigned char>(letter)) +
                                    "): is this a text table?");
      }
    }
  }

  TableLines& lines_;
  const TableLayout& layout_;
  TableHeader out_;
  char fixed_separator_ = 0;
};

}  // namespace

bool TableLines::fetch(std::string_view& line) {
  if (!lines_->next(line)) return false;
  line_ = lines_->line();
  if (line.empty() || std::memchr(line.data(), '"', line.size()) == nullptr) return true;
  if (comments_ && (trimmed(line).starts_with('#') || trimmed(line).starts_with('%'))) return true;
  if (!ends_in_quotes(line, separator_)) return true;
  joined_ = line;
  std::string_view more;
  while (ends_in_quotes(joined_, separator_)) {
    if (joined_.size() > kLongestRecord || !lines_->next(more)) {
      throw InputError({file(), line_, 1}, "a quote (\") that begins a cell here is never closed");
    }
    joined_.append("\n").append(more);
  }
  line = joined_;
  return true;
}

bool TableLines::next(std::string_view& line) {
  if (ahead_.empty()) return fetch(line);
  current_ = std::move(ahead_.front().text);
  line_ = ahead_.front().number;
  ahead_.pop_front();
  line = current_;
  return true;
}

const TableLines::Line* TableLines::ahead(std::size_t i) {
  const int present = line_;
  std::string_view line;
  while (ahead_.size() <= i && fetch(line)) ahead_.push_back({std::string(line), line_});
  line_ = present;
  return i < ahead_.size() ? &ahead_[i] : nullptr;
}

TableHeader read_table_header(TableLines& lines, const TableLayout& layout) {
  lines.set_comments(true);
  TableHeader out = HeaderReader(lines, layout).read();
  lines.set_comments(false), lines.set_separator(out.separator);
  return out;
}

}  // namespace lilytank
