#include "motion.hpp"

#include <algorithm>
#include <cmath>

#include "fly.hpp"
#include "island_builder.hpp"
#include "island_stepper.hpp"
#include "neighbours.hpp"
#include "settle.hpp"

namespace lilytank {
namespace {

constexpr double kSliceMotion = 0.02;  // m, most that a point moves between two searches
constexpr double kTooFast = 100;       // m/s, not worth solving
constexpr double kLinkSpare = 3e-4;    // m, pairs that miss by less are watched too
constexpr double kPushShare = 1.2;     // how much of a closing speed a push may pass on
constexpr double kPushSpare = 3e-4;    // m
constexpr int kCrowd = 12;             // links of an island in which a push surely reaches others
constexpr double kNoPromise = 1e9;     // m
constexpr double kStraySpare = 4e-3;   // m, straying that the search for neighbours allows for
constexpr double kUsualWay = 8e-3;     // m, seldom exceeded in a step: what a search for latches
                                       // allows for, so that contacts can use it too

double length(double x, double y) {
  return std::sqrt(x * x + y * y);
}
bool within(double x, double y, double radius) {
  return radius > 0 && x * x + y * y < radius * radius;
}

// How an assembly gets through a slice.
enum class Way : std::uint8_t {
  free,    // by its twist; meets nothing
  course,  // in an island of those that would meet on their courses; strayed by a known amount
  wide,    // in an island of all that could be reached, within its promise
};

}  // namespace

// A step is cut into slices, short enough that one search for neighbours serves a slice; one slice
// is enough unless something is very fast. In a slice
// 1. pairs that would meet if everything kept its twist are linked, linked assemblies form islands,
//    and all else flies freely;
// 2. each island is moved apart from the others, in substeps of its own length, and notes how far
//    pushes made its members stray from their courses;
// 3. if one strayed so far that it could have met something outside, its island is taken back and
//    gathered anew with all that any push could reach; what is in it keeps within a promised
//    distance.
// Results are written to the state when all is done, so every island starts from the same moment.
struct Motion::Impl {
  const Model* model;
  Neighbours neighbours;
  bool searched = false;  // neighbours are those of the poses as they are
  IslandBuilder builder;
  IslandStepper stepper;
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

  explicit Impl(const Model& m);
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

Motion::Impl::Impl(const Model& m)
    : model(&m), neighbours(m.bodies(), m.tank.radius), builder(m), stepper(m) {
  const auto n = static_cast<std::size_t>(m.bodies());
  largest = 0;
  for (int i = 0; i < m.bodies(); ++i) largest = std::max(largest, builder.size_of(i));
  bound.assign(n, 0);
  slots.assign(n, {});
  roots.reserve(n), moved.reserve(n);
  links.reserve(std::min(n * (n + 1) / 2, 10 * n));
  found.reserve(std::min(n * n / 2, 8 * n));
}

// Upper bounds on how far any point moves in h seconds, m; returns the largest: more than kTooFast
// allows, or NaN, if anything is too fast.
double Motion::Impl::bound_ways(double h) {
  double most = 0;
  for (const int slot : assemblies->live) {
    const double speed = std::fabs(state->vx[slot]) + std::fabs(state->vy[slot]) +
                         assemblies->reach[slot] * std::fabs(state->omega[slot]);
    if (!(speed < kTooFast)) return h * speed;
    bound[slot] = h * speed;
    most = std::max(most, bound[slot]);
  }
  return most;
}

void Motion::Impl::search(double distance) {
  neighbours.search(assemblies->x, assemblies->y, distance);
  searched = true;
}

// Twists of an assembly's bodies, and how far they leave straight lines within h seconds. Most
// assemblies are far from everything, so this is done for those that are not.
void Motion::Impl::look_at(int slot, double h) {
  Slot& s = slots[slot];
  if (s.seen == number) return;
  Assemblies& a = *assemblies;
  const double vx = state->vx[slot], vy = state->vy[slot], omega = state->omega[slot];
  s.seen = number;
  s.way = Way::free, s.gathered = false;
  s.root = slot, s.head = -1, s.count = 0;
  s.strayed = s.arc = 0;
  a.vx[slot] = vx, a.vy[slot] = vy, a.omega[slot] = omega;
  if (a.next[slot] < 0) return;
  const double turn = h * omega;
  s.arc = 0.5 * turn * turn * a.reach[slot];
  for (int i = slot; i >= 0; i = a.next[i]) {
    a.vx[i] = vx - omega * (a.y[i] - state->y[slot]);
    a.vy[i] = vy + omega * (a.x[i] - state->x[slot]);
    a.omega[i] = omega;
  }
}

// How much wider a body gets, at most, in any direction by its spin, m. A square at angle t to the
// direction is half * (|cos t| + |sin t|) wide, which changes by less than half the side per
// radian.
double Motion::Impl::widening(int i, double h) const {
  return builder.is_module(i) ? 0.5 * model->module.side * h * std::fabs(assemblies->omega[i]) : 0;
}

// No less than this is between bodies i and j, of different assemblies, on their courses, m: the
// gap along a fixed normal closes by their motion along it, and as they turn.
double Motion::Impl::clearance(int i, int j, double h) const {
  return clearance(i, j, builder.gap(i, j), h);
}

double Motion::Impl::clearance(int i, int j, const Gap& gap, double h) const {
  const Assemblies& a = *assemblies;
  const double along = gap.nx * (a.vx[j] - a.vx[i]) + gap.ny * (a.vy[j] - a.vy[i]);
  return gap.size - std::max(0.0, widening(i, h) + widening(j, h) + arc(i) + arc(j) - h * along);
}

// The same between body i and the wall: distance from the centre is greatest at an end of a
// straight way.
double Motion::Impl::wall_clearance(int i, double h) const {
  const double end = builder.wall_gap(i, h * assemblies->vx[i], h * assemblies->vy[i]);
  const double turn = builder.is_module(i) ? h * std::fabs(assemblies->omega[i]) : 0;
  return std::min(builder.wall_gap(i, 0, 0), end) - turn * builder.size_of(i) - arc(i);
}

int Motion::Impl::root_of(int slot) {
  while (slots[slot].root != slot) slot = slots[slot].root = slots[slots[slot].root].root;
  return slot;
}

void Motion::Impl::link_walls(double h) {
  const Assemblies& a = *assemblies;
  for (const int slot : a.live) {
    const double nearest = model->tank.radius - kLinkSpare - a.reach[slot];
    if (within(state->x[slot], state->y[slot], nearest - bound[slot])) continue;
    look_at(slot, h);
    for (int i = a.first[slot]; i >= 0; i = a.next[i]) {
      if (wall_clearance(i, h) > kLinkSpare) continue;
      links.push_back({i, -1, -1});
      extra = std::max(extra, kPushShare * bound[slot] - std::min(0.0, 2 * wall_clearance(i, 0)));
    }
  }
}

void Motion::Impl::link_pair(int i, int j, double h) {
  const Assemblies& a = *assemblies;
  const int p = builder.slot_of(i), q = builder.slot_of(j);
  look_at(p, h), look_at(q, h);
  const Gap gap = builder.gap(i, j);
  if (clearance(i, j, gap, h) > kLinkSpare) return;
  links.push_back({i, j, -1});
  const double most =
      h * length(a.vx[j] - a.vx[i], a.vy[j] - a.vy[i]) + 1.5 * (widening(i, h) + widening(j, h));
  extra = std::max(extra, kPushShare * most - std::min(0.0, 2 * gap.size));
  const int root_p = root_of(p), root_q = root_of(q);
  slots[std::max(root_p, root_q)].root = std::min(root_p, root_q);
}

// Strings the links of each island together; notes the islands' roots, ascending.
void Motion::Impl::chain_links() {
  for (std::size_t k = 0; k < links.size(); ++k) {
    const int root = root_of(builder.slot_of(links[k].i));
    Slot& s = slots[root];
    if (s.head < 0)
      s.head = static_cast<int>(k), roots.push_back(root);
    else
      links[s.tail].next = static_cast<int>(k);
    s.tail = static_cast<int>(k);
    ++s.count;
  }
  std::sort(roots.begin(), roots.end());
}

// Links what would meet, or nearly, on its course, and bounds how much a push can add to a motion.
void Motion::Impl::find_links(double h) {
  extra = 0;
  links.clear(), roots.clear();
  link_walls(h);
  const double needed = 2 * (largest + way) + kStraySpare;
  if (!searched || needed > neighbours.distance()) search(needed);
  const Assemblies& a = *assemblies;
  for (int i = 0; i < model->bodies(); ++i) {
    const int slot = builder.slot_of(i);
    const double own = builder.size_of(i) + bound[slot] + kLinkSpare;
    neighbours.above(i, [&](int j) {
      const int other = builder.slot_of(j);
      if (other == slot) return;
      if (within(a.x[j] - a.x[i], a.y[j] - a.y[i], own + builder.size_of(j) + bound[other]))
        link_pair(i, j, h);
    });
  }
  if (links.empty()) return;
  extra += kPushSpare;
  chain_links();
}

// The island of what is linked with an assembly.
void Motion::Impl::gather_course(int root) {
  builder.clear();
  for (int k = slots[root].head; k >= 0; k = links[k].next) {
    const Link& link = links[k];
    const int p = builder.slot_of(link.i);
    if (!builder.has(p)) builder.enter(p, kNoPromise);
    if (link.j < 0) {
      builder.link_wall(link.i);
      continue;
    }
    const int q = builder.slot_of(link.j);
    if (!builder.has(q)) builder.enter(q, kNoPromise);
    builder.link(link.i, link.j);
  }
}

// Adds what body i could meet in this slice, pushes included.
void Motion::Impl::gather_around(int i, double h) {
  const Assemblies& a = *assemblies;
  const int slot = builder.slot_of(i);
  const double promise = bound[slot] + extra, size = builder.size_of(i);
  const double room = size + promise + kLinkSpare;
  if (!within(a.x[i], a.y[i], model->tank.radius - room)) builder.link_wall(i);
  const double needed = room + extra + 3 * way + largest;
  if (needed > neighbours.distance()) search(needed);
  neighbours.around(i, [&](int j) {
    const int other = builder.slot_of(j);
    if (other == slot) return;
    look_at(other, h);
    if (slots[other].gathered) return;
    const double apart = builder.gap(i, j).size - promise - bound[other] - extra;
    if (apart > 0 && clearance(i, j, h) > kLinkSpare) return;
    if (!builder.has(other)) builder.enter(other, bound[other] + extra);
    builder.link(i, j);
  });
}

// The island of all that an assembly, and in turn what it meets, could reach.
void Motion::Impl::gather_wide(int slot, double h) {
  builder.clear();
  builder.enter(slot, bound[slot] + extra);
  for (std::size_t k = 0; k < builder.slots().size(); ++k) {
    const int from = builder.slots()[k];
    for (int i = assemblies->first[from]; i >= 0; i = assemblies->next[i]) gather_around(i, h);
    slots[from].gathered = true;
  }
  builder.island().sort_pairs();
}

// Moves the island by h seconds and notes where its members end.
void Motion::Impl::run(double h, Way taken, Tallies& tallies) {
  stepper.run(builder.island(), h, tallies);
  for (const Mover& m : builder.island().movers()) {
    if (m.slot < 0) continue;
    Slot& s = slots[m.slot];
    s.way = taken, s.pose = m.pose, s.twist = m.twist, s.strayed = m.strayed;
    most_strayed = std::max(most_strayed, m.strayed);
    moved.push_back(m.slot);
  }
}

// The same for one body of it.
bool Motion::Impl::kept_clear(int i, double h) {
  const Assemblies& a = *assemblies;
  const int slot = builder.slot_of(i);
  const double strayed = slots[slot].strayed, from_wall = wall_clearance(i, h);
  if (from_wall > kLinkSpare && from_wall <= strayed) return false;
  bool clear = true;
  neighbours.around(i, [&](int j) {
    const int other = builder.slot_of(j);
    const double sizes = builder.size_of(i) + builder.size_of(j) + bound[slot] + bound[other];
    if (other == slot || !within(a.x[j] - a.x[i], a.y[j] - a.y[i], sizes + strayed + most_strayed))
      return;
    look_at(other, h);
    if (slots[other].way == Way::wide) return;
    const double spare = clearance(i, j, h);
    if (spare > kLinkSpare && spare <= strayed + slots[other].strayed) clear = false;
  });
  return clear;
}

// True if no member of the island that was run last strayed so far that it could have met something
// that it is not linked with. (What is in a wide island keeps away by itself.)
bool Motion::Impl::kept_clear(double h) {
  const Assemblies& a = *assemblies;
  for (const int slot : builder.slots()) {
    const double strayed = slots[slot].strayed;
    if (strayed == 0) continue;
    if (strayed > extra) return false;
    if (2 * (largest + way) + strayed + most_strayed > neighbours.distance()) return false;
    for (int i = a.first[slot]; i >= 0; i = a.next[i]) {
      if (!kept_clear(i, h)) return false;
    }
  }
  return true;
}

// Writes the end of the slice to the state and the bodies: everything flies, and what was in an
// island is put where that left it.
void Motion::Impl::finish(double h) {
  Assemblies& a = *assemblies;
  State& s = *state;
  fly({s.x.data(), s.y.data(), s.c.data(), s.s.data(), s.vx.data(), s.vy.data(), s.omega.data(),
       model->bodies(), a.x.data(), a.y.data(), a.c.data(), a.s.data()},
      h);
  for (const int slot : moved) {
    const Slot& end = slots[slot];
    a.x[slot] = end.pose.x, a.y[slot] = end.pose.y;
    a.c[slot] = end.pose.r.c, a.s[slot] = end.pose.r.s;
    s.vx[slot] = end.twist.vx, s.vy[slot] = end.twist.vy, s.omega[slot] = end.twist.omega;
  }
  s.x = a.x, s.y = a.y, s.c = a.c, s.s = a.s;
  a.vx = s.vx, a.vy = s.vy, a.omega = s.omega;
  for (const int slot : a.groups) derive_poses(*model, s, slot, a);
  searched = false;
}

void Motion::Impl::slice(double h, Tallies& tallies) {
  ++number;
  moved.clear();
  most_strayed = 0;
  find_links(h);
  for (const int root : roots) {
    if (slots[root].gathered) continue;
    if (slots[root].count <= kCrowd) {
      Tallies trial = tallies;
      gather_course(root);
      run(h, Way::course, trial);
      if (kept_clear(h)) {
        tallies = trial;
        continue;
      }
    }
    gather_wide(root, h);
    run(h, Way::wide, tallies);
  }
  finish(h);
}

Motion::Motion(const Model& model) : impl_(std::make_unique<Impl>(model)) {}
Motion::~Motion() = default;
Motion::Motion(Motion&&) noexcept = default;

void Motion::advance(State& state, Assemblies& assemblies, Tallies& tallies) {
  Impl& m = *impl_;
  m.state = &state, m.assemblies = &assemblies;
  m.builder.begin(state, assemblies);
  for (int ball = m.model->module.count; ball < m.model->bodies(); ++ball) state.omega[ball] = 0;
  const double dt = m.model->dt;
  m.way = m.bound_ways(dt);
  if (!(m.way < kTooFast * dt)) return;
  const int slices = 1 + static_cast<int>(m.way / kSliceMotion);
  for (int k = 0; k < slices; ++k) {
    if (slices > 1) m.way = m.bound_ways(dt / slices);
    m.slice(dt / slices, tallies);
  }
}

bool Motion::settle(State& state, Assemblies& assemblies, int slot) {
  IslandBuilder& builder = impl_->builder;
  builder.begin(state, assemblies);
  if (!make_room(*impl_->model, assemblies, slot, builder)) return false;
  for (const Mover& m : builder.island().movers()) {
    if (m.slot < 0) continue;
    state.x[m.slot] = m.pose.x, state.y[m.slot] = m.pose.y;
    state.c[m.slot] = m.pose.r.c, state.s[m.slot] = m.pose.r.s;
  }
  derive_poses(*impl_->model, state, assemblies);
  poses_changed();
  return true;
}

std::span<const std::pair<int, int>> Motion::near_pairs(const Assemblies& assemblies,
                                                        double distance) {
  Impl& m = *impl_;
  m.neighbours.search(assemblies.x, assemblies.y,
                      std::max(distance, 2 * (m.largest + kUsualWay) + kStraySpare));
  m.searched = true;
  m.found.clear();
  const int n = m.model->module.count;
  for (int i = 0; i < n; ++i) {
    m.neighbours.above(i, [&](int j) {
      if (j < n &&
          within(assemblies.x[j] - assemblies.x[i], assemblies.y[j] - assemblies.y[i], distance))
        m.found.emplace_back(i, j);
    });
  }
  return m.found;
}

void Motion::poses_changed() {
  impl_->searched = false;
}

}  // namespace lilytank
