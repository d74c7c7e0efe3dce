#include "bodies.hpp"

#include <algorithm>
#include <cmath>

namespace lilytank {

Bodies::Bodies(const Model& model)
    : count(model.bodies()),
      modules(model.module.count),
      padded((count + kBodyLanes - 1) / kBodyLanes * kBodyLanes) {
  float** const fields[] = {&x,        &y,           &c,         &s,         &vx,    &vy,
                            &omega,    &fx,          &fy,        &torque,    &mass,  &inv_mass,
                            &inertia,  &inv_inertia, &size,      &radius,    &arc,   &reach,
                            &offset_x, &offset_y,    &quarter_c, &quarter_s, &arm_x, &arm_y,
                            &to_arm_x, &to_arm_y,    &to_x,      &to_y,      &to_c,  &to_s};
  const auto rows = static_cast<std::size_t>(padded / kBodyLanes);
  // One more row for the bytes of `covered`.
  storage_.assign(rows * (std::size(fields) + 1), {});
  auto* at = reinterpret_cast<float*>(storage_.data());
  for (float** field : fields) *field = at, at += padded;
  covered = reinterpret_cast<std::uint8_t*>(at);
  std::fill(covered, covered + padded, std::uint8_t{0});
  std::fill(c, c + padded, 1.0f), std::fill(quarter_c, quarter_c + padded, 1.0f);
  const auto narrow = [](double v) { return static_cast<float>(v); };
  for (int i = 0; i < count; ++i) {
    const bool module = i < modules;
    const double m = module ? model.module.mass : model.ball.mass;
    mass[i] = narrow(m), inv_mass[i] = narrow(1 / m);
    inertia[i] = module ? narrow(model.module.inertia()) : 0;
    inv_inertia[i] = module ? narrow(1 / model.module.inertia()) : 0;
    size[i] = narrow(module ? model.module.side * std::sqrt(0.5) : model.ball.radius);
  }
  slot.assign(static_cast<std::size_t>(count), 0), group_.assign(slot.size(), -1);
  groups.reserve(slot.size() / 2 + 1);
}

void Bodies::load(const State& state, const Assemblies& a) {
  const auto take = [](const std::vector<double>& from, float* to) {
    std::transform(from.begin(), from.end(), to, [](double v) { return static_cast<float>(v); });
  };
  take(state.x, x), take(state.y, y), take(state.c, c), take(state.s, s);
  take(state.vx, vx), take(state.vy, vy), take(state.omega, omega);
  take(a.offset_x, offset_x), take(a.offset_y, offset_y);
  for (int i = modules; i < count; ++i) omega[i] = 0;
  std::copy(state.assembly.begin(), state.assembly.end(), slot.begin());
  std::copy(a.covered.begin(), a.covered.end(), covered);
  std::fill(radius, radius + padded, 0.0f);
  std::fill(group_.begin(), group_.end(), -1);
  groups.clear();
  for (const int k : a.groups) {
    group_[k] = static_cast<int>(groups.size());
    Compound& g = groups.emplace_back();
    g.slot = k;
    g.x = x[k], g.y = y[k], g.c = c[k], g.s = s[k];
    g.vx = vx[k], g.vy = vy[k], g.omega = omega[k];
    const auto narrow = [](double v) { return static_cast<float>(v); };
    g.mass = narrow(a.mass[k]), g.inertia = narrow(a.inertia[k]);
    g.inv_mass = narrow(a.inverse_mass[k]), g.inv_inertia = narrow(a.inverse_inertia[k]);
    g.own_share = narrow(a.own_inertia[k] * a.inverse_inertia[k]), g.reach = narrow(a.reach[k]);
    for (int i = a.first[k]; i >= 0; i = a.next[i]) {
      const Rot q = quarter(state.turn[i]);
      quarter_c[i] = narrow(q.c), quarter_s[i] = narrow(q.s), radius[i] = g.reach;
    }
    place_members(g, a);
  }
}

void Bodies::save(State& state, Assemblies& a) const {
  const auto give = [&](const float* from, std::vector<double>& to) {
    for (int i = 0; i < count; ++i) to[i] = static_cast<double>(from[i]);
  };
  give(x, a.x), give(y, a.y), give(c, a.c), give(s, a.s);
  give(vx, a.vx), give(vy, a.vy), give(omega, a.omega);
  for (const int k : a.live) {
    state.x[k] = a.x[k], state.y[k] = a.y[k], state.c[k] = a.c[k], state.s[k] = a.s[k];
    state.vx[k] = a.vx[k], state.vy[k] = a.vy[k], state.omega[k] = a.omega[k];
  }
  for (const Compound& g : groups) {
    const int k = g.slot;
    const auto wide = [](float v) { return static_cast<double>(v); };
    state.x[k] = wide(g.x), state.y[k] = wide(g.y), state.c[k] = wide(g.c), state.s[k] = wide(g.s);
    state.vx[k] = wide(g.vx), state.vy[k] = wide(g.vy), state.omega[k] = wide(g.omega);
  }
}

void Bodies::place_members_at_end(const Compound& g, const Assemblies& a) {
  const float gx = g.to_x, gy = g.to_y, gc = g.to_c, gs = g.to_s;
  const float *ox = offset_x, *oy = offset_y, *qc = quarter_c, *qs = quarter_s;
  float *const px = to_x, *const py = to_y, *const pc = to_c, *const ps = to_s;
  float *const ax = to_arm_x, *const ay = to_arm_y;
  const int* const next = a.next.data();
  for (int i = g.slot; i >= 0; i = next[i]) {
    const float rx = gc * ox[i] - gs * oy[i], ry = gs * ox[i] + gc * oy[i];
    const float c_i = gc * qc[i] - gs * qs[i], s_i = gs * qc[i] + gc * qs[i];
    ax[i] = rx, ay[i] = ry, px[i] = gx + rx, py[i] = gy + ry, pc[i] = c_i, ps[i] = s_i;
  }
}

void Bodies::place_members(const Compound& g, const Assemblies& a) {
  Compound here = g;
  here.to_x = g.x, here.to_y = g.y, here.to_c = g.c, here.to_s = g.s;
  place_members_at_end(here, a);
  for (int i = g.slot; i >= 0; i = a.next[i]) {
    x[i] = to_x[i], y[i] = to_y[i], c[i] = to_c[i], s[i] = to_s[i];
    arm_x[i] = to_arm_x[i], arm_y[i] = to_arm_y[i];
  }
  turn_members(g, a);
}

void Bodies::turn_members(const Compound& g, const Assemblies& a) {
  const float gx = g.vx, gy = g.vy, w = g.omega;
  const float *const ax = arm_x, *const ay = arm_y;
  float *const px = vx, *const py = vy, *const pw = omega;
  const int* const next = a.next.data();
  for (int i = g.slot; i >= 0; i = next[i]) {
    const float u = gx - w * ay[i], v = gy + w * ax[i];
    px[i] = u, py[i] = v, pw[i] = w;
  }
}

}  // namespace lilytank
