// Rigid assemblies: latched modules as one body on a square lattice. Momentum is kept when
// assemblies merge and split.
#pragma once
#include <vector>

#include "lilytank/state.hpp"

namespace lilytank {

/// What follows from a State's lattice and is needed in every step: kept beside it, rebuilt from
/// it, never saved. Arrays are indexed by assembly slot; slots not in use hold zeros.
struct Assemblies {
  std::vector<int> live;              ///< slots in use, ascending
  std::vector<double> mass;           ///< kg
  std::vector<double> inertia;        ///< kg m^2, about the centre of mass
  std::vector<double> own_inertia;    ///< kg m^2, sum of the members' own inertias
  std::vector<double> reach;          ///< m, from the centre of mass to the farthest corner
  std::vector<double> centre_x, centre_y;  ///< m, centre of mass in the lattice frame
  std::vector<int> first, next;       ///< members: first[slot], next[body], -1 ends; ascending
  // Bodies [bodies]: poses in the tank, derived from assembly pose and lattice cell.
  std::vector<double> x, y, c, s, vx, vy, omega;
  std::vector<std::uint8_t> covered;  ///< bit f: face f is latched or bonded
  void resize(const Model& model);
};

/// Rebuilds everything in `out` from the state.
void derive(const Model& model, const State& state, Assemblies& out);
/// Rebuilds only the bodies' poses and twists (after assemblies moved).
void derive_poses(const Model& model, const State& state, Assemblies& out);
/// Rebuilds one slot's properties and member list (after a merge or split).
void derive_slot(const Model& model, const State& state, int slot, Assemblies& out);

/// Joins the assemblies of modules i and j, whose faces fi and fj meet, into one: both are moved
/// onto a common lattice (about their common centre of mass, by masses and inertias), linear and
/// angular momentum are kept. Does not touch Face data. No-op if they are one assembly already.
void merge(const Model& model, State& state, Assemblies& assemblies, int i, int fi, int j, int fj);
/// Splits the assembly of module i into its connected parts over latched and bonded faces.
void split(const Model& model, State& state, Assemblies& assemblies, int i);

}  // namespace lilytank
