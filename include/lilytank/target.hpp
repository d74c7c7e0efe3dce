// What is to be built: a drawing of cells, with or without the bonds between them.
//
// A drawing is text. Compact: rows of '#' (a module) and '.' or blank (none). Spaced: every second
// column and row holds cells, and the places between them hold bonds: '-' and '|', or the number of
// the join that makes the bond (1 .. 9, then a .. z for 10 .. 35), which also gives the order.
//
//   .#.        #-#      #1#2#
//   ###        |          |       (a bond that is neither drawn nor numbered is not used)
//   .#.        #
//
// Before the drawing a line may read "name WORD"; ';' begins a comment.
#pragma once
#include <string>
#include <vector>

#include "lilytank/ruleset.hpp"

namespace lilytank {

/// Two neighbouring cells, as indices into Target::cells.
struct Contact {
  int a = 0, b = 0;  ///< a != b; functions that return contacts have a < b
  friend bool operator==(const Contact&, const Contact&) = default;
  friend auto operator<=>(const Contact&, const Contact&) = default;
};

/// A shape to build.
struct Target {
  std::string name;
  /// In raster order (y falling, then x rising), the least x and y being 0. Connected.
  std::vector<Cell> cells;
  /// The bonds drawn, a < b; empty where none are: every contact may then become a bond.
  std::vector<Contact> bonds;
  bool ordered = false;  ///< the bonds are numbered and stand in the order of their joins
  std::string file;
};

/// The most cells of a target: each join takes two of the 255 control states.
inline constexpr int kMostCells = 128;

/// Reads a drawing. Throws InputError with file, line and column: a sign that is no cell or bond,
/// A bond that joins nothing, numbers that are missing or twice there, cells that do not hang
/// together (over the drawn bonds, if there are any), too many or fewer than two cells.
Target parse_target(const std::string& text, const std::string& file);
/// parse_target() of a file's content. Throws InputError also if it cannot be read.
Target read_target(const std::string& file);
/// A target from cells in any order and place. Throws InputError as parse_target does.
Target target_of(std::vector<Cell> cells, const std::string& name);
/// The drawing in rows, compact without bonds and spaced with them; parse_target reads it back.
std::string to_text(const Target& target);

/// All pairs of neighbouring cells, a < b, in rising order.
std::vector<Contact> contacts_of(const Target& target);
/// The direction in which b lies from its neighbour a: 0 = +x, 1 = +y, 2 = -x, 3 = -y.
int direction_of(const Target& target, int a, int b);
/// Whether the mirror image is another shape: then modules, which cannot be turned over, have to be
/// given another ruleset to build it.
bool is_chiral(const Target& target);
/// The target mirrored left to right.
Target mirrored(const Target& target);

}  // namespace lilytank
