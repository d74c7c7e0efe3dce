// The cells of one line of a text table.
#pragma once
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "lilytank/error.hpp"

namespace lilytank {

/// Words for "not seen": an empty cell, nan (also with a sign, or as "nan(ind)"), "1.#IND",
/// "1.#QNAN" and "1.#INF" of Visual C++, inf, "#N/A" and the errors of Excel ("#DIV/0!"), "<NA>"
/// and "NaT" of pandas, NA, N/A, n.a., null, nil, None, missing, undefined, "-", "--" and "?"; in
/// any letters.
bool is_not_seen(std::string_view text);

/// A cell that is a number or a word for "not seen", with a decimal point or comma.
bool is_number_cell(std::string_view text);

/// What a comma in a cell can be.
enum class Comma : unsigned char {
  none,       ///< there is none, or the cell is no number
  decimal,    ///< "0,147"
  ambiguous,  ///< "447,410" is 447.41 or 447410
  thousands   ///< "1,234,567", "1,234.5"
};
Comma comma_in(std::string_view text);

/// The separator of a table: tab, semicolon or comma if a line of names and a row have equally many
/// cells by it, else the first that occurs; a blank stands for runs of blanks and tabs.
char separator_of(std::string_view names, std::string_view row);

/// Whether a quote that begins a cell is still open at the end; `separator` 0: any of those above.
bool ends_in_quotes(std::string_view line, char separator);

/// Cells by RFC 4180: blanks around them are cut, quotes removed, doubled quotes are one. `store`
/// holds the cells that are no part of the line. Throws InputError at `place`: text behind a
/// closing quote.
void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells,
                 std::deque<std::string>& store, const SourcePlace& place);

}  // namespace lilytank
