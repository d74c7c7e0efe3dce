// Refusals and warnings about what verbs read.
#pragma once
#include <string>
#include <vector>

#include "lilytank/run.hpp"

namespace lilytank::cli {

/// Throws InputError if one of the files is an experiment that lilytank diagnose alone reads,
/// rather than let its first key be called unknown.
void refuse_point_bodies(const std::vector<std::string>& files);

/// Poses of a body that were stored in a second, on average; 0 for fewer than two.
double stored_rate(const Trajectory& trajectory);

/// "poses were stored 5 times a second; between them <what> (run with --set output.rate=<remedy>)",
/// one line.
std::string seldom_stored(const Trajectory& trajectory, const std::string& what,
                          const std::string& remedy);

/// Such a line for pictures of a run at the given times (s), if bodies move more than half a
/// module's side (without modules: more than a ball's radius) between stored poses; else empty.
std::string too_seldom_to_draw(const StoredRun& run, const std::vector<double>& times);

}  // namespace lilytank::cli
