#include "lilytank/world.hpp"

#include <cmath>

#include "control/controller.hpp"
#include "forces/force_sum.hpp"
#include "physics/assembly.hpp"
#include "physics/motion.hpp"

namespace lilytank {
namespace {
constexpr float kFastest = 20;  // m/s; beyond it a world counts as diverged
}

struct World::Impl {
  const Model* model;
  mutable State state;            // poses and twists are those of `bodies` unless `stale`
  mutable Assemblies assemblies;  // the same
  mutable bool stale = false;
  Bodies bodies;
  Motion motion;
  Controller controller;
  ForceSum forces;
  std::vector<Event> events;
  Kinematics kinematics;
  float linear = 0, angular = 0;  // shares of twists lost at the end of a step
  RunStatus status = RunStatus::ok;
  Divergence divergence;
  Tallies tallies;

  Impl(const Model& m, State s)
      : model(&m), state(std::move(s)), bodies(m), motion(m), controller(m), forces(m) {
    assemblies.resize(m);
    derive(m, state, assemblies);
    take_over();
    events.reserve(64 + 8 * static_cast<std::size_t>(m.module.count));
    kinematics = {assemblies.x,  assemblies.y,     assemblies.c,       assemblies.s,  assemblies.vx,
                  assemblies.vy, assemblies.omega, assemblies.covered, m.module.count};
    const Decay decay = total_decay(m.forces, m.dt);
    linear = static_cast<float>(1 - decay.linear), angular = static_cast<float>(1 - decay.angular);
  }

  // The state was set from outside: rounds it to float32.
  void take_over() {
    bodies.load(state, assemblies);
    stale = true;
    fetch();
    tallies.deepest_overlap = deepest_overlap(*model, assemblies);
  }
  void fetch() const {
    if (stale) bodies.save(state, assemblies);
    stale = false;
  }

  StepContext now() const {
    const FlowField* field =
        state.field == 0 ? model->field.get() : model->other_fields[state.field - 1].get();
    return {.time = state.step * model->dt,
            .step = state.step,
            .gust = state.step / model->steps_per_tick,
            .seed = state.seed,
            .gusts = !model->expected,
            .expected = model->expected,
            .field = field};
  }
  FloatBodies float_bodies() {
    const Bodies& b = bodies;
    return {b.x,       b.y,  b.c,  b.s,      b.vx,      b.vy,   b.omega,
            b.covered, b.fx, b.fy, b.torque, b.modules, b.count};
  }

  bool begin_step(Movers& movers);
  void end_step(int stalled);
  bool kick();
  void blame();
};

// Members' wrenches become their assembly's change of twist, about its centre of mass. False if
// something is too fast, or not a number.
bool World::Impl::kick() {
  const auto dt = static_cast<float>(model->dt);
  Bodies& b = bodies;
  const bool good = kick_all(b, dt, kFastest);
  bool groups_good = true;
  for (Compound& g : b.groups) {
    float fx = 0, fy = 0, torque = 0;
    for (int i = g.slot; i >= 0; i = assemblies.next[i]) {
      const float u = b.fx[i], v = b.fy[i];
      fx += u, fy += v, torque += b.torque[i] + (b.arm_x[i] * v - b.arm_y[i] * u);
    }
    g.vx += dt * g.inv_mass * fx, g.vy += dt * g.inv_mass * fy;
    g.omega += dt * g.inv_inertia * torque;
    const float rim = g.omega * g.reach;
    groups_good = groups_good && g.vx * g.vx + g.vy * g.vy + rim * rim <= kFastest * kFastest;
    b.turn_members(g, assemblies);
  }
  if (good) return groups_good;
  // A member alone could be faster than its assembly.
  for (int i = 0; i < b.count; ++i) {
    if (b.group_of(b.slot[static_cast<std::size_t>(i)]) != nullptr) continue;
    const float rim = b.omega[i] * b.size[i];
    if (!(b.vx[i] * b.vx[i] + b.vy[i] * b.vy[i] + rim * rim <= kFastest * kFastest)) return false;
  }
  return groups_good;
}

// The worst body and the term with the largest force on it, from the wrenches of this step.
void World::Impl::blame() {
  fetch();
  // Where the forces were: the kick left the twists before it here.
  for (int i = 0; i < bodies.count; ++i) {
    assemblies.vx[i] = static_cast<double>(bodies.to_x[i]);
    assemblies.vy[i] = static_cast<double>(bodies.to_y[i]);
    assemblies.omega[i] = static_cast<double>(bodies.to_c[i]);
  }
  std::vector<Wrench> wrenches(static_cast<std::size_t>(model->bodies()));
  StepContext moment = now();
  forces.perturb_flow(kinematics, moment);
  const auto badness = [&](int slot) {
    const double size = std::fabs(state.vx[slot]) + std::fabs(state.vy[slot]) +
                        std::fabs(state.omega[slot]) * assemblies.reach[slot];
    return size == size ? size : 1e300;
  };
  int worst = assemblies.live.empty() ? 0 : assemblies.live.front();
  for (const int slot : assemblies.live) {
    if (badness(slot) > badness(worst)) worst = slot;
  }
  divergence = {moment.step, worst, "none", 0};
  for (const ActiveForce& force : model->forces) {
    std::fill(wrenches.begin(), wrenches.end(), Wrench{});
    force.term->add(*model, kinematics, moment, force.p, wrenches);
    double size = 0;
    for (int i = assemblies.first[worst]; i >= 0; i = assemblies.next[i]) {
      const double s = std::sqrt(wrenches[i].fx * wrenches[i].fx + wrenches[i].fy * wrenches[i].fy);
      size = std::fmax(size, s == s ? s : 1e300);
    }
    if (size > divergence.size) divergence.force = force.term->name(), divergence.size = size;
  }
}

World::World(const Model& model, std::uint64_t seed) : World(model, initial_state(model, seed)) {}
World::World(const Model& model, State state)
    : impl_(std::make_unique<Impl>(model, std::move(state))) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

void World::go_on_from(const State& state) {
  Impl& w = *impl_;
  w.state = state;
  derive(*w.model, w.state, w.assemblies);
  w.motion.forget();
  w.events.clear();
  w.status = RunStatus::ok, w.divergence = {}, w.tallies = {};
  w.take_over();
}

// Forces, controllers and velocities; false if there is nothing to move.
bool World::Impl::begin_step(Movers& movers) {
  if (status != RunStatus::ok) return false;
  events.clear();
  if (forces.needs_doubles()) fetch();
  forces(float_bodies(), kinematics, now());
  if (state.step % model->steps_per_tick == 0)
    controller.tick(state, assemblies, bodies, motion, movers, events, tallies);
  stale = true;
  if (kick()) return true;
  blame();
  status = RunStatus::diverged;
  return false;
}

// `stalled`: as InMotion::stalled.
void World::Impl::end_step(int stalled) {
  if (stalled >= 0) {
    divergence = {state.step, stalled, kStalled, static_cast<double>(kMostWork)};
    status = RunStatus::diverged;
    return;
  }
  ++state.step;
}

struct Batch::Impl {
  Movers movers;
  std::vector<World::Impl*> going;
  std::vector<InMotion> moving;

  void add(World::Impl& w) {
    if (!w.begin_step(movers)) return;
    going.push_back(&w);
    moving.push_back({&w.motion, &w.bodies, &w.assemblies, &w.tallies, w.linear, w.angular});
  }
};

Batch::Batch() : impl_(std::make_unique<Impl>()) {}
Batch::Batch(Batch&&) noexcept = default;
Batch& Batch::operator=(Batch&&) noexcept = default;
Batch::~Batch() = default;

void Batch::step(std::span<World* const> worlds) {
  Impl& b = *impl_;
  b.going.clear(), b.moving.clear();
  for (World* world : worlds) b.add(*world->impl_);
  b.movers.advance(b.moving);
  for (std::size_t i = 0; i < b.going.size(); ++i) b.going[i]->end_step(b.moving[i].stalled);
}

RunStatus World::step() {
  static thread_local Batch alone;  // scratch memory, which need not be every world's own
  World* one = this;
  alone.step({&one, 1});
  return impl_->status;
}

RunStatus World::status() const {
  return impl_->status;
}

const Model& World::model() const {
  return *impl_->model;
}
const State& World::state() const {
  impl_->fetch();
  return impl_->state;
}
const State& World::firmware() const {
  return impl_->state;
}
std::int64_t World::steps() const {
  return impl_->state.step;
}
double World::time() const {
  return impl_->state.step * impl_->model->dt;
}
const Kinematics& World::kinematics() const {
  impl_->fetch();
  return impl_->kinematics;
}
std::span<const Event> World::events() const {
  return impl_->events;
}
const Divergence& World::divergence() const {
  return impl_->divergence;
}
const Tallies& World::tallies() const {
  return impl_->tallies;
}

}  // namespace lilytank
