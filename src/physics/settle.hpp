// Makes room after a latch pulled two assemblies onto one lattice.
#pragma once
#include "island_builder.hpp"

namespace lilytank {

/// Pushes the assembly in `slot`, and what gets in its way in turn, apart; positions only. Returns
/// false if an overlap stays; the builder's island then holds poses of no use. The state is not
/// touched.
bool make_room(const Model& model, const Assemblies& assemblies, int slot, IslandBuilder& builder);

}  // namespace lilytank
