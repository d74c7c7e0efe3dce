#include "motion.hpp"

#include <algorithm>
#include <cmath>

#include "broadphase.hpp"
#include "island_builder.hpp"
#include "island_stepper.hpp"
#include "settle.hpp"
#include "small_turn.hpp"

namespace lilytank {
namespace {

constexpr double kSliceMotion = 0.02;  // m, most that a point moves between two searches
constexpr double kTooFast = 100;       // m/s, not worth solving
constexpr double kLinkSpare = 3e-4;    // m, pairs that miss by less are watched too
constexpr double kPushShare = 1.2;     // how much of a closing speed a push may pass on
constexpr double kPushSpare = 3e-4;    // m
constexpr int kCrowd = 12;             // links of an island in which a push surely reaches others
constexpr double kNoPromise = 1e9;     // m

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
  Broadphase broadphase, latch_range;
  IslandBuilder builder;
  IslandStepper stepper;
  State* state = nullptr;  // of the call in progress
  Assemblies* assemblies = nullptr;
  double extra = 0;       // m, a push moves a body by so much more at most
  double turn_slack = 0;  // m, no body's size + own exceeds its reach by more
  struct Link {
    int i, j;  // bodies; j = -1: the wall
    int next;  // of the same island
  };
  std::vector<Link> links;
  std::vector<double> reach;  // [body] m, radius of the circle that it stays in
  std::vector<double> arc;    // [body] m, how far its path leaves a straight line
  struct Slot {
    Way way = Way::free;
    bool gathered = false;                // by the search in progress
    int root = 0;                         // the island's lowest slot, or on the way there
    int head = -1, tail = -1, count = 0;  // links of the island with this root
    double own = 0;                       // m, farthest that a point moves by itself
    double strayed = 0;                   // m
    Pose pose;                            // at the end of the slice
    Twist twist;
  };
  std::vector<Slot> slots;
  std::vector<std::pair<int, int>> found;

  explicit Impl(const Model& m);
  double fastest_way() const;
  void slice(double h, Tallies& tallies);
  void measure(double h);
  double widening(int body, double h) const;
  double clearance(int i, int j, double h) const;
  double wall_clearance(int body, double h) const;
  void find_links(double h);
  int root_of(int slot);
  void gather_course(int root);
  void gather_wide(int slot, double h);
  void gather_around(int body, double h);
  void run(double h, Way way, Tallies& tallies);
  bool kept_clear(double h);
  Pose flown(int slot, double h) const;
  void finish(double h);
};

Motion::Impl::Impl(const Model& m)
    : model(&m),
      broadphase(m.bodies(), m.tank.radius, 0.01 + m.module.side),
      latch_range(m.bodies(), m.tank.radius, 0.01 + m.module.side),
      builder(m),
      stepper(m) {
  const auto n = static_cast<std::size_t>(m.bodies());
  reach.assign(n, 0), arc.assign(n, 0);
  slots.assign(n, {});
  links.reserve(std::min(n * (n + 1) / 2, 10 * n));
  found.reserve(std::min(n * n / 2, 8 * n));
}

// Upper bound on how far any point moves in a step, m; more than kTooFast allows, or NaN, if
// anything is too fast.
double Motion::Impl::fastest_way() const {
  double most = 0;
  for (const int slot : assemblies->live) {
    const double speed = std::fabs(state->vx[slot]) + std::fabs(state->vy[slot]) +
                         assemblies->reach[slot] * std::fabs(state->omega[slot]);
    if (!(speed < kTooFast)) return speed * model->dt;
    most = std::max(most, speed);
  }
  return most * model->dt;
}

// Twists of the bodies, and how far they may get within h seconds.
void Motion::Impl::measure(double h) {
  Assemblies& a = *assemblies;
  turn_slack = 0;
  for (const int slot : a.live) {
    const double vx = state->vx[slot], vy = state->vy[slot], omega = state->omega[slot];
    const double turn = h * std::fabs(omega), way = h * length(vx, vy);
    Slot& s = slots[slot];
    s.way = Way::free, s.gathered = false;
    s.root = slot, s.head = -1, s.count = 0;
    s.own = way + turn * a.reach[slot];
    turn_slack = std::max(turn_slack, 2 * turn * a.reach[slot]);
    s.strayed = 0;
    for (int i = a.first[slot]; i >= 0; i = a.next[i]) {
      a.vx[i] = vx, a.vy[i] = vy, a.omega[i] = omega;
      arc[i] = 0, reach[i] = builder.size_of(i) + way;
      if (i == slot && a.next[i] < 0) break;
      const double rx = a.x[i] - state->x[slot], ry = a.y[i] - state->y[slot];
      a.vx[i] -= omega * ry, a.vy[i] += omega * rx;
      arc[i] = 0.5 * turn * turn * length(rx, ry);
      reach[i] = builder.size_of(i) + arc[i] + h * length(a.vx[i], a.vy[i]);
    }
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
  const Assemblies& a = *assemblies;
  const Gap gap = builder.gap(i, j);
  const double along = gap.nx * (a.vx[j] - a.vx[i]) + gap.ny * (a.vy[j] - a.vy[i]);
  return gap.size - std::max(0.0, widening(i, h) + widening(j, h) + arc[i] + arc[j] - h * along);
}

// The same between body i and the wall: distance from the centre is greatest at an end of a
// straight way.
double Motion::Impl::wall_clearance(int i, double h) const {
  const double end = builder.wall_gap(i, h * assemblies->vx[i], h * assemblies->vy[i]);
  const double turn = builder.is_module(i) ? h * std::fabs(assemblies->omega[i]) : 0;
  return std::min(builder.wall_gap(i, 0, 0), end) - turn * builder.size_of(i) - arc[i];
}

int Motion::Impl::root_of(int slot) {
  while (slots[slot].root != slot) slot = slots[slot].root = slots[slots[slot].root].root;
  return slot;
}

// Links what would meet, or nearly, on its course, and bounds how much a push can add to a motion.
void Motion::Impl::find_links(double h) {
  const Assemblies& a = *assemblies;
  extra = 0;
  links.clear();
  for (const int slot : a.live) {
    const double rim = model->tank.radius - kLinkSpare - a.reach[slot] - slots[slot].own;
    if (within(state->x[slot], state->y[slot], rim)) continue;
    for (int i = a.first[slot]; i >= 0; i = a.next[i]) {
      if (wall_clearance(i, h) > kLinkSpare) continue;
      links.push_back({i, -1, -1});
      extra =
          std::max(extra, kPushShare * slots[slot].own - std::min(0.0, 2 * wall_clearance(i, 0)));
    }
  }
  broadphase.build(a.x, a.y, reach);
  broadphase.pairs(kLinkSpare, [&](int i, int j) {
    const int p = builder.slot_of(i), q = builder.slot_of(j);
    if (p == q || clearance(i, j, h) > kLinkSpare) return;
    links.push_back({i, j, -1});
    const double most =
        h * length(a.vx[j] - a.vx[i], a.vy[j] - a.vy[i]) + 1.5 * (widening(i, h) + widening(j, h));
    extra = std::max(extra, kPushShare * most - std::min(0.0, 2 * builder.gap(i, j).size));
    const int root_p = root_of(p), root_q = root_of(q);
    slots[std::max(root_p, root_q)].root = std::min(root_p, root_q);
  });
  extra += kPushSpare;
  for (std::size_t k = 0; k < links.size(); ++k) {
    Slot& root = slots[root_of(builder.slot_of(links[k].i))];
    if (root.head < 0)
      root.head = static_cast<int>(k);
    else
      links[root.tail].next = static_cast<int>(k);
    root.tail = static_cast<int>(k);
    ++root.count;
  }
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
  const double promise = slots[slot].own + extra, size = builder.size_of(i);
  const double room = std::max(size + promise, reach[i] + kLinkSpare);
  if (!within(a.x[i], a.y[i], model->tank.radius - room)) builder.link_wall(i);
  broadphase.around(i, room + extra + turn_slack, [&](int j) {
    const int other = builder.slot_of(j);
    if (other == slot || slots[other].gathered) return;
    const double apart = builder.gap(i, j).size - promise - slots[other].own - extra;
    if (apart > 0 && clearance(i, j, h) > kLinkSpare) return;
    if (!builder.has(other)) builder.enter(other, slots[other].own + extra);
    builder.link(i, j);
  });
}

// The island of all that an assembly, and in turn what it meets, could reach.
void Motion::Impl::gather_wide(int slot, double h) {
  builder.clear();
  builder.enter(slot, slots[slot].own + extra);
  for (std::size_t k = 0; k < builder.slots().size(); ++k) {
    const int from = builder.slots()[k];
    for (int i = assemblies->first[from]; i >= 0; i = assemblies->next[i]) gather_around(i, h);
    slots[from].gathered = true;
  }
  builder.island().sort_pairs();
}

// Moves the island by h seconds and notes where its members end.
void Motion::Impl::run(double h, Way way, Tallies& tallies) {
  stepper.run(builder.island(), h, tallies);
  for (const Mover& m : builder.island().movers()) {
    if (m.slot < 0) continue;
    Slot& s = slots[m.slot];
    s.way = way, s.pose = m.pose, s.twist = m.twist, s.strayed = m.strayed;
  }
}

// True if no member of the island that was run last strayed so far that it could have met something
// that it is not linked with. (What is in a wide island keeps away by itself.)
bool Motion::Impl::kept_clear(double h) {
  const Assemblies& a = *assemblies;
  for (const int slot : builder.slots()) {
    const double strayed = slots[slot].strayed;
    if (strayed == 0) continue;
    if (strayed > extra) return false;
    bool clear = true;
    for (int i = a.first[slot]; i >= 0 && clear; i = a.next[i]) {
      const double from_wall = wall_clearance(i, h);
      clear = from_wall <= kLinkSpare || from_wall > strayed;
      broadphase.around(i, reach[i] + strayed + extra, [&](int j) {
        const int other = builder.slot_of(j);
        if (other == slot || slots[other].way == Way::wide) return;
        const double spare = clearance(i, j, h);
        if (spare > kLinkSpare && spare <= strayed + slots[other].strayed) clear = false;
      });
    }
    if (!clear) return false;
  }
  return true;
}

// An assembly's pose after h seconds on its course.
Pose Motion::Impl::flown(int slot, double h) const {
  const Rot r{state->c[slot], state->s[slot]};
  const double omega = state->omega[slot];
  return {state->x[slot] + h * state->vx[slot], state->y[slot] + h * state->vy[slot],
          omega == 0 ? r : turned_by(r, h * omega)};
}

// Writes the end of the slice to the state and the bodies.
void Motion::Impl::finish(double h) {
  Assemblies& a = *assemblies;
  for (const int slot : a.live) {
    const Slot& s = slots[slot];
    const Pose pose = s.way == Way::free ? flown(slot, h) : s.pose;
    state->x[slot] = pose.x, state->y[slot] = pose.y;
    state->c[slot] = pose.r.c, state->s[slot] = pose.r.s;
    if (s.way != Way::free) {
      state->vx[slot] = s.twist.vx, state->vy[slot] = s.twist.vy;
      state->omega[slot] = s.twist.omega;
    } else if (a.next[slot] < 0 && state->turn[slot] == 0) {  // alone: its twist is there already
      a.x[slot] = pose.x, a.y[slot] = pose.y, a.c[slot] = pose.r.c, a.s[slot] = pose.r.s;
      continue;
    }
    derive_poses(*model, *state, slot, a);
  }
}

void Motion::Impl::slice(double h, Tallies& tallies) {
  measure(h);
  find_links(h);
  for (const int root : assemblies->live) {
    if (slots[root].head < 0 || slots[root].gathered) continue;
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
  const double way = m.fastest_way(), dt = m.model->dt;
  if (!(way < kTooFast * dt)) return;
  const int slices = 1 + static_cast<int>(way / kSliceMotion);
  for (int k = 0; k < slices; ++k) m.slice(dt / slices, tallies);
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
  return true;
}

std::span<const std::pair<int, int>> Motion::near_pairs(const Assemblies& assemblies,
                                                        double distance) {
  Impl& m = *impl_;
  const auto n = static_cast<std::size_t>(m.model->module.count);
  std::fill(m.reach.begin(), m.reach.end(), 0.5 * distance);
  m.found.clear();
  const std::span<const double> x = assemblies.x, y = assemblies.y, radius = m.reach;
  m.latch_range.build(x.first(n), y.first(n), radius.first(n));
  m.latch_range.pairs(0, [&](int i, int j) { m.found.emplace_back(i, j); });
  return m.found;
}

}  // namespace lilytank
