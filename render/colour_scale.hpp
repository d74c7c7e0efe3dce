// Colours for numbers on maps: they stay in order in grey print and for readers with any colour
// vision.
#pragma once
#include "canvas.hpp"
#include "lilytank/render.hpp"

namespace lilytank {

/// The colour of `share`, 0 .. 1, of the way along a scale; held at its ends.
Colour colour_on(ColourScale scale, double share);
/// The colour of class i of a map of classes: the first is pale, the second dark.
Colour colour_of_class(int i);

}  // namespace lilytank
