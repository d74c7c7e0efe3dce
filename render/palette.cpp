#include "palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace lilytank {
namespace {

// In an order that keeps the states of the first joins far apart.
constexpr std::array<Colour, 9> kStates = {rgb(0x39C77B), rgb(0xEBD95C), rgb(0xB8708D),
                                           rgb(0x332288), rgb(0x9EB1FF), rgb(0x9E59A6),
                                           rgb(0x96932D), rgb(0x035312), rgb(0x7F0953)};
constexpr std::array<Colour, 6> kCurves = {rgb(0x0C5DA5), rgb(0xC0091F), rgb(0x30A57A),
                                           rgb(0xDF9C05), rgb(0x6F0146), rgb(0x3EBAD5)};

// Nine samples of "viridis" (Smith and van der Walt), and P. Tol's "BuRd".
constexpr std::array<Colour, 9> kRising = {rgb(0x440154), rgb(0x472D7B), rgb(0x3B528B),
                                           rgb(0x2C728E), rgb(0x21918C), rgb(0x28AE80),
                                           rgb(0x5EC962), rgb(0xADDC30), rgb(0xFDE725)};
constexpr std::array<Colour, 9> kDiverging = {rgb(0x2166AC), rgb(0x4393C3), rgb(0x92C5DE),
                                              rgb(0xD1E5F0), rgb(0xF7F7F7), rgb(0xFDDBC7),
                                              rgb(0xF4A582), rgb(0xD6604D), rgb(0xB2182B)};
constexpr std::array<Colour, 5> kClasses = {rgb(0xB9D9EB), rgb(0x2B4C6F), rgb(0xC0091F),
                                            rgb(0xDF9C05), rgb(0x30A57A)};

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

Colour colour_on(ColourScale scale, double share) {
  const std::span<const Colour> stops = scale == ColourScale::rising ? kRising : kDiverging;
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  return mixed(stops[below], stops[below + 1], place - static_cast<double>(below));
}

Colour colour_of_class(int i) {
  return kClasses[static_cast<std::size_t>(std::max(0, i)) % kClasses.size()];
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
