#include "io/cells.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

std::string_view bare(std::string_view cell) {
  while (!cell.empty() && is_blank(cell.front())) cell.remove_prefix(1);
  while (!cell.empty() && is_blank(cell.back())) cell.remove_suffix(1);
  return cell;
}

void skip_blanks(std::string_view& line, char separator) {
  const auto is_skipped = [&](char c) { return is_blank(c) && (c != separator || c == ' '); };
  while (!line.empty() && is_skipped(line.front())) line.remove_prefix(1);
}

std::size_t find_separator(std::string_view line, char separator) {
  if (separator == ' ') return std::min(line.find_first_of(" \t"), line.size());
  const void* found = line.empty() ? nullptr : std::memchr(line.data(), separator, line.size());
  return found == nullptr ? line.size()
                          : static_cast<std::size_t>(static_cast<const char*>(found) - line.data());
}

/// The closing quote of a text that begins with a quote; npos if it is open.
std::size_t closing_quote(std::string_view text) {
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i] != '"') continue;
    if (i + 1 == text.size() || text[i + 1] != '"') return i;
    ++i;
  }
  return std::string_view::npos;
}

/// The cell in quotes at the front of `line`, which then begins behind it.
std::string_view take_quoted(std::string_view& line, std::deque<std::string>& store) {
  const std::size_t end = std::min(closing_quote(line), line.size());
  std::string_view cell = line.substr(1, end - 1);
  line.remove_prefix(std::min(end + 1, line.size()));
  if (cell.find('"') == std::string_view::npos) return cell;
  std::string& plain = store.emplace_back();
  for (std::size_t i = 0; i < cell.size(); ++i) {
    plain += cell[i];
    if (cell[i] == '"') ++i;
  }
  return plain;
}

std::size_t count_cells(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  std::deque<std::string> store;
  try {
    split_cells(line, separator, cells, store, {});
  } catch (const InputError&) {
    return 0;
  }
  while (!cells.empty() && cells.back().empty()) cells.pop_back();
  return cells.size();
}

}  // namespace

bool is_not_seen(std::string_view text) {
  if (text.empty()) return true;
  constexpr std::size_t kLongest = 16;
  if (text.size() > kLongest) return false;
  const std::string lower = in_small_letters(text);
  std::string_view word = lower;
  if (word.size() > 2 && (word.front() == '-' || word.front() == '+')) word.remove_prefix(1);
  if (word.starts_with("nan")) {
    return word.size() == 3 || (word[3] == '(' && word.back() == ')');
  }
  if (word.starts_with("1.#") || word.starts_with("1,#")) {
    word.remove_prefix(3);
    return std::any_of(word.begin(), word.end(), [](char c) { return c == 'n'; });
  }
  constexpr std::array<std::string_view, 22> kWords{
      "inf",   "infinity", "na",     "n/a",     "#n/a",    "<na>",     "#na", "n.a.",
      "null",  "nil",      "none",   "nat",     "missing", "-",        "--",  "?",
      "#num!", "#ref!",    "#null!", "#div/0!", "#value!", "undefined"};
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

Comma comma_in(std::string_view text) {
  const auto comma = text.find(',');
  if (comma == std::string_view::npos) return Comma::none;
  std::string plain(text);
  std::erase(plain, ',');
  if (!parse_number(plain)) return Comma::none;
  const bool several = text.find(',', comma + 1) != std::string_view::npos;
  if (several || text.find('.') != std::string_view::npos) return Comma::thousands;
  const bool sign = text.front() == '-' || text.front() == '+';
  const std::string_view before = text.substr(sign ? 1 : 0, comma - (sign ? 1 : 0));
  const bool three = text.size() - comma == 4 && parse_whole(text.substr(comma + 1));
  const bool group = three && !before.empty() && before.size() <= 3 && before.front() != '0';
  return group ? Comma::ambiguous : Comma::decimal;
}

bool is_number_cell(std::string_view text) {
  return parse_number(text).has_value() || is_not_seen(text) || comma_in(text) != Comma::none;
}

char separator_of(std::string_view names, std::string_view row) {
  std::array<std::size_t, 4> of_names{}, of_row{};
  constexpr std::array<char, 4> kAll{'\t', ';', ',', ' '};
  for (std::size_t i = 0; i < kAll.size(); ++i) {
    of_names[i] = count_cells(names, kAll[i]), of_row[i] = count_cells(row, kAll[i]);
    if (of_names[i] > 1 && of_names[i] == of_row[i]) return kAll[i];
  }
  for (const auto& counts : {of_names, of_row}) {
    for (std::size_t i = 0; i + 1 < kAll.size(); ++i) {
      if (counts[i] > 1) return kAll[i];
    }
  }
  return ' ';
}

bool ends_in_quotes(std::string_view line, char separator) {
  const auto separates = [&](char c) {
    return separator != 0 ? c == separator || (separator == ' ' && c == '\t')
                          : c == ';' || c == ',' || is_blank(c);
  };
  bool fresh = true;  // at the begin of a cell
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (fresh && line[i] == '"') {
      const std::size_t end = closing_quote(line.substr(i));
      if (end == std::string_view::npos) return true;
      i += end, fresh = false;
    } else if (separates(line[i])) {
      fresh = true;
    } else {
      fresh = fresh && is_blank(line[i]);
    }
  }
  return false;
}

void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells,
                 std::deque<std::string>& store, const SourcePlace& place) {
  cells.clear(), store.clear();
  for (;;) {
    skip_blanks(line, separator);
    if (separator == ' ' && line.empty()) return;
    const bool quoted = line.starts_with('"');
    if (quoted) cells.push_back(take_quoted(line, store));
    const std::size_t end = find_separator(line, separator);
    if (!quoted) {
      cells.push_back(bare(line.substr(0, end)));
    } else if (!bare(line.substr(0, end)).empty()) {
      throw InputError(place, "there is text behind the closing quote of \"" +
                                  std::string(cells.back().substr(0, 40)) +
                                  "\": a quote within a cell is written twice");
    }
    if (end == line.size()) return;
    line.remove_prefix(end + 1);
  }
}

}  // namespace lilytank
