// The colours of all pictures: calm, and distinguishable by readers with any colour vision.
#pragma once
#include "colour.hpp"
#include "lilytank/render.hpp"

namespace lilytank {

/// 0xRRGGBB, opaque.
constexpr Colour rgb(int hex) {
  return {(hex >> 16 & 255) / 255.0, (hex >> 8 & 255) / 255.0, (hex & 255) / 255.0, 1};
}

/// Colours that have one meaning in every picture.
namespace palette {
inline constexpr Colour paper{1, 1, 1};
inline constexpr Colour ink{0.122, 0.161, 0.200};
inline constexpr Colour muted{0.345, 0.404, 0.447};
inline constexpr Colour hairline{0.831, 0.859, 0.878};
inline constexpr Colour water_centre{0.945, 0.973, 0.984};
inline constexpr Colour water_edge{0.859, 0.925, 0.953};
inline constexpr Colour stream{0.392, 0.588, 0.690};
inline constexpr Colour rim{0.776, 0.816, 0.843};
inline constexpr Colour rim_line{0.549, 0.612, 0.659};
inline constexpr Colour halo{0.953, 0.643, 0.071};
inline constexpr Colour accent{0.000, 0.353, 0.604};
inline constexpr Colour isolated{0.831, 0.851, 0.867};
}  // namespace palette

/// The colour of control state l_a: neutral for 0, then nine hues near P. Tol's "muted" scheme,
/// which begin again in lighter and darker tones.
Colour colour_of_state(int state);
/// The colour of curve i of a plot, six in turn. tests/render/palette_test.cpp bounds the distance
/// of every pair, also as seen without red or green cones.
Colour colour_of_curve(int curve);

/// The colour at `share`, 0 .. 1, of the way along a scale for numbers, held at its ends. Scales
/// stay in order in grey print.
Colour colour_on(ColourScale scale, double share);
/// The colour of class i of a map of classes: the first is pale, the second dark.
Colour colour_of_class(int i);

/// `share` of b in a, 0 .. 1; the opacity is a's.
Colour mixed(const Colour& a, const Colour& b, double share);
/// The colour with another opacity.
Colour faded(const Colour& c, double opacity);
/// Ink or white, whichever reads better on `background`.
Colour readable_on(const Colour& background);

}  // namespace lilytank
