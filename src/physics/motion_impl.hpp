// The working parts of Motion: what the files of the motion share.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "encounters.hpp"
#include "island_block.hpp"
#include "motion.hpp"
#include "neighbours.hpp"

namespace lilytank {

constexpr int kFewBodies = 64;  ///< up to so many, bits serve as well as lists of neighbours

/// Two bodies that may meet in a slice, a < b; a = -1: b and the wall.
struct Link {
  int a, b;
  int root;    ///< lowest slot of the island
  bool fresh;  ///< added since islands were last solved
};

/// Where an assembly ends a slice if an island moved it.
struct End {
  std::int64_t slice = 0;  ///< the slice in which the rest was set
  bool moved = false;      ///< elsewhere than by free flight
  float x, y, c, s, vx, vy, omega;
};

/// One world in its slice.
struct Motion::Impl {
  Impl(const Model& m, std::int64_t most);

  void begin(InMotion& world);
  void find_candidates(std::vector<Encounters>& lists, int world);
  void link(int a, int b);
  void find_roots();
  bool linked(int a, int b) const;
  void place_ends();
  void find_strays(std::vector<Encounters>& lists, int world);
  void finish();
  void search(const Bodies& b, double distance);
  PairKind kind_of(int a, int b) const;

  const Model* model;
  std::int64_t most_work;
  Surroundings around;
  ContactParameters contact;
  float largest;  // m, radius of the circle about the largest body
  Neighbours neighbours;
  bool searched = false;            // neighbours are those of the poses as they are
  std::vector<std::uint64_t> bits;  // [i] bit j: body j is near body i; empty for many bodies
  std::vector<std::uint64_t> wall_bits;
  std::vector<RowOf<kBlockLanes>> near_reach;
  float near_distance = -1;
  std::vector<std::pair<int, int>> found;

  // Of the step in progress.
  InMotion* world = nullptr;
  Bodies* bodies = nullptr;
  const Assemblies* assemblies = nullptr;
  int slices = 0;                         // still to go
  std::int64_t work = 0, latch_work = 0;  // visits in this step; those of latches before it
  std::int64_t work_before = 0;           // the present round of islands
  // Of the slice in progress.
  std::int64_t number = 0;
  bool crowded = false;    // many links: pairs that miss by more are linked, too
  std::size_t sorted = 0;  // links that are in order
  float way = 0;           // m, no point moves farther
  std::vector<Link> links;
  std::vector<int> root;   // [slot]
  std::vector<int> local;  // [slot] mover of the island that is being packed; 0: none
  std::vector<End> ends;   // [slot]
  std::vector<int> ended;  // slots that an island had
  std::vector<int> again;  // those of them that were solved last
};

}  // namespace lilytank
