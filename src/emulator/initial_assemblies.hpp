// The assemblies that stand where a simulated recording begins.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "assemblies/labellings.hpp"
#include "lilytank/emulator.hpp"

namespace lilytank {

/// Bonds the modules of a state that a recording shows bonded, and gives them ruleset states.
///
/// Two modules that part within four mean times between evaluations held each other by a latch that
/// no rule made a bond: they are left as they are, and latch anew in the simulation.
///
/// A camera shows the cells of an assembly, but neither its labels nor which of its contacts are
/// bonds. Of all assemblies in these cells that the ruleset can make, each simulation draws one,
/// all with the same probability. Where the ruleset makes none (two modules only touch), the bond
/// that is seen for the shortest time is left out, and the parts are looked at again.
class InitialAssemblies {
 public:
  /// Of the model's first ruleset; without one every contact of bonded modules is a bond.
  explicit InitialAssemblies(const Model& model);
  /// `state`: of `start`, nothing latched. `seed`: of the simulation.
  void bond(const Model& model, const BodiesAt& start, std::uint64_t seed, State& state) const;

 private:
  std::vector<Pattern> labelled(const std::vector<Cell>& cells) const;

  std::optional<Labellings> labellings_;
};

}  // namespace lilytank
