// A tank as the page's script reads it.
#pragma once
#include "lilytank/view.hpp"
#include "view/pack.hpp"

namespace lilytank {

/// Names, sizes and the columns of poses, states, events and streamlines, which are added to
/// `pack`. Keeps `rate` frames per second; 0: by kViewPoses.
Json tank_json(const ViewTank& tank, double rate, ViewPack& pack);

}  // namespace lilytank
