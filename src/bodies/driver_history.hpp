// Drivers as functions of time: values between samples, and the amplitude of an oscillation.
#pragma once
#include <vector>

#include "lilytank/bodies.hpp"

namespace lilytank::bodies {

/// A driver at `time` (s) of a run: linear between samples; before the first and after the last
/// sample as there.
double driver_at(const BodyRun& run, int driver, double time);

/// The amplitude of a driver's oscillation: the standard deviation of its values over `window` s up
/// to `time`, times sqrt(2). In the first `window` s of a run, that of these.
double amplitude_at(const BodyRun& run, int driver, double time, double window);

/// Mean period (s) with which a driver oscillates about its mean in some runs; 0 where it has fewer
/// than eight crossings of the mean, or fewer than six samples a period.
double period_of(const std::vector<const BodyRun*>& runs, int driver);

}  // namespace lilytank::bodies
