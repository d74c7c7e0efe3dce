// Which assemblies meet on their courses.
#include <algorithm>

#include "motion_impl.hpp"

namespace lilytank {
namespace {

constexpr double kPushShare = 1.2;   // how much of a closing speed a push may pass on
constexpr double kPushSpare = 3e-4;  // m

}  // namespace

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

}  // namespace lilytank
