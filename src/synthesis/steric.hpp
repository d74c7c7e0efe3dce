// Whether one rigid assembly can come to another in the plane.
#pragma once
#include <vector>

#include "assemblies/pattern.hpp"

namespace lilytank {

/// Room that a latch gives, in sides of a module.
struct Approach {
  double capture = 0.005 / 0.035;     ///< distance of face centres from which they latch
  double angle = 0.2;                 ///< rad, turn from face to face within which they latch
  double clearance = 0.0002 / 0.035;  ///< to be kept from other modules on the way
};

/// Whether there is a straight way from afar for `guest`, the cells as they shall lie in the end,
/// to a pose from which its face latches onto the face of `at` (a cell of `host`) that looks in
/// `direction`. Tried are poses over the whole latching range (offsets along and across the bond,
/// turns) and ways up to 75 degrees from the bond's normal; the way keeps clear of every module of
/// the host, and a slot exactly as wide as the guest therefore lets nothing in. A way that needs
/// turning between modules is not found. The two must not share cells.
bool can_approach(const std::vector<Cell>& host, const std::vector<Cell>& guest, Cell at,
                  int direction, const Approach& room = {});
/// Whether the modules from index `host` on can come to the others' face `ours` in the plane.
bool free_to_meet(const Pattern& whole, std::size_t host, const Site& ours);

}  // namespace lilytank
