// The worlds whose speed is watched.
#pragma once
#include <string>
#include <vector>

#include "lilytank/world.hpp"

namespace lilytank::bench {

struct Scene {
  std::string name;
  Model model;
};

/// Radius (m) of a tank with as much room for each of its modules as the paper's has for 15.
double tank_radius(int modules);

/// The paper's world: standard_model(), gusts as given, modules that latch by the chain5 ruleset.
/// With another number of modules the tank's area and its flow grid grow in proportion.
Model paper_world(int modules = 15, Gusts gusts = Gusts::per_point);
/// The same without latches: what other engines are given.
Model loose_world(int modules, Gusts gusts);
/// Water at rest and modules on a lattice, none of which ever touches another.
Model still_world();

/// All of them, by name.
std::vector<Scene> scenes();

/// Steps a world by a number of seconds; returns it. Throws std::runtime_error if it diverges.
World advanced(World world, double seconds);

}  // namespace lilytank::bench
