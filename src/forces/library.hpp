// The terms that library.cpp lists; each is defined in the file of its name.
#pragma once
#include "lilytank/force.hpp"

namespace lilytank {

const ForceTerm& face_drag();
const ForceTerm& ball_drag();
const ForceTerm& stochastic_force();
const ForceTerm& damping();
const ForceTerm& body_force();
const ForceTerm& pair_attraction();

}  // namespace lilytank
