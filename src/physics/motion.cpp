#include "motion.hpp"

#include <algorithm>
#include <cmath>

#include "broadphase.hpp"
#include "contact_solver.hpp"
#include "island.hpp"
#include "small_turn.hpp"

namespace lilytank {
namespace {

constexpr double kSliceMotion = 0.016;  // m, most that a point moves between two searches
constexpr double kTooFast = 100;        // m/s, not worth solving
constexpr double kPushShare = 1.2;      // how much of a closing speed a push may pass on
constexpr double kPushSpare = 3e-4;     // m
constexpr double kReach = 1.25;         // contacts are looked for in so many times the closing way
constexpr double kReachSpare = 1e-4;    // m
constexpr double kUndoLimit = 4.5e-4;   // m, below kOverlapLimit by more than rounding
constexpr double kSettled = 2.5e-4;     // m, overlap that settle() accepts
constexpr double kSettleMargin = 1e-3;  // m, what is nearer than this may be pushed
constexpr int kPushRounds = 12;         // sweeps that push overlaps apart after a substep
constexpr int kSettleRounds = 30;
constexpr int kSettleSweeps = 20;

double length(double x, double y) {
  return std::sqrt(x * x + y * y);
}
bool within(double x, double y, double radius) {
  return radius > 0 && x * x + y * y < radius * radius;
}

}  // namespace

// A step is cut into slices, short enough that a search for neighbours stays good for a slice; one
// is enough unless something is very fast. In a slice, assemblies that meet nothing fly freely. The
// others are gathered, with all they could be pushed into, to islands that cannot reach one
// another; each island is moved in substeps of its own length.
struct Motion::Impl {
  const Model* model;
  Broadphase broadphase, latch_range;
  Island island;
  ContactSolver solver;
  double corner;  // m, half a module's diagonal
  // Of the call in progress.
  State* state = nullptr;
  Assemblies* assemblies = nullptr;
  double extra = 0;                      // m, a push moves a body by so much more at most
  std::vector<double> own;               // [slot] m, farthest that a point moves by itself
  std::vector<double> arc;               // [body] m, how far its path leaves a straight line
  std::vector<double> reach;             // [body] m, radius of the circle that it stays in
  std::vector<std::uint8_t> seed, done;  // [slot]
  std::vector<int> local;                // [slot] index into the island, 0: not in it
  std::vector<int> queue;                // slots of the island
  std::vector<std::pair<int, int>> found;

  explicit Impl(const Model& m);
  bool is_module(int body) const { return body < model->module.count; }
  double size_of(int body) const { return is_module(body) ? corner : model->ball.radius; }

  double fastest() const;
  void slice(double h, Tallies& tallies);
  void measure(double h);
  void find_seeds(double h);
  double gap(int i, int j) const;
  void fly(int slot, double h);

  void enter(int slot, double promise);
  void leave(bool twists);
  Near pair_of(int i, int j) const;
  Near wall_of(int i) const;
  double place(int body, double& x, double& y) const;
  void gather(int slot);
  void gather_around(int body);
  void run(double h, Tallies& tallies);
  double keep_good(double deepest, double before, Tallies& tallies);

  Vec2 centre_of(int body) const;
  void pair_up();
  bool settle(int slot);
};

Motion::Impl::Impl(const Model& m)
    : model(&m),
      broadphase(m.bodies(), m.tank.radius, 0.01 + m.module.side),
      latch_range(m.bodies(), m.tank.radius, 0.01 + m.module.side),
      island(m),
      solver(m),
      corner(m.module.side * std::sqrt(0.5)) {
  const auto n = static_cast<std::size_t>(m.bodies());
  for (auto* a : {&own, &arc, &reach}) a->assign(n, 0);
  for (auto* a : {&seed, &done}) a->assign(n, 0);
  local.assign(n, 0);
  queue.reserve(n);
  found.reserve(std::min(n * n / 2, 8 * n));
}

// Greatest speed of any point, m/s; NaN if there is one.
double Motion::Impl::fastest() const {
  double most = 0;
  for (const int slot : assemblies->live) {
    const double speed = length(state->vx[slot], state->vy[slot]) +
                         assemblies->reach[slot] * std::fabs(state->omega[slot]);
    if (!(speed < kTooFast)) return speed;
    most = std::max(most, speed);
  }
  return most;
}

// Twists of the bodies, and how far they may get within h seconds.
void Motion::Impl::measure(double h) {
  Assemblies& a = *assemblies;
  for (const int slot : a.live) {
    const double vx = state->vx[slot], vy = state->vy[slot], omega = state->omega[slot];
    const double turn = h * std::fabs(omega), way = h * length(vx, vy);
    own[slot] = way + turn * a.reach[slot];
    seed[slot] = done[slot] = 0;
    for (int i = a.first[slot]; i >= 0; i = a.next[i]) {
      const double rx = a.x[i] - state->x[slot], ry = a.y[i] - state->y[slot];
      a.vx[i] = vx - omega * ry;
      a.vy[i] = vy + omega * rx;
      a.omega[i] = omega;
      const bool alone = a.next[i] < 0 && i == slot;
      arc[i] = alone ? 0 : 0.5 * turn * turn * length(rx, ry);
      reach[i] = size_of(i) + arc[i] + (alone ? way : h * length(a.vx[i], a.vy[i]));
    }
  }
}

// A lower bound of the distance of bodies i < j, m.
double Motion::Impl::gap(int i, int j) const {
  const Assemblies& a = *assemblies;
  const double half = 0.5 * model->module.side;
  const auto square = [&](int k) { return Square{a.x[k], a.y[k], {a.c[k], a.s[k]}, half, 0}; };
  const auto disc = [&](int k) { return Disc{a.x[k], a.y[k], model->ball.radius}; };
  if (is_module(j)) return separation(square(i), square(j));
  if (is_module(i)) return separation(square(i), disc(j));
  return separation(disc(i), disc(j));
}

// Marks the assemblies that could meet something if all moved freely, and bounds how much a push
// can add to a body's motion.
void Motion::Impl::find_seeds(double h) {
  const Assemblies& a = *assemblies;
  extra = 0;
  const auto spin = [&](int i) { return is_module(i) ? corner * h * std::fabs(a.omega[i]) : 0; };
  broadphase.build(a.x, a.y, reach);
  broadphase.pairs([&](int i, int j) {
    const int p = state->assembly[i], q = state->assembly[j];
    if (p == q) return;
    const double closing =
        h * length(a.vx[j] - a.vx[i], a.vy[j] - a.vy[i]) + arc[i] + arc[j] + spin(i) + spin(j);
    const double between = gap(i, j);
    if (between > closing) return;
    seed[p] = seed[q] = 1;
    extra = std::max(extra, kPushShare * closing + std::max(-2 * between, 0.0));
  });
  const double tank = model->tank.radius;
  for (const int slot : a.live) {
    if (within(state->x[slot], state->y[slot], tank - a.reach[slot] - own[slot])) continue;
    for (int i = a.first[slot]; i >= 0; i = a.next[i]) {
      if (within(a.x[i], a.y[i], tank - reach[i])) continue;
      seed[slot] = 1;
      extra = std::max(extra, kPushShare * own[slot]);
    }
  }
  extra += kPushSpare;
}

void Motion::Impl::fly(int slot, double h) {
  state->x[slot] += h * state->vx[slot];
  state->y[slot] += h * state->vy[slot];
  if (state->omega[slot] == 0) return;
  const Rot r = turned_by({state->c[slot], state->s[slot]}, h * state->omega[slot]);
  state->c[slot] = r.c, state->s[slot] = r.s;
}

void Motion::Impl::enter(int slot, double promise) {
  Mover m;
  m.slot = slot;
  m.pose = {state->x[slot], state->y[slot], {state->c[slot], state->s[slot]}};
  m.twist = {state->vx[slot], state->vy[slot], state->omega[slot]};
  m.mass = assemblies->mass[slot], m.inertia = assemblies->inertia[slot];
  m.inv_mass = 1 / m.mass, m.inv_inertia = m.inertia > 0 ? 1 / m.inertia : 0;
  m.reach = assemblies->reach[slot];
  m.promise = promise;
  m.start = m.good = m.pose;
  local[slot] = island.add(m);
  queue.push_back(slot);
}

// Writes the island's movers back to the state.
void Motion::Impl::leave(bool twists) {
  for (const Mover& m : island.movers()) {
    if (m.slot < 0) continue;
    state->x[m.slot] = m.pose.x, state->y[m.slot] = m.pose.y;
    state->c[m.slot] = m.pose.r.c, state->s[m.slot] = m.pose.r.s;
    if (!twists) continue;
    state->vx[m.slot] = m.twist.vx, state->vy[m.slot] = m.twist.vy;
    state->omega[m.slot] = m.twist.omega;
  }
}

// A body's centre in its assembly's frame; returns how far that is from the centre of mass.
double Motion::Impl::place(int body, double& x, double& y) const {
  const int slot = state->assembly[body];
  x = state->cell_x[body] * model->module.side - assemblies->centre_x[slot];
  y = state->cell_y[body] * model->module.side - assemblies->centre_y[slot];
  return x == 0 && y == 0 ? 0 : length(x, y);
}

Near Motion::Impl::pair_of(int i, int j) const {
  if (i > j) std::swap(i, j);
  Near near;
  near.a = local[state->assembly[i]], near.b = local[state->assembly[j]];
  near.kind = is_module(j)   ? PairKind::squares
              : is_module(i) ? PairKind::square_disc
                             : PairKind::discs;
  near.order_a = i, near.order_b = j;
  near.inner_a = assemblies->inner[i], near.inner_b = assemblies->inner[j];
  near.arm_a = place(i, near.ax, near.ay), near.arm_b = place(j, near.bx, near.by);
  return near;
}

Near Motion::Impl::wall_of(int i) const {
  Near near;
  near.b = local[state->assembly[i]];
  near.kind = is_module(i) ? PairKind::wall_square : PairKind::wall_disc;
  near.order_a = -1, near.order_b = i;
  near.arm_b = place(i, near.bx, near.by);
  return near;
}

// Adds what body i may meet in this slice, pushes included.
void Motion::Impl::gather_around(int i) {
  const Assemblies& a = *assemblies;
  const int slot = state->assembly[i];
  const double promise = own[slot] + extra;
  if (!within(a.x[i], a.y[i], model->tank.radius - size_of(i) - promise)) island.add(wall_of(i));
  broadphase.around(i, size_of(i) + promise + extra, [&](int j) {
    const int other = state->assembly[j];
    if (other == slot || done[other]) return;
    if (gap(std::min(i, j), std::max(i, j)) > promise + own[other] + extra) return;
    if (local[other] == 0) enter(other, own[other] + extra);
    island.add(pair_of(i, j));
  });
}

// The island of an assembly.
void Motion::Impl::gather(int slot) {
  island.clear();
  queue.clear();
  enter(slot, own[slot] + extra);
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const int from = queue[k];
    for (int i = assemblies->first[from]; i >= 0; i = assemblies->next[i]) gather_around(i);
    done[from] = 1;
  }
  for (const int each : queue) local[each] = 0;
  island.sort_pairs();
}

// Pushes overlaps apart; what that cannot help is put back to where it was good. A start that was
// worse than the limit (poses given by a user) may only get better. Returns the deepest overlap.
double Motion::Impl::keep_good(double deepest, double before, Tallies& tallies) {
  if (deepest > kSlop) {
    island.push_apart(kPushRounds);
    deepest = island.survey();
  }
  const double limit = std::max(kUndoLimit, before);
  if (deepest > limit || island.breaks_promise()) {
    tallies.moves_undone += island.put_back(limit);
    deepest = island.survey();
  }
  island.accept();
  return deepest;
}

// Moves the island by h seconds.
void Motion::Impl::run(double h, Tallies& tallies) {
  double deepest = island.survey();
  if (deepest > kSlop) deepest = keep_good(deepest, deepest, tallies);
  for (double left = h; left > 0;) {
    const Pace pace = island.pace(left);
    const double part = pace.longest < left ? left / (std::floor(left / pace.longest) + 1) : left;
    const bool free = pace.free_time >= part;
    const double step = free ? std::min(pace.free_time, left) : part;
    const bool met =
        !free && solver.approach(island, kReach * pace.fastest * step + kReachSpare, step);
    island.move(step);
    if (met) solver.rebound(island, step);
    left = step < left ? left - step : 0;
    deepest = keep_good(island.survey(), deepest, tallies);
  }
  tallies.deepest_overlap = std::max(tallies.deepest_overlap, deepest);
}

void Motion::Impl::slice(double h, Tallies& tallies) {
  measure(h);
  find_seeds(h);
  for (const int slot : assemblies->live) {
    if (!seed[slot] || done[slot]) continue;
    gather(slot);
    run(h, tallies);
    leave(true);
  }
  for (const int slot : assemblies->live) {
    if (!done[slot]) fly(slot, h);
  }
  derive_poses(*model, *state, *assemblies);
}

// The centre of a body: on its way with the island, or where it lies.
Vec2 Motion::Impl::centre_of(int body) const {
  const int index = local[state->assembly[body]];
  if (index == 0) return {assemblies->x[body], assemblies->y[body]};
  double x = 0, y = 0;
  place(body, x, y);
  const Pose& pose = island.movers()[index].pose;
  return Vec2(pose.x, pose.y) + rotate(pose.r, Vec2(x, y));
}

// All pairs of the island's movers with one another and with what is near them now, which joins the
// island.
void Motion::Impl::pair_up() {
  island.forget_pairs();
  const std::size_t count = queue.size();
  for (std::size_t k = 0; k < count; ++k) {
    const int slot = queue[k];
    for (int i = assemblies->first[slot]; i >= 0; i = assemblies->next[i]) {
      const Vec2 at = centre_of(i);
      if (!within(at.x(), at.y(), model->tank.radius - size_of(i) - kSettleMargin))
        island.add(wall_of(i));
      for (int j = 0; j < model->bodies(); ++j) {
        const int other = state->assembly[j], index = local[other];
        if (other == slot || (index > 0 && index <= static_cast<int>(k))) continue;
        const double near = size_of(i) + size_of(j) + kSettleMargin;
        if ((centre_of(j) - at).squaredNorm() > near * near) continue;
        if (index == 0) enter(other, 0);
        island.add(pair_of(i, j));
      }
    }
  }
  island.sort_pairs();
}

bool Motion::Impl::settle(int slot) {
  island.clear();
  queue.clear();
  enter(slot, 0);
  bool settled = false;
  for (int round = 0; round < kSettleRounds && !settled; ++round) {
    if (round > 0) island.push_apart(kSettleSweeps);
    pair_up();
    settled = island.survey() <= kSettled;
  }
  for (const int each : queue) local[each] = 0;
  if (!settled) return false;
  leave(false);
  derive_poses(*model, *state, *assemblies);
  return true;
}

Motion::Motion(const Model& model) : impl_(std::make_unique<Impl>(model)) {}
Motion::~Motion() = default;
Motion::Motion(Motion&&) noexcept = default;

void Motion::advance(State& state, Assemblies& assemblies, Tallies& tallies) {
  Impl& m = *impl_;
  m.state = &state, m.assemblies = &assemblies;
  for (const int slot : assemblies.live) {
    if (!m.is_module(slot)) state.omega[slot] = 0;
  }
  const double fastest = m.fastest(), dt = m.model->dt;
  if (!(fastest < kTooFast)) return;
  const int slices = 1 + static_cast<int>(fastest * dt / kSliceMotion);
  for (int k = 0; k < slices; ++k) m.slice(dt / slices, tallies);
}

bool Motion::settle(State& state, Assemblies& assemblies, int slot) {
  Impl& m = *impl_;
  m.state = &state, m.assemblies = &assemblies;
  return m.settle(slot);
}

std::span<const std::pair<int, int>> Motion::near_pairs(const Assemblies& assemblies,
                                                        double distance) {
  Impl& m = *impl_;
  const auto n = static_cast<std::size_t>(m.model->module.count);
  std::fill(m.reach.begin(), m.reach.end(), 0.5 * distance);
  m.found.clear();
  const std::span<const double> x = assemblies.x, y = assemblies.y, radius = m.reach;
  m.latch_range.build(x.first(n), y.first(n), radius.first(n));
  m.latch_range.pairs([&](int i, int j) { m.found.emplace_back(i, j); });
  return m.found;
}

}  // namespace lilytank
