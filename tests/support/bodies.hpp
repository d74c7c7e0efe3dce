// Bodies under the hand: poses and twists set directly, one call of Movers::advance a step, no
// forces.
#pragma once
#include <cmath>
#include <memory>

#include "lilytank/model.hpp"
#include "physics/motion.hpp"

namespace lilytank::test {

/// A model of `modules` and `balls` in a tank of that radius (m), with steps of kTick / k.
inline Model bare_model(int modules, double tank = 0.3, int balls = 0, int k = 1) {
  Model model;
  model.module.count = modules;
  model.ball.count = balls;
  model.tank.radius = tank;
  model.steps_per_tick = k;
  model.dt = kTick / k;
  return model;
}

struct Bodies {
  Model model;
  State state;
  Assemblies assemblies;
  Tallies tallies;
  std::unique_ptr<Motion> motion;
  lilytank::Bodies hot;
  Movers movers;

  explicit Bodies(const Model& m) : model(m), motion(std::make_unique<Motion>(model)), hot(model) {
    const auto n = static_cast<std::size_t>(model.bodies());
    for (auto* a : {&state.x, &state.y, &state.s, &state.vx, &state.vy, &state.omega})
      a->assign(n, 0.0);
    state.c.assign(n, 1.0);
    for (auto* a : {&state.cell_x, &state.cell_y, &state.turn}) a->assign(n, 0);
    for (std::size_t i = 0; i < n; ++i) state.assembly.push_back(static_cast<int>(i));
    state.firmware.resize(static_cast<std::size_t>(model.module.count));
    state.faces.resize(4 * static_cast<std::size_t>(model.module.count));
    assemblies.resize(model);
  }
  Bodies(const Bodies&) = delete;
  Bodies& operator=(const Bodies&) = delete;

  void place(int slot, double x, double y, double angle = 0) {
    const Rot r = rotation(angle);
    state.x[slot] = x, state.y[slot] = y, state.c[slot] = r.c, state.s[slot] = r.s;
  }
  void set_twist(int slot, double vx, double vy, double omega = 0) {
    state.vx[slot] = vx, state.vy[slot] = vy, state.omega[slot] = omega;
  }
  void derive() { lilytank::derive(model, state, assemblies); }
  void step(int count = 1) {
    for (int k = 0; k < count; ++k) advance_once();
  }
  /// Returns InMotion::stalled.
  int advance_once() {
    hot.load(state, assemblies);
    InMotion one{motion.get(), &hot, &assemblies, &tallies};
    movers.advance({&one, 1});
    hot.save(state, assemblies);
    return one.stalled;
  }
  bool settle(int slot) {
    hot.load(state, assemblies);
    if (!movers.settle(*motion, hot, assemblies, slot, tallies)) return false;
    hot.save(state, assemblies);
    return true;
  }
  /// Latches two faces, as the controller does, and joins their assemblies.
  bool bond(int i, int fi, int j, int fj) {
    set_bond(i, fi, j, FaceStatus::bonded), set_bond(j, fj, i, FaceStatus::bonded);
    return merge(model, state, assemblies, i, fi, j, fj);
  }
  /// Lets two faces go and splits their assembly.
  void release(int i, int fi, int j, int fj) {
    set_bond(i, fi, -1, FaceStatus::off), set_bond(j, fj, -1, FaceStatus::off);
    split(model, state, assemblies, i);
  }
  void set_bond(int i, int fi, int partner, FaceStatus status) {
    state.faces[4 * i + fi].partner = partner;
    state.faces[4 * i + fi].status = status;
  }
  /// Modules first .. first + count - 1 side by side along +x from (x, y), bonded to a chain.
  void make_chain(int first, int count, double x, double y) {
    for (int k = 0; k < count; ++k) place(first + k, x + k * model.module.side, y);
    derive();
    for (int k = 1; k < count; ++k) bond(first + k - 1, 0, first + k, 2);
  }

  double energy() const {
    double sum = 0;
    for (const int s : assemblies.live) {
      sum += 0.5 * assemblies.mass[s] * (state.vx[s] * state.vx[s] + state.vy[s] * state.vy[s]) +
             0.5 * assemblies.inertia[s] * state.omega[s] * state.omega[s];
    }
    return sum;
  }
  Vec2 momentum() const {
    Vec2 sum(0, 0);
    for (const int s : assemblies.live) sum += assemblies.mass[s] * Vec2(state.vx[s], state.vy[s]);
    return sum;
  }
  /// About the tank's centre, kg m^2/s.
  double spin() const {
    double sum = 0;
    for (const int s : assemblies.live) {
      sum += assemblies.inertia[s] * state.omega[s] +
             assemblies.mass[s] * (state.x[s] * state.vy[s] - state.y[s] * state.vx[s]);
    }
    return sum;
  }
  double overlap() const { return deepest_overlap(model, assemblies); }
};

}  // namespace lilytank::test
