// A colour, without anything of Cairo.
#pragma once

namespace lilytank {

/// Red, green, blue and opacity, each 0 .. 1.
struct Colour {
  double r = 0, g = 0, b = 0, a = 1;
};

}  // namespace lilytank
