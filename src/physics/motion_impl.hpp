// The working parts of Motion: what motion.cpp and motion_links.cpp share.
#pragma once
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "island_builder.hpp"
#include "island_stepper.hpp"
#include "motion.hpp"
#include "neighbours.hpp"
#include "settle.hpp"

namespace lilytank {

constexpr double kLinkSpare = 3e-4;   // m, pairs that miss by less are watched too
constexpr double kStraySpare = 4e-3;  // m, straying that the search for neighbours allows for

inline bool within(double x, double y, double radius) {
  return radius > 0 && x * x + y * y < radius * radius;
}

// How an assembly gets through a slice.
enum class Way : std::uint8_t {
  free,    // by its twist; meets nothing
  course,  // in an island of those that would meet on their courses; strayed by a known amount
  wide,    // in an island of all that could be reached, within its motion bound
};

// A step is cut into slices, short enough that one search for neighbours serves a slice; one slice
// is enough unless something is very fast. In a slice
// 1. pairs that would meet if everything kept its twist are linked, linked assemblies form islands,
//    and all else flies freely;
// 2. each island is moved apart from the others, in substeps of its own length, and notes how far
//    pushes made its members stray from their courses;
// 3. if one strayed so far that it could have met something outside, its island is taken back and
//    gathered anew with all that any push could reach; what is in it keeps within a bounded
//    distance.
// Results are written to the state when all is done, so every island starts from the same moment.
struct Motion::Impl {
  const Model* model;
  Neighbours neighbours;
  bool searched = false;  // neighbours are those of the poses as they are
  IslandBuilder builder;
  IslandStepper stepper;
  Settling settling;
  State* state = nullptr;  // of the call in progress
  Assemblies* assemblies = nullptr;
  double largest;    // m, radius of the circle about the largest body
  double way = 0;    // m, no point moves farther by itself in the slice
  double extra = 0;  // m, a push moves a body by so much more at most
  struct Link {
    int i, j;  // bodies; j = -1: the wall
    int next;  // of the same island
  };
  std::vector<Link> links;
  std::vector<double> bound;  // [slot] m, no point of it moves farther by itself in the step
  struct Slot {
    std::int64_t seen = 0;  // the slice in which the rest was set
    Way way = Way::free;
    bool gathered = false;                // by the search in progress
    int root = 0;                         // the island's lowest slot, or on the way there
    int head = -1, tail = -1, count = 0;  // links of the island with this root
    double arc = 0;                       // m, no member's path leaves a straight line by more
    double strayed = 0;                   // m
    Pose pose;                            // at the end of the slice
    Twist twist;
  };
  std::vector<Slot> slots;
  std::vector<int> roots, moved;  // slots with links, and those that an island moved
  std::int64_t number = 0;        // of slices so far
  double most_strayed = 0;        // m, in this slice
  std::vector<std::pair<int, int>> found;

  std::int64_t most_work;  // visits in a step
  int stalled = -1;        // slot of the island that took more

  Impl(const Model& m, std::int64_t most);
  double bound_ways(double h);
  void slice(double h, Tallies& tallies);
  void search(double distance);
  void look_at(int slot, double h);
  double arc(int body) const { return slots[builder.slot_of(body)].arc; }
  double widening(int body, double h) const;
  double clearance(int i, int j, double h) const;
  double clearance(int i, int j, const Gap& gap, double h) const;
  double wall_clearance(int body, double h) const;
  void find_links(double h);
  void link_walls(double h);
  void link_pair(int i, int j, double h);
  void chain_links();
  int root_of(int slot);
  void gather_course(int root);
  void gather_wide(int slot, double h);
  void gather_around(int body, double h);
  void run(double h, Way taken, Tallies& tallies);
  bool kept_clear(double h);
  bool kept_clear(int body, double h);
  void finish(double h);
};

}  // namespace lilytank
