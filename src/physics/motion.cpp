#include "motion.hpp"

#include <algorithm>
#include <cmath>

#include "fly.hpp"
#include "motion_impl.hpp"

namespace lilytank {
namespace {

constexpr double kSliceMotion = 0.02;  // m, most that a point moves between two searches
constexpr double kTooFast = 100;       // m/s, not worth solving
constexpr int kCrowd = 12;             // links of an island in which a push surely reaches others
constexpr double kNoPromise = 1e9;     // m
constexpr double kUsualWay = 8e-3;     // m, seldom exceeded in a step: what a search for latches
                                       // allows for, so that contacts can use it too

}  // namespace

Motion::Impl::Impl(const Model& m, std::int64_t most)
    : model(&m),
      neighbours(m.bodies(), m.tank.radius),
      builder(m),
      stepper(m),
      settling(m),
      most_work(most) {
  const auto n = static_cast<std::size_t>(m.bodies());
  largest = 0;
  for (int i = 0; i < m.bodies(); ++i) largest = std::max(largest, builder.size_of(i));
  bound.assign(n, 0);
  slots.assign(n, {});
  roots.reserve(n), moved.reserve(2 * n);  // an assembly is moved twice if a trial is taken back
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
  const double motion_bound = bound[slot] + extra, size = builder.size_of(i);
  const double room = size + motion_bound + kLinkSpare;
  if (!within(a.x[i], a.y[i], model->tank.radius - room)) builder.link_wall(i);
  const double needed = room + extra + 3 * way + largest;
  if (needed > neighbours.distance()) search(needed);
  neighbours.around(i, [&](int j) {
    const int other = builder.slot_of(j);
    if (other == slot) return;
    look_at(other, h);
    if (slots[other].gathered) return;
    const double apart = builder.gap(i, j).size - motion_bound - bound[other] - extra;
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
  stepper.run(builder.island(), h, most_work, tallies);
  if (stalled < 0 && builder.island().work > most_work) stalled = builder.slots().front();
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
  if (stalled < 0) finish(h);
}

Motion::Motion(const Model& model, std::int64_t most_work)
    : impl_(std::make_unique<Impl>(model, most_work)) {}
Motion::~Motion() = default;
Motion::Motion(Motion&&) noexcept = default;

int Motion::advance(State& state, Assemblies& assemblies, Tallies& tallies) {
  Impl& m = *impl_;
  m.state = &state, m.assemblies = &assemblies;
  m.builder.begin(state, assemblies);
  for (int ball = m.model->module.count; ball < m.model->bodies(); ++ball) state.omega[ball] = 0;
  const double dt = m.model->dt;
  m.way = m.bound_ways(dt);
  if (!(m.way < kTooFast * dt)) return -1;
  m.stalled = -1;
  const int slices = 1 + static_cast<int>(m.way / kSliceMotion);
  for (int k = 0; k < slices && m.stalled < 0; ++k) {
    if (slices > 1) m.way = m.bound_ways(dt / slices);
    m.slice(dt / slices, tallies);
  }
  m.builder.island().work = 0;
  return m.stalled;
}

bool Motion::settle(State& state, Assemblies& assemblies, int slot) {
  IslandBuilder& builder = impl_->builder;
  builder.begin(state, assemblies);
  if (builder.island().work > impl_->most_work / 4) return false;
  if (!impl_->settling.make_room(assemblies, slot, builder)) return false;
  for (const Mover& m : builder.island().movers()) {
    if (m.slot < 0) continue;
    state.x[m.slot] = m.pose.x, state.y[m.slot] = m.pose.y;
    state.c[m.slot] = m.pose.r.c, state.s[m.slot] = m.pose.r.s;
  }
  derive_poses(*impl_->model, state, assemblies);
  impl_->searched = false;
  return true;
}

void Motion::forget() {
  impl_->searched = false;
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

}  // namespace lilytank
