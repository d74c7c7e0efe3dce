// Live text for Cairo's SVG, which knows text as outlines only.
#pragma once
#include <string>
#include <vector>

#include "canvas.hpp"

namespace lilytank {

/// Draws what holds a text's place in the order of drawing and under its clip: a stroke from (x, y)
/// that is `width` long, with a miter limit that numbers it. Adds the text to `texts` as an SVG
/// element, which has that width in every font.
void hold_text_place(const Canvas& canvas, double x, double y, double width, const std::string& s,
                     const TextStyle& style, std::vector<std::string>& texts);

/// The SVG with those strokes replaced by their texts, in the font family.
std::string with_texts(const std::string& svg, const std::vector<std::string>& texts,
                       const std::string& family);

}  // namespace lilytank
