#include "island_builder.hpp"

#include <algorithm>
#include <cmath>

namespace lilytank {

IslandBuilder::IslandBuilder(const Model& model)
    : model_(&model),
      corner_(model.module.side * std::sqrt(0.5)),
      half_(0.5 * model.module.side),
      island_(model),
      local_(static_cast<std::size_t>(model.bodies()), 0) {
  slots_.reserve(local_.size());
}

void IslandBuilder::begin(const State& state, const Assemblies& assemblies) {
  clear();
  state_ = &state;
  assemblies_ = &assemblies;
}

Square IslandBuilder::square(int i) const {
  const Assemblies& a = *assemblies_;
  return {a.x[i], a.y[i], {a.c[i], a.s[i]}, half_, 0};
}

Disc IslandBuilder::disc(int i) const {
  return {assemblies_->x[i], assemblies_->y[i], model_->ball.radius};
}

Gap IslandBuilder::gap(int i, int j) const {
  if (is_module(i) && is_module(j)) return separation(square(i), square(j));
  if (is_module(i)) return separation(square(i), disc(j));
  if (!is_module(j)) return separation(disc(i), disc(j));
  const Gap back = separation(square(j), disc(i));
  return {back.size, -back.nx, -back.ny};
}

double IslandBuilder::wall_gap(int body, double dx, double dy) const {
  if (!is_module(body)) {
    Disc d = disc(body);
    d.x += dx, d.y += dy;
    return wall_separation(d, model_->tank.radius);
  }
  Square s = square(body);
  s.x += dx, s.y += dy;
  return wall_separation(s, model_->tank.radius);
}

void IslandBuilder::clear() {
  for (const int slot : slots_) local_[slot] = 0;
  slots_.clear();
  island_.clear();
}

void IslandBuilder::enter(int slot, double motion_bound) {
  Mover& m = island_.add();
  m.slot = slot;
  m.pose = {state_->x[slot], state_->y[slot], {state_->c[slot], state_->s[slot]}};
  m.twist = {state_->vx[slot], state_->vy[slot], state_->omega[slot]};
  m.mass = assemblies_->mass[slot], m.inertia = assemblies_->inertia[slot];
  m.inv_mass = 1 / m.mass, m.inv_inertia = m.inertia > 0 ? 1 / m.inertia : 0;
  m.reach = assemblies_->reach[slot];
  m.motion_bound = motion_bound;
  m.good = m.start = m.pose;
  m.course = m.twist;
  slots_.push_back(slot);
  local_[slot] = static_cast<int>(slots_.size());
}

// A body's centre in its assembly's frame; returns how far that is from the centre of mass.
double IslandBuilder::place(int body, double& x, double& y) const {
  x = assemblies_->offset_x[body], y = assemblies_->offset_y[body];
  return x == 0 && y == 0 ? 0 : std::sqrt(x * x + y * y);
}

void IslandBuilder::link(int i, int j) {
  if (i > j) std::swap(i, j);
  ContactPair pair;
  pair.a = local_[slot_of(i)], pair.b = local_[slot_of(j)];
  pair.kind = is_module(j)   ? PairKind::squares
              : is_module(i) ? PairKind::square_disc
                             : PairKind::discs;
  pair.order_a = i, pair.order_b = j;
  pair.inner_a = assemblies_->inner[i], pair.inner_b = assemblies_->inner[j];
  pair.arm_a = place(i, pair.ax, pair.ay), pair.arm_b = place(j, pair.bx, pair.by);
  island_.add(pair);
}

void IslandBuilder::link_wall(int i) {
  ContactPair pair;
  pair.b = local_[slot_of(i)];
  pair.kind = is_module(i) ? PairKind::wall_square : PairKind::wall_disc;
  pair.order_a = -1, pair.order_b = i;
  pair.arm_b = place(i, pair.bx, pair.by);
  island_.add(pair);
}

Vec2 IslandBuilder::centre_of(int body) const {
  const int index = local_[slot_of(body)];
  if (index == 0) return {assemblies_->x[body], assemblies_->y[body]};
  double x = 0, y = 0;
  place(body, x, y);
  const Pose& pose = island_.movers()[index].pose;
  return Vec2(pose.x, pose.y) + rotate(pose.r, Vec2(x, y));
}

}  // namespace lilytank
