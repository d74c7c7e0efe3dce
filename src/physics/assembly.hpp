// Rigid assemblies: latched modules as one body on a square lattice. Momentum is kept when
// assemblies merge and split.
#pragma once
#include <vector>

#include "lilytank/state.hpp"

namespace lilytank {

/// What follows from a State's lattice and is needed in every step: kept beside it, rebuilt from
/// it, never saved. Arrays are indexed by assembly slot; slots not in use hold zeros.
struct Assemblies {
  std::vector<int> live;                   ///< slots in use, ascending
  std::vector<int> groups;                 ///< those of more than one module, ascending
  std::vector<double> mass;                ///< kg
  std::vector<double> inertia;             ///< kg m^2, about the centre of mass; 0 for a ball
  std::vector<double> inverse_mass;        ///< 1/kg
  std::vector<double> inverse_inertia;     ///< 1/(kg m^2); 0 for a ball
  std::vector<double> own_inertia;         ///< kg m^2, sum of the members' own inertias
  std::vector<double> reach;               ///< m, from the centre of mass to the farthest corner
  std::vector<double> centre_x, centre_y;  ///< m, centre of mass in the lattice frame
  std::vector<int> first, next;            ///< members: first[slot], next[body], -1 ends; ascending
  std::vector<int> work;                   ///< scratch of merge and split
  std::vector<int> by_cell;                ///< scratch of derive_slot: members by lattice cell
  // Bodies [bodies]: poses in the tank, derived from assembly pose and lattice cell.
  std::vector<double> x, y, c, s, vx, vy, omega;
  std::vector<double> offset_x, offset_y;  ///< m, in the assembly's frame, from its centre of mass
  std::vector<std::uint8_t> covered;       ///< bit f: face f is latched or bonded
  std::vector<std::uint8_t> resting;       ///< bit f: face f is off, or rests (Face::off_ticks)
  /// Bit k: the lattice cell in direction k of the assembly's frame (0..3: +x, +y, -x, -y) holds
  /// another member, latched or not. Nothing can touch a face there.
  std::vector<std::uint8_t> inner;
  /// Allocates for the bodies of `model`; the arrays never move afterwards.
  void resize(const Model& model);
};

/// Assemblies::resting of one module.
std::uint8_t resting_faces(const State& state, int module);
/// Rebuilds everything in `out` from the state. `out` must have been resized for `model`.
void derive(const Model& model, const State& state, Assemblies& out);
/// Rebuilds only the bodies' poses and twists (after assemblies moved or were pushed).
void derive_poses(const Model& model, const State& state, Assemblies& out);
/// The same for the members of one slot.
void derive_poses(const Model& model, const State& state, int slot, Assemblies& out);
/// Rebuilds one slot: its place in `live`, properties, member list, and its members' poses, twists,
/// covered faces and inner sides (after a merge, a split, or a change of a face's status).
void derive_slot(const Model& model, const State& state, int slot, Assemblies& out);

/// Joins the assemblies of modules i and j, whose faces fi and fj meet, into one, in the slot of
/// its lowest module. Both are turned onto one lattice, each by the other's share of the inertia,
/// and shifted, each by the other's share of the mass: the common centre of mass stays where it
/// is, and linear and angular momentum are kept. Face data is not touched. Returns true; only
/// rebuilds the slot if the two are one assembly already. Returns false, changing nothing, if two
/// modules would lie on one cell of the lattice.
bool merge(const Model& model, State& state, Assemblies& assemblies, int i, int fi, int j, int fj);
/// Splits the assembly of module i into its connected parts over latched and bonded faces. Every
/// part goes on as it moved (v + omega x r, omega); its lowest module lies on cell (0, 0), turn 0.
void split(const Model& model, State& state, Assemblies& assemblies, int i);

}  // namespace lilytank
