// The text of a target: reading, checking, writing.
#include <algorithm>
#include <map>
#include <numeric>

#include "io/atomic_file.hpp"
#include "lilytank/target.hpp"
#include "model/ruleset_scanner.hpp"
#include "synthesis/tree.hpp"

namespace lilytank {
namespace {

const std::string kMarks = "123456789abcdefghijklmnopqrstuvwxyz";

// A sign of the drawing; row counts downwards.
struct Sign {
  char c = 0;
  int row = 0, column = 0;
};
// A bond between places of the drawing, in which cells are `2` apart.
struct Drawn {
  Sign sign;
  Cell a, b;
  int number = 0;  // 0: not numbered
};

// Reads a drawing: first its signs, then what they mean.
class Reader {
 public:
  Reader(const std::string& text, const std::string& file) { target_.file = file, scan(text); }

  Target run() {
    if (cells_.empty()) {
      if (!marks_.empty()) fail(marks_.front(), "there are bonds but no '#' in the drawing");
      throw InputError({target_.file, 0, 0}, "there is no '#' in the drawing");
    }
    const bool with_bonds = !marks_.empty();
    for (const Sign& sign : cells_) where_[{sign.column, -sign.row}] = sign;
    if (with_bonds) spaced();
    numbers();
    std::vector<Cell> cells;
    const int pitch = with_bonds ? 2 : 1;
    const Cell first = where_.begin()->first;
    for (const auto& [cell, sign] : where_)
      cells.push_back({(cell.x - first.x) / pitch, (cell.y - first.y) / pitch});
    Target made;
    try {
      made = target_of(std::move(cells), target_.name);
    } catch (const InputError& e) {
      throw InputError(place(), e.what());
    }
    target_.cells = std::move(made.cells);
    if (target_.name.empty()) {
      const std::size_t slash = target_.file.find_last_of("/\\");
      const std::string base =
          slash == std::string::npos ? target_.file : target_.file.substr(slash + 1);
      target_.name = base.substr(0, base.find('.'));
      const bool letter =
          !target_.name.empty() && (std::isalpha(static_cast<unsigned char>(target_.name[0])) != 0);
      if (!letter) target_.name = "target";
    }
    bonds();
    if (with_bonds && !hangs_together(static_cast<int>(target_.cells.size()), target_.bonds))
      throw InputError(place(), "the drawn bonds do not hold all modules together");
    return target_;
  }

 private:
  void scan(const std::string& text) {
    std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
    while (at < text.size()) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      std::string raw = text.substr(at, end - at);
      at = end + 1;
      ++row_;
      raw.resize(std::min(raw.find(';'), raw.size()));
      if (!raw.empty() && raw.back() == '\r') raw.pop_back();
      line(raw);
    }
  }

  void line(const std::string& raw) {
    const std::size_t first = raw.find_first_not_of(' ');
    if (first == std::string::npos) return;
    if (raw.compare(first, 5, "name ") == 0 || raw.substr(first) == "name") {
      if (cells_.empty() && marks_.empty()) return name(raw);
      throw InputError({target_.file, row_, static_cast<int>(first) + 1},
                       "'name' stands before the drawing");
    }
    for (std::size_t k = 0; k < raw.size(); ++k) {
      const Sign sign{raw[k], row_, static_cast<int>(k) + 1};
      if (raw[k] == ' ' || raw[k] == '.') continue;
      if (first_row_ == 0) first_row_ = row_;
      if (raw[k] == '#')
        cells_.push_back(sign);
      else if (raw[k] == '-' || raw[k] == '|' || kMarks.find(raw[k]) != std::string::npos)
        marks_.push_back(sign);
      else
        fail(sign, (raw[k] == '\t' ? std::string("a tab, whose width nobody knows,")
                                   : "'" + std::string(1, raw[k]) + "'") +
                       " in a drawing: expected '#' (a module), '.' or blank (none), and between "
                       "spaced cells the bonds '-', '|' or their numbers 1 .. 9, a .. z");
    }
  }

  void name(const std::string& raw) {
    const std::size_t begin = raw.find_first_not_of(' ', raw.find("name") + 4);
    const std::size_t end = raw.find_last_not_of(' ') + 1;
    const std::string word = begin == std::string::npos ? "" : raw.substr(begin, end - begin);
    if (!is_name(word)) {
      const int column = begin == std::string::npos ? static_cast<int>(raw.size()) + 1
                                                    : static_cast<int>(begin) + 1;
      throw InputError({target_.file, row_, column}, "'" + word + "' is not a name: " + kNameForm);
    }
    if (!target_.name.empty()) throw InputError({target_.file, row_, 1}, "'name' is given twice");
    target_.name = word;
  }

  void spaced() {
    const Sign origin = cells_.front();
    for (const Sign& sign : cells_) {
      if (((sign.column - origin.column) & 1) != 0 || ((sign.row - origin.row) & 1) != 0)
        fail(sign, "this '#' is out of step with the first one: as there is a bond, '" +
                       std::string(1, marks_.front().c) + "' in line " +
                       std::to_string(marks_.front().row) +
                       ", cells take every second column and row");
    }
    for (const Sign& sign : marks_) bond(sign, sign.column - origin.column, sign.row - origin.row);
  }

  void bond(const Sign& sign, int column, int row) {
    // Odd places between cells: a horizontal bond has an odd column, an upright one an odd row.
    const bool across = (column & 1) != 0 && (row & 1) == 0;
    const bool upright = (column & 1) == 0 && (row & 1) != 0;
    const std::string shown = "'" + std::string(1, sign.c) + "'";
    if (!across && !upright)
      fail(sign, shown +
                     " is not between two cells: where bonds are drawn, cells take every second "
                     "column and row");
    if ((sign.c == '-' && upright) || (sign.c == '|' && across))
      fail(sign, shown + " is turned the wrong way: '-' is a bond to the right, '|' one downwards");
    Drawn found;
    found.sign = sign;
    const int x = sign.column, y = -sign.row;
    found.a = across ? Cell{x - 1, y} : Cell{x, y + 1};
    found.b = across ? Cell{x + 1, y} : Cell{x, y - 1};
    if (where_.count(found.a) == 0 || where_.count(found.b) == 0)
      fail(sign, shown + " joins nothing: there is no '#' at one of its ends");
    if (sign.c != '-' && sign.c != '|') found.number = static_cast<int>(kMarks.find(sign.c)) + 1;
    drawn_.push_back(found);
  }

  // All bonds are numbered 1, 2, ... or none is.
  void numbers() {
    std::stable_sort(drawn_.begin(), drawn_.end(),
                     [](const Drawn& a, const Drawn& b) { return a.number < b.number; });
    target_.ordered = !drawn_.empty() && drawn_.back().number > 0;
    if (!target_.ordered) return;
    for (std::size_t k = 0; k < drawn_.size(); ++k) {
      const Drawn& bond = drawn_[k];
      if (bond.number == 0) fail(bond.sign, "this bond has no number, but others have one");
      if (k > 0 && bond.number == drawn_[k - 1].number)
        fail(bond.sign, "the number '" + std::string(1, bond.sign.c) + "' is there twice");
      if (bond.number != static_cast<int>(k) + 1)
        fail(bond.sign, "there is a bond numbered '" + std::string(1, bond.sign.c) +
                            "' but none numbered '" + std::string(1, kMarks[k]) + "'");
    }
    if (drawn_.size() + 1 != cells_.size())
      throw InputError(place(), "numbered bonds must be a tree: " + std::to_string(cells_.size()) +
                                    " modules need " + std::to_string(cells_.size() - 1) +
                                    " bonds, and " + std::to_string(drawn_.size()) + " are drawn");
  }

  void bonds() {
    std::map<Cell, int> index;
    for (std::size_t k = 0; k < target_.cells.size(); ++k)
      index[target_.cells[k]] = static_cast<int>(k);
    const auto low_x =
        std::min_element(cells_.begin(), cells_.end(), [](const Sign& a, const Sign& b) {
          return a.column < b.column;
        })->column;
    const auto low_y =
        -std::max_element(cells_.begin(), cells_.end(), [](const Sign& a, const Sign& b) {
           return a.row < b.row;
         })->row;
    const auto cell = [&](const Cell& c) {
      return index.at({(c.x - low_x) / 2, (c.y - low_y) / 2});
    };
    for (const Drawn& bond : drawn_) {
      const int a = cell(bond.a), b = cell(bond.b);
      target_.bonds.push_back({std::min(a, b), std::max(a, b)});
    }
  }

  [[noreturn]] void fail(const Sign& at, const std::string& message) const {
    throw InputError({target_.file, at.row, at.column}, message);
  }
  SourcePlace place() const { return {target_.file, first_row_, 0}; }

  Target target_;
  int row_ = 0, first_row_ = 0;
  std::vector<Sign> cells_, marks_;
  std::map<Cell, Sign> where_;
  std::vector<Drawn> drawn_;
};

}  // namespace

Target target_of(std::vector<Cell> cells, const std::string& name) {
  if (cells.size() < 2) throw InputError("a target needs two modules or more");
  if (cells.size() > static_cast<std::size_t>(kMostCells))
    throw InputError("a target of " + std::to_string(cells.size()) +
                     " modules is too large: " + std::to_string(kMostCells) + " at most");
  Cell low = cells.front();
  for (const Cell& cell : cells) low = {std::min(low.x, cell.x), std::min(low.y, cell.y)};
  for (Cell& cell : cells) cell = {cell.x - low.x, cell.y - low.y};
  std::sort(cells.begin(), cells.end(),
            [](const Cell& a, const Cell& b) { return a.y != b.y ? a.y > b.y : a.x < b.x; });
  Target target;
  target.name = name;
  target.cells = std::move(cells);
  if (!hangs_together(static_cast<int>(target.cells.size()), contacts_of(target)))
    throw InputError("the drawing is in several pieces");
  return target;
}

Target parse_target(const std::string& text, const std::string& file) {
  return Reader(text, file).run();
}

Target read_target(const std::string& file) {
  return parse_target(read_whole(file), file);
}

std::string to_text(const Target& target) {
  Cell high;
  for (const Cell& cell : target.cells) high = {std::max(high.x, cell.x), std::max(high.y, cell.y)};
  const int pitch = target.bonds.empty() ? 1 : 2;
  std::vector<std::string> rows(
      static_cast<std::size_t>(pitch * high.y + 1),
      std::string(static_cast<std::size_t>(pitch * high.x + 1), pitch == 1 ? '.' : ' '));
  const auto at = [&](int x, int y) -> char& {  // in places of the drawing, y up
    return rows[pitch * high.y - y][x];
  };
  for (const Cell& cell : target.cells) at(pitch * cell.x, pitch * cell.y) = '#';
  for (std::size_t k = 0; k < target.bonds.size(); ++k) {
    const Cell a = target.cells[target.bonds[k].a];
    const Cell b = target.cells[target.bonds[k].b];
    const char plain = a.y == b.y ? '-' : '|';
    at(a.x + b.x, a.y + b.y) = target.ordered && k < kMarks.size() ? kMarks[k] : plain;
  }
  std::string out = target.name.empty() ? "" : "name " + target.name + "\n";
  for (const std::string& row : rows) out += row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
  return out;
}

std::vector<Contact> contacts_of(const Target& target) {
  std::map<Cell, int> index;
  for (std::size_t k = 0; k < target.cells.size(); ++k)
    index[target.cells[k]] = static_cast<int>(k);
  std::vector<Contact> found;
  for (std::size_t k = 0; k < target.cells.size(); ++k) {
    const Cell at = target.cells[k];
    for (const Cell& next :
         {Cell{at.x + 1, at.y}, Cell{at.x, at.y - 1}}) {  // later in raster order
      const auto other = index.find(next);
      if (other != index.end()) found.push_back({static_cast<int>(k), other->second});
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

int direction_of(const Target& target, int a, int b) {
  const Cell from = target.cells[a];
  const Cell to = target.cells[b];
  if (to.x != from.x) return to.x > from.x ? 0 : 2;
  return to.y > from.y ? 1 : 3;
}

Target mirrored(const Target& target) {
  std::vector<Cell> cells = target.cells;
  for (Cell& cell : cells) cell.x = -cell.x;
  return target_of(std::move(cells), target.name);
}

bool is_chiral(const Target& target) {
  return canonical_shape(target.cells) != canonical_shape(mirrored(target).cells);
}

}  // namespace lilytank
