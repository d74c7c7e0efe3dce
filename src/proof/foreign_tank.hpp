// Recordings that do not come from this project's engine: Box2D moves the bodies, in another flow
// interpolation, and the camera has pixels. A diagnosis that only works on its own simulator fails
// on them.
#pragma once
#include <vector>

#include "lilytank/emulator.hpp"

namespace lilytank {

/// Noise of a position before it is rounded to pixels, m: 0.29 mm after it.
inline constexpr double kForeignNoise = 2.5e-4;

/// Box2D with its own contacts, friction, restitution and damping, in steps of Model::dt. Forces
/// are those of the model, evaluated at the middle of a step (explicit midpoint rule), in a flow
/// that is interpolated by cubic polynomials instead of linear ones. Throws InputError if this
/// program was built without Box2D.
OtherEngine foreign_engine();

/// Rounds positions to pixels of 0.5 mm and headings to 0.01 rad.
void round_to_pixels(std::vector<Recording>& recordings);

}  // namespace lilytank
