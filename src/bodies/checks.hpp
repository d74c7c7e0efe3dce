// Faults of recordings of point bodies, found before any law is fitted.
#pragma once
#include "lilytank/bodies.hpp"

namespace lilytank::bodies {

/// A finding for every kind of fault: rows in no order of time, jumps of positions, repeated rows,
/// axes that do not change, runs that are recorded twice. Empty where there is none.
std::vector<DiagnosisFinding> recording_faults(const BodyExperiment& experiment);

}  // namespace lilytank::bodies
