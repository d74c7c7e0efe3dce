#include "colour_scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "palette.hpp"

namespace lilytank {
namespace {

// Nine samples of "viridis" (Smith and van der Walt), and P. Tol's "BuRd".
constexpr std::array<Colour, 9> kRising = {rgb(0x440154), rgb(0x472D7B), rgb(0x3B528B),
                                           rgb(0x2C728E), rgb(0x21918C), rgb(0x28AE80),
                                           rgb(0x5EC962), rgb(0xADDC30), rgb(0xFDE725)};
constexpr std::array<Colour, 9> kDiverging = {rgb(0x2166AC), rgb(0x4393C3), rgb(0x92C5DE),
                                              rgb(0xD1E5F0), rgb(0xF7F7F7), rgb(0xFDDBC7),
                                              rgb(0xF4A582), rgb(0xD6604D), rgb(0xB2182B)};
constexpr std::array<Colour, 5> kClasses = {rgb(0xB9D9EB), rgb(0x2B4C6F), rgb(0xD1495B),
                                            rgb(0xE0A100), rgb(0x228833)};

}  // namespace

Colour colour_on(ColourScale scale, double share) {
  const std::span<const Colour> stops = scale == ColourScale::rising ? kRising : kDiverging;
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  return mixed(stops[below], stops[below + 1], place - static_cast<double>(below));
}

Colour colour_of_class(int i) {
  return kClasses[static_cast<std::size_t>(std::max(0, i)) % kClasses.size()];
}

}  // namespace lilytank
