// Longitudes and latitudes of point bodies as positions on a plane.
#pragma once
#include <string>

#include "lilytank/bodies.hpp"

namespace lilytank {

/// Adds the latitude in degrees to the drivers: of the first body, the last one that is known.
/// Positions are longitudes and latitudes in degrees still.
void add_latitudes(BodyExperiment& e);

/// Degrees to metres by the azimuthal equidistant projection about the mean position, on a sphere
/// of 6371 km [Snyder, USGS Professional Paper 1395, 1987, section 25]. Throws InputError, which
/// names `file`, where a position is more than 1000 km away: distances across the way to the centre
/// are 0.4 % too long there.
void project_positions(const std::string& file, BodyExperiment& e);

}  // namespace lilytank
