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

/// The paper's tank with 15 Lilies, the baseline forces at their defaults and the analytic flow
/// with bilinear interpolation; no ruleset, so latched modules stay together.
Model standard_model();

/// The state at step 0: poses as Model::start sets them, at rest, nothing latched. Random layouts
/// draw from Stream::start_pose of the seed; a body tries 20 000 places. Throws InputError if the
/// bodies do not fit, or if Layout::poses has another number of poses than bodies.
State initial_state(const Model& model, std::uint64_t seed);

/// All bodies at rest at `poses` (one for each body, modules first), nothing latched. Without
/// poses, all lie at the origin. Overlaps are not checked: see deepest_overlap().
State state_of_poses(const Model& model, const std::vector<Pose>& poses, std::uint64_t seed);

/// A bond of two modules at the start: their numbers and connectors, 0..3.
struct StartBond {
  int a = 0, face_a = 0, b = 0, face_b = 0;
};

/// Bonds modules whose faces meet about: what bonds connect becomes one rigid assembly, on a common
/// lattice about its centre of mass and with its momentum, as by latches in this order. The faces
/// are bonded, without a ruleset latched; labels stay as they are. Returns false, with the bonds
/// before it made, at one for which there is no room on the lattice.
bool make_bonds(const Model& model, const std::vector<StartBond>& bonds, State& state);

/// The deepest overlap of bodies of different assemblies, or of a body and the wall. Computed
/// from corners and projections, independently of the contact solver.
Overlap deepest_overlap(const Model& model, const State& state);

/// "module 3" or "ball 0" for a body's number: balls count from 0 again.
std::string body_name(const Model& model, int body);

/// "module 3 and module 5 overlap by 35 mm at the start, more than 0.5 mm"; empty if the overlap is
/// within kStartTolerance. `after_a` and `after_b` follow the bodies' names, as " (line 4)".
std::string start_objection(const Model& model, const Overlap& overlap,
                            const std::string& after_a = "", const std::string& after_b = "");

}  // namespace lilytank
