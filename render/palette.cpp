#include "palette.hpp"

#include <array>
#include <cmath>

namespace lilytank {
namespace {

// In an order that keeps the states of the first joins far apart.
constexpr std::array<Colour, 9> kStates = {rgb(0x44AA99), rgb(0xDDCC77), rgb(0xCC6677),
                                           rgb(0x332288), rgb(0x88CCEE), rgb(0xAA4499),
                                           rgb(0x999933), rgb(0x117733), rgb(0x882255)};
constexpr std::array<Colour, 6> kCurves = {rgb(0x0C5DA5), rgb(0xD1495B), rgb(0x228833),
                                           rgb(0xE0A100), rgb(0x7A3E9D), rgb(0x33A6C4)};

double linear(double channel) {
  return channel <= 0.04045 ? channel / 12.92 : std::pow((channel + 0.055) / 1.055, 2.4);
}

}  // namespace

Colour colour_of_state(int state) {
  if (state <= 0) return palette::isolated;
  const int hues = static_cast<int>(kStates.size());
  const Colour base = kStates[static_cast<std::size_t>((state - 1) % hues)];
  switch ((state - 1) / hues % 3) {
    case 1:
      return mixed(base, palette::paper, 0.42);
    case 2:
      return mixed(base, palette::ink, 0.38);
    default:
      return base;
  }
}

Colour colour_of_curve(int curve) {
  return kCurves[static_cast<std::size_t>(curve) % kCurves.size()];
}

Colour mixed(const Colour& a, const Colour& b, double share) {
  return {a.r + (b.r - a.r) * share, a.g + (b.g - a.g) * share, a.b + (b.b - a.b) * share, a.a};
}

Colour faded(const Colour& c, double opacity) {
  return {c.r, c.g, c.b, opacity};
}

Colour readable_on(const Colour& background) {
  // Relative luminance as in WCAG 2; 0.24 is where ink and white have about equal contrast.
  const double luminance =
      0.2126 * linear(background.r) + 0.7152 * linear(background.g) + 0.0722 * linear(background.b);
  return luminance > 0.24 ? palette::ink : palette::paper;
}

}  // namespace lilytank
