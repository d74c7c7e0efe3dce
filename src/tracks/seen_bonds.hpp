// Latched modules, recognised from their poses alone: two squares that stay face to face.
#pragma once
#include <cstdint>
#include <vector>

#include "lilytank/recording.hpp"

namespace lilytank {

/// Two modules that move as one.
struct SeenBond {
  std::int64_t a = 0, b = 0;  ///< ids of tracks, a < b
  int begin = 0;              ///< frame from which they stay face to face
  int known = 0;              ///< frame in which that has lasted for long enough to be no encounter
  /// First frame in which they are apart, or of which it is not known: one of them is unseen for
  /// too long, or the recording is over.
  int end = 0;
  bool parted = false;  ///< they were seen apart at `end`
  /// Distance of the faces' centres just before `begin`, m: about the reach of the latches. NaN
  /// where it was not seen.
  double before = 0;
};

/// The bonds of a recording with headings, by `begin`, then modules. `side`: of a module, m.
/// Whether a bond stands at a frame depends on that frame and earlier ones only. Two modules that
/// touch face to face without a latch for 0.3 s count, too.
std::vector<SeenBond> seen_bonds(const Recording& recording, double side);

/// How often two faces came within reach of each other: the distance of their centres, m, and their
/// angle from anti-parallel, rad. It begins anew once they were half as far again apart.
int meetings(const Recording& recording, double side, double reach, double angle);

}  // namespace lilytank
