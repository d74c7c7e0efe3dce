// How a run starts: the standard model, the initial state, and whether bodies fit.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "lilytank/event.hpp"
#include "lilytank/state.hpp"

namespace lilytank {

/// A start is refused if two bodies, or a body and the wall, overlap by more than this, m: the
/// bound that holds in every later step. Poses rounded to 0.1 mm and 1 mrad stay below it.
constexpr double kStartTolerance = 0.5e-3;

/// The paper's tank with 15 Lilies, the baseline forces and the analytic flow; no ruleset.
Model standard_model();

/// The state at step 0: poses drawn from the seed as Model::start says, at rest, nothing latched.
/// Throws InputError if the bodies do not fit.
State initial_state(const Model& model, std::uint64_t seed);

/// All bodies at rest at `poses` (one for each body, modules first), nothing latched. Nothing is
/// checked: the poses may overlap.
State state_of_poses(const Model& model, const std::vector<Pose>& poses, std::uint64_t seed);

/// The deepest overlap of bodies of different assemblies, or of a body and the wall.
Overlap deepest_overlap(const Model& model, const State& state);

/// "module 3" or "ball 0" for a body's number.
std::string body_name(const Model& model, int body);

/// "module 3 and module 5 overlap by 35 mm at the start, more than 0.5 mm"; empty if the overlap is
/// within kStartTolerance. `after_a` and `after_b` follow the bodies' names, as " (line 4)".
std::string start_objection(const Model& model, const Overlap& overlap,
                            const std::string& after_a = "", const std::string& after_b = "");

}  // namespace lilytank
