// Where things are on a frame: pages are 1920 x 1080 units, whatever their size in pixels.
#pragma once

namespace lilytank {

constexpr double kPageWidth = 1920, kPageHeight = 1080;  // units
constexpr double kTankCentreX = 560, kTankCentreY = 540;
/// Without the panel the page is square about the tank: this much of it is cut off on the left.
constexpr double kTankPage = kPageHeight, kTankPageLeft = kTankCentreX - kTankPage / 2;
constexpr double kTankRadius = 466;  // units; the rim and the inlets come on top

/// From metres (y up, origin in the tank's centre) to units (y down).
struct View {
  double centre_x = kTankCentreX, centre_y = kTankCentreY;  ///< units
  double scale = 1;                                         ///< units per metre
  double x(double metres) const { return centre_x + scale * metres; }
  double y(double metres) const { return centre_y - scale * metres; }
};

/// The view of a tank of that radius (m).
inline View view_of_tank(double radius) {
  return {kTankCentreX, kTankCentreY, kTankRadius / radius};
}

}  // namespace lilytank
