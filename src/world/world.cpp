#include "lilytank/world.hpp"

#include <cmath>

#include "control/controller.hpp"
#include "forces/force_sum.hpp"
#include "physics/assembly.hpp"
#include "physics/motion.hpp"

namespace lilytank {
namespace {
constexpr double kFastest = 20;  // m/s; beyond it a world counts as diverged
}

struct World::Impl {
  const Model* model;
  State state;
  Assemblies assemblies;
  Motion motion;
  Controller controller;
  std::vector<Wrench> wrenches;
  ForceSum forces;
  std::vector<Event> events;
  Kinematics kinematics;
  Decay decay;
  double linear_to_angular = 1;  // decay.linear / decay.angular
  RunStatus status = RunStatus::ok;
  Divergence divergence;
  Tallies tallies;

  Impl(const Model& m, State s)
      : model(&m), state(std::move(s)), motion(m), controller(m), wrenches(m.bodies()), forces(m) {
    assemblies.resize(m);
    derive(m, state, assemblies);
    tallies.deepest_overlap = deepest_overlap(m, assemblies);
    events.reserve(64 + 8 * static_cast<std::size_t>(m.module.count));
    kinematics = {assemblies.x,  assemblies.y,     assemblies.c,       assemblies.s,  assemblies.vx,
                  assemblies.vy, assemblies.omega, assemblies.covered, m.module.count};
    for (const ActiveForce& force : m.forces) {
      const Decay d = force.term->decay(force.p, m.dt);
      decay.linear *= d.linear, decay.angular *= d.angular;
    }
    linear_to_angular = decay.linear / decay.angular;
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

  void kick();
  Wrench sum_of_members(int slot) const;
  void damp();
  bool healthy() const;
  void blame();
};

// Members' wrenches become their assembly's change of twist.
void World::Impl::kick() {
  const double dt = model->dt;
  for (const int slot : assemblies.live) {
    Wrench sum = wrenches[slot];
    if (assemblies.next[slot] >= 0) sum = sum_of_members(slot);
    const double per_mass = dt * assemblies.inverse_mass[slot];
    state.vx[slot] += per_mass * sum.fx;
    state.vy[slot] += per_mass * sum.fy;
    // Balls do not turn: their inverse inertia is 0.
    state.omega[slot] += dt * assemblies.inverse_inertia[slot] * sum.torque;
  }
}

// About the assembly's centre of mass.
Wrench World::Impl::sum_of_members(int slot) const {
  Wrench sum;
  for (int i = assemblies.first[slot]; i >= 0; i = assemblies.next[i]) {
    const Wrench& w = wrenches[i];
    const double dx = assemblies.x[i] - state.x[slot], dy = assemblies.y[i] - state.y[slot];
    sum.fx += w.fx, sum.fy += w.fy;
    sum.torque += w.torque + (dx * w.fy - dy * w.fx);
  }
  return sum;
}

// Multiplies `values` and leaves a copy.
void scale(std::vector<double>& values, double factor, std::vector<double>& copy) {
  double* __restrict to = copy.data();
  double* __restrict v = values.data();
  const std::size_t n = values.size();
  for (std::size_t i = 0; i < n; ++i) to[i] = v[i] = v[i] * factor;
}

// Every member is damped as if alone; the assembly keeps the sum of their momenta.
void World::Impl::damp() {
  scale(state.vx, decay.linear, assemblies.vx);
  scale(state.vy, decay.linear, assemblies.vy);
  for (const int slot : assemblies.groups) {
    const double own = assemblies.own_inertia[slot] * assemblies.inverse_inertia[slot];
    // Below, this is multiplied by decay.angular as all others are.
    state.omega[slot] *= own + (1 - own) * linear_to_angular;
  }
  scale(state.omega, decay.angular, assemblies.omega);
  for (const int slot : assemblies.groups) {
    const double vx = state.vx[slot], vy = state.vy[slot], omega = state.omega[slot];
    for (int i = assemblies.first[slot]; i >= 0; i = assemblies.next[i]) {
      assemblies.vx[i] = vx - omega * (assemblies.y[i] - state.y[slot]);
      assemblies.vy[i] = vy + omega * (assemblies.x[i] - state.x[slot]);
      assemblies.omega[i] = omega;
    }
  }
}

// Written so that a NaN fails it.
bool World::Impl::healthy() const {
  for (const int slot : assemblies.live) {
    const double speed2 = state.vx[slot] * state.vx[slot] + state.vy[slot] * state.vy[slot];
    const double rim = state.omega[slot] * assemblies.reach[slot];
    if (!(speed2 + rim * rim <= kFastest * kFastest)) return false;
  }
  return true;
}

// The worst body and the term with the largest force on it, from the wrenches of this step.
void World::Impl::blame() {
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
}

RunStatus World::step() {
  Impl& w = *impl_;
  if (w.status != RunStatus::ok) return w.status;
  w.events.clear();
  w.forces(w.kinematics, w.now(), w.wrenches);
  if (w.state.step % w.model->steps_per_tick == 0)
    w.controller.tick(w.state, w.assemblies, w.motion, w.events, w.tallies);
  w.kick();
  if (!w.healthy()) {
    w.blame();
    return w.status = RunStatus::diverged;
  }
  if (const int slot = w.motion.advance(w.state, w.assemblies, w.tallies); slot >= 0) {
    w.divergence = {w.state.step, slot, kStalled, static_cast<double>(kMostWork)};
    return w.status = RunStatus::diverged;
  }
  w.damp();
  ++w.state.step;
  return w.status;
}

const Model& World::model() const {
  return *impl_->model;
}
const State& World::state() const {
  return impl_->state;
}
double World::time() const {
  return impl_->state.step * impl_->model->dt;
}
const Kinematics& World::kinematics() const {
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
