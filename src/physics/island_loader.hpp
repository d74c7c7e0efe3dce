// Islands of any worlds on their way into a block and back.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "motion_impl.hpp"

namespace lilytank {

/// Linked assemblies of one world.
struct Island {
  Motion::Impl* world;
  int first, count;  ///< links
};

/// A body by itself.
struct Placed {
  float x, y, c, s, vx, vy, omega;
};

/// A block of N lanes, and which assemblies are in it.
template <int N>
class IslandLoader {
 public:
  IslandBlock<N> block;

  /// Room for islands of so many bodies without allocating anew, as a rule.
  void reserve(std::size_t bodies);
  /// Fills the block with up to N islands as they are at the start of the slice.
  void pack(const std::vector<Link>& links, const Island* const* some, int count);
  /// Takes over where they end.
  void unpack(const Island* const* some, int count);
  /// The slot of a mover; -1: none.
  int slot(int mover, int lane) const { return slots[static_cast<std::size_t>(mover * N + lane)]; }

 private:
  static constexpr std::int64_t kMostWorkOfLane = 1'000'000'000;  // an int32 with room for a sweep
  void clear(const Island* const* some, int count);
  void put_settings(const Island& island, int lane);
  void put_links(const Island& island, const Link* links, int lane);
  int put_mover(const Island& island, int slot, int lane, int& movers);
  void put_pair(const Island& island, const Link& link, int lane, int a, int b,
                PairRowsOf<N>& rows);

  std::vector<int> slots;  // [mover][lane]
};

template <int N>
void IslandLoader<N>::reserve(std::size_t bodies) {
  const std::size_t pairs = 6 * bodies + 8;
  block.mover.reserve(bodies + 2), slots.reserve((bodies + 2) * N);
  block.pair.reserve(pairs), block.point.reserve(4 * pairs);
}

template <int N>
int IslandLoader<N>::put_mover(const Island& island, int slot, int lane, int& movers) {
  Motion::Impl& m = *island.world;
  int& local = m.local[static_cast<std::size_t>(slot)];
  if (local > 0) return local;
  local = ++movers;
  const auto index = static_cast<std::size_t>(local);
  while (block.movers <= local) {
    const auto next = static_cast<std::size_t>(block.movers++);
    if (block.mover.size() <= next) block.mover.resize(next + 1), slots.resize((next + 1) * N);
    std::fill_n(slots.begin() + static_cast<std::ptrdiff_t>(next * N), N, -1);
    MoverRowsOf<N>& r = block.mover[next];
    for (RowOf<N>* row : {&r.x, &r.y, &r.s, &r.vx, &r.vy, &r.omega, &r.mass, &r.inertia,
                          &r.inv_mass, &r.inv_inertia, &r.reach})
      *row = {};
    std::fill_n(r.c.v, N, 1.0f);
  }
  slots[index * N + static_cast<std::size_t>(lane)] = slot;
  MoverRowsOf<N>& r = block.mover[index];
  const auto put = [&](const auto& from, float mass, float inertia, float inv_mass,
                       float inv_inertia, float reach) {
    r.x.v[lane] = from.x, r.y.v[lane] = from.y, r.c.v[lane] = from.c, r.s.v[lane] = from.s;
    r.vx.v[lane] = from.vx, r.vy.v[lane] = from.vy, r.omega.v[lane] = from.omega;
    r.mass.v[lane] = mass, r.inertia.v[lane] = inertia;
    r.inv_mass.v[lane] = inv_mass, r.inv_inertia.v[lane] = inv_inertia, r.reach.v[lane] = reach;
  };
  const Bodies& b = *m.bodies;
  if (const Compound* g = b.group_of(slot)) {
    put(*g, g->mass, g->inertia, g->inv_mass, g->inv_inertia, g->reach);
  } else {
    const Placed one{b.x[slot],  b.y[slot],  b.c[slot],    b.s[slot],
                     b.vx[slot], b.vy[slot], b.omega[slot]};
    put(one, b.mass[slot], b.inertia[slot], b.inv_mass[slot], b.inv_inertia[slot], b.size[slot]);
  }
  return local;
}

template <int N>
void IslandLoader<N>::put_pair(const Island& island, const Link& link, int lane, int a, int b,
                               PairRowsOf<N>& r) {
  const Motion::Impl& m = *island.world;
  const auto kind = m.kind_of(link.a, link.b);
  r.on.v[lane] = r.wall.v[lane] = 0;
  const auto set = [lane](RowOf<N>& row) {
    const std::int32_t ones = -1;
    std::memcpy(&row.v[lane], &ones, sizeof ones);
  };
  set(r.on);
  if (link.a < 0) set(r.wall);
  r.kind.v[lane] = static_cast<std::int32_t>(kind), r.kinds |= 1u << static_cast<unsigned>(kind);
  r.at_a.v[lane] = IslandBlock<N>::place(a, lane), r.at_b.v[lane] = IslandBlock<N>::place(b, lane);
  if (r.a < 0) r.a = a, r.b = b;
  r.uniform = r.uniform && r.a == a && r.b == b;
  const Bodies& bodies = *m.bodies;
  const auto grouped = [&](int body) {
    return body >= 0 && bodies.group_of(bodies.slot[static_cast<std::size_t>(body)]) != nullptr;
  };
  const bool in_a = grouped(link.a), in_b = grouped(link.b);
  if (!in_a && !in_b && !r.offset) return;
  if (!r.offset) {
    r.offset = true;
    for (RowOf<N>* row : {&r.ax, &r.ay, &r.bx, &r.by, &r.arm_a, &r.arm_b}) *row = {};
    r.inner_a = r.inner_b = {};
  }
  const auto put = [&](int body, RowOf<N>& x, RowOf<N>& y, RowOf<N>& arm, WholeRowOf<N>& inner) {
    const float ox = bodies.offset_x[body], oy = bodies.offset_y[body];
    x.v[lane] = ox, y.v[lane] = oy, arm.v[lane] = std::sqrt(ox * ox + oy * oy);
    inner.v[lane] = m.assemblies->inner[static_cast<std::size_t>(body)];
  };
  if (in_a) put(link.a, r.ax, r.ay, r.arm_a, r.inner_a);
  if (in_b) put(link.b, r.bx, r.by, r.arm_b, r.inner_b);
}

// Empty pairs, and mover 0 alone.
template <int N>
void IslandLoader<N>::clear(const Island* const* some, int count) {
  block.count = count, block.movers = 1, block.pairs = 0;
  if (block.mover.empty()) block.mover.resize(1), slots.resize(N, -1);
  block.mover[0] = {};
  std::fill_n(block.mover[0].c.v, N, 1.0f);
  for (int k = 0; k < count; ++k) block.pairs = std::max(block.pairs, some[k]->count);
  const auto pairs = static_cast<std::size_t>(block.pairs);
  if (block.pair.size() < pairs) block.pair.resize(pairs);
  for (std::size_t k = 0; k < pairs; ++k) {
    PairRowsOf<N>& r = block.pair[k];
    r.uniform = true, r.a = r.b = -1, r.kinds = 0, r.offset = false;
    r.on = r.wall = {}, r.kind = {};
    for (int l = 0; l < N; ++l) r.at_a.v[l] = r.at_b.v[l] = IslandBlock<N>::place(0, l);
  }
}

// What the contacts of a world have in common.
template <int N>
void IslandLoader<N>::put_settings(const Island& island, int lane) {
  const Motion::Impl& m = *island.world;
  block.half.v[lane] = m.around.half, block.radius.v[lane] = m.around.radius;
  block.tank.v[lane] = m.around.tank, block.corner.v[lane] = m.largest;
  block.friction.v[lane] = static_cast<float>(m.contact.friction);
  block.restitution.v[lane] = static_cast<float>(m.contact.restitution);
  block.threshold.v[lane] = static_cast<float>(m.contact.restitution_speed);
  block.span.v[lane] = m.around.h, block.own_pairs.v[lane] = island.count;
  block.most_work.v[lane] = static_cast<std::int32_t>(
      std::clamp<std::int64_t>(m.most_work - m.work_before, 0, kMostWorkOfLane));
}

template <int N>
void IslandLoader<N>::put_links(const Island& island, const Link* links, int lane) {
  Motion::Impl& m = *island.world;
  const auto slot = [&](int i) { return m.bodies->slot[static_cast<std::size_t>(i)]; };
  int movers = 0;
  for (int k = 0; k < island.count; ++k) {
    const Link& link = links[k];
    int a = 0;
    if (link.a >= 0)
      a = put_mover(island, slot(link.a), lane, movers);
    else if (block.pairs == 1)
      a = movers = 1;  // nothing, so that all islands of one pair have the same movers
    const int b = put_mover(island, slot(link.b), lane, movers);
    put_pair(island, link, lane, a, b, block.pair[static_cast<std::size_t>(k)]);
  }
  // `slots` knows the movers from now on.
  for (int k = 0; k < island.count; ++k) {
    for (const int i : {links[k].a, links[k].b})
      if (i >= 0) m.local[static_cast<std::size_t>(slot(i))] = 0;
  }
}

template <int N>
void IslandLoader<N>::pack(const std::vector<Link>& links, const Island* const* some, int count) {
  clear(some, count);
  for (int lane = 0; lane < count; ++lane) {
    put_settings(*some[lane], lane);
    put_links(*some[lane], &links[static_cast<std::size_t>(some[lane]->first)], lane);
  }
  for (int lane = count; lane < N; ++lane) {
    for (RowOf<N>* row : {&block.half, &block.radius, &block.tank, &block.corner, &block.friction,
                          &block.restitution, &block.threshold, &block.span})
      row->v[lane] = row->v[0];
    block.own_pairs.v[lane] = 0, block.most_work.v[lane] = 0;
  }
  bool walls = false;
  for (int k = 0; k < block.pairs; ++k)
    walls = walls || block.pair[static_cast<std::size_t>(k)].walls();
  const auto points = static_cast<std::size_t>(block.pairs * (walls ? 4 : 2));
  if (block.point.size() < points) block.point.resize(points);
}

template <int N>
void IslandLoader<N>::unpack(const Island* const* some, int count) {
  for (int lane = 0; lane < count; ++lane) {
    Motion::Impl& m = *some[lane]->world;
    m.work += block.work.v[lane];
    Tallies& t = *m.world->tallies;
    t.moves_undone += block.undone.v[lane];
    t.deepest_overlap = std::max(t.deepest_overlap, static_cast<double>(block.deepest.v[lane]));
    int first = -1;
    for (int k = 1; k < block.movers; ++k) {
      const int slot = slots[static_cast<std::size_t>(k * N + lane)];
      if (slot < 0) continue;
      if (first < 0) first = slot;
      const MoverRowsOf<N>& r = block.mover[static_cast<std::size_t>(k)];
      End& e = m.ends[static_cast<std::size_t>(slot)];
      if (e.slice != m.number) m.ended.push_back(slot);
      std::int32_t touched;
      std::memcpy(&touched, &r.touched.v[lane], sizeof touched);
      e.slice = m.number, e.moved = touched != 0;
      m.again.push_back(slot);
      if (!e.moved) continue;
      e.x = r.x.v[lane], e.y = r.y.v[lane], e.c = r.c.v[lane], e.s = r.s.v[lane];
      e.vx = r.vx.v[lane], e.vy = r.vy.v[lane], e.omega = r.omega.v[lane];
    }
    if (m.world->stalled < 0 && m.work > m.most_work) m.world->stalled = first;
  }
}

}  // namespace lilytank
