#include "emulator/initial_assemblies.hpp"

#include <algorithm>
#include <cmath>

#include "lilytank/math.hpp"
#include "lilytank/random.hpp"
#include "lilytank/start.hpp"

namespace lilytank {
namespace {

// Mean times between evaluations. In six runs of chain5 no bond was shorter, and 5 % of the latches
// without a bond were longer, beside 10 times as many bonds.
constexpr double kDecided = 4;
// The seed of the labels must differ from that of the world.
constexpr std::uint64_t kLabelRun = 1u << 21;

// What bonds connect, on a lattice. A module's connector f looks in the direction f + turn.
struct Laid {
  std::vector<int> bodies;
  std::vector<Cell> cells;
  std::vector<int> turns;
  bool fits = true;  // no two modules have one cell, and none has two
};

int quarters(double angle) {
  return static_cast<int>(std::lround(angle / (kPi / 2))) & 3;
}

// Adds body b beside the k-th of the assembly, unless it is there.
void lay(const BodiesAt& start, std::size_t k, int b, Laid& out) {
  const Pose& at = start.pose[static_cast<std::size_t>(out.bodies[k])];
  const Pose& other = start.pose[static_cast<std::size_t>(b)];
  const Vec2 to = unrotate(at.r, {other.x - at.x, other.y - at.y});
  const Cell cell = neighbour(out.cells[k], quarters(std::atan2(to.y(), to.x())) + out.turns[k]);
  const auto known = std::find(out.bodies.begin(), out.bodies.end(), b) - out.bodies.begin();
  const auto taken = std::find(out.cells.begin(), out.cells.end(), cell) - out.cells.begin();
  if (known != taken) out.fits = false;
  if (known < static_cast<std::ptrdiff_t>(out.bodies.size())) return;
  out.bodies.push_back(b), out.cells.push_back(cell);
  out.turns.push_back((out.turns[k] + quarters(angle_of(between(at.r, other.r)))) & 3);
}

Laid laid(const BodiesAt& start, const std::vector<BondedBodies>& bonds, int first) {
  Laid out{{first}, {Cell{}}, {0}};
  for (std::size_t k = 0; k < out.bodies.size(); ++k) {
    for (const BondedBodies& bond : bonds) {
      if (bond.a == out.bodies[k]) lay(start, k, bond.b, out);
      if (bond.b == out.bodies[k]) lay(start, k, bond.a, out);
    }
  }
  return out;
}

bool holds(const Laid& assembly, int body) {
  return std::find(assembly.bodies.begin(), assembly.bodies.end(), body) != assembly.bodies.end();
}

// Every contact a bond, no labels: of modules without a ruleset.
Pattern all_bonded(const std::vector<Cell>& cells) {
  Pattern out;
  for (const Cell& cell : cells) out.push_back({cell, 0, -1, 0});
  for (PatternModule& module : out) {
    for (int d = 0; d < 4; ++d) {
      if (module_at(out, neighbour(module.cell, d)) < out.size()) module.bonds |= 1u << d;
    }
  }
  return out;
}

void add_bonds(const Laid& assembly, const Pattern& labelled, std::vector<StartBond>& bonds) {
  for (std::size_t k = 0; k < labelled.size(); ++k) {
    for (int direction = 0; direction < 2; ++direction) {
      if ((labelled[k].bonds >> direction & 1u) == 0) continue;
      const std::size_t other = module_at(labelled, neighbour(labelled[k].cell, direction));
      bonds.push_back({assembly.bodies[k], (direction - assembly.turns[k]) & 3,
                       assembly.bodies[other], (direction + 2 - assembly.turns[other]) & 3});
    }
  }
}

void set_labels(const Laid& assembly, const Pattern& labelled, State& state) {
  for (std::size_t k = 0; k < labelled.size(); ++k) {
    Firmware& firmware = state.firmware[static_cast<std::size_t>(assembly.bodies[k])];
    const int last = labelled[k].last;
    firmware.label = labelled[k].label;
    firmware.last = static_cast<std::int8_t>(last < 0 ? -1 : (last - assembly.turns[k]) & 3);
  }
}

}  // namespace

InitialAssemblies::InitialAssemblies(const Model& model) {
  if (!model.rulesets.empty()) labellings_.emplace(model.rulesets.front(), model.module.count);
}

std::vector<Pattern> InitialAssemblies::labelled(const std::vector<Cell>& cells) const {
  return labellings_ ? labellings_->of(cells) : std::vector<Pattern>{all_bonded(cells)};
}

void InitialAssemblies::bond(const Model& model, const BodiesAt& start, std::uint64_t seed,
                             State& state) const {
  std::vector<BondedBodies> seen = start.bonds;
  std::erase_if(seen, [&](const BondedBodies& bond) {
    return bond.parts && bond.seconds * model.control.evaluation_rate < kDecided;
  });
  std::stable_sort(seen.begin(), seen.end(), [](const BondedBodies& a, const BondedBodies& b) {
    return a.seconds < b.seconds;
  });
  std::vector<StartBond> bonds;
  std::vector<char> done(start.pose.size(), 0);
  for (int body = 0; body < static_cast<int>(start.pose.size()); ++body) {
    while (done[static_cast<std::size_t>(body)] == 0) {
      const Laid assembly = laid(start, seen, body);
      if (assembly.bodies.size() == 1) break;
      const std::vector<Pattern> found =
          assembly.fits ? labelled(assembly.cells) : std::vector<Pattern>{};
      if (found.empty()) {
        seen.erase(std::find_if(seen.begin(), seen.end(),
                                [&](const BondedBodies& bond) { return holds(assembly, bond.a); }));
        continue;
      }
      const double u = uniform({derived_seed(seed, kLabelRun), Stream::start_pose, 0,
                                static_cast<std::uint32_t>(body), 0});
      const Pattern& one = found[static_cast<std::size_t>(u * static_cast<double>(found.size()))];
      set_labels(assembly, one, state), add_bonds(assembly, one, bonds);
      for (const int member : assembly.bodies) done[static_cast<std::size_t>(member)] = 1;
    }
  }
  make_bonds(model, bonds, state);
}

}  // namespace lilytank
