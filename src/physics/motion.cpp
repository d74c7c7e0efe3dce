#include "motion.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "motion_impl.hpp"
#include "small_turn.hpp"

namespace lilytank {
namespace {

constexpr float kSliceMotion = 0.02f;  // m, most that a point moves between two searches
constexpr float kTooFast = 100;        // m/s, not worth solving
constexpr float kUsualWay = 8e-3f;     // m, seldom exceeded in a step: what a search for latches
                                       // allows for, so that contacts can use it too

bool before(const Link& p, const Link& q) {
  return p.root != q.root ? p.root < q.root : p.a != q.a ? p.a < q.a : p.b < q.b;
}

template <class Use>
void each_bit(std::uint64_t bits, Use&& use) {
  for (; bits != 0; bits &= bits - 1) use(std::countr_zero(bits));
}

}  // namespace

Motion::Impl::Impl(const Model& m, std::int64_t most)
    : model(&m),
      most_work(most),
      contact(m.contact),
      neighbours(m.bodies() > kFewBodies ? m.bodies() : 0, m.tank.radius) {
  const auto n = static_cast<std::size_t>(m.bodies());
  around.half = static_cast<float>(0.5 * m.module.side);
  around.radius = static_cast<float>(m.ball.radius);
  around.tank = static_cast<float>(m.tank.radius);
  const double corner = m.module.count > 0 ? m.module.side * std::sqrt(0.5) : 0;
  largest = static_cast<float>(std::max(corner, m.ball.count > 0 ? m.ball.radius : 0));
  if (m.bodies() <= kFewBodies) bits.assign(n, 0);
  wall_bits.assign((n + kBodyLanes - 1) / kBodyLanes * kBodyLanes / 64 + 1, 0);
  near_reach.assign((n + kBodyLanes - 1) / kBodyLanes, {});
  root.assign(n, 0), local.assign(n, 0), ends.assign(n, {});
  ended.reserve(n), again.reserve(n);
  links.reserve(std::min(n * (n + 1) / 2, 10 * n));
  found.reserve(std::min(n * n / 2, 8 * n));
}

PairKind Motion::Impl::kind_of(int a, int b) const {
  const int modules = model->module.count;
  if (a < 0) return b < modules ? PairKind::wall_square : PairKind::wall_disc;
  if (b < modules) return PairKind::squares;
  return a < modules ? PairKind::square_disc : PairKind::discs;
}

void Motion::Impl::begin(InMotion& w) {
  world = &w, bodies = w.bodies, assemblies = w.assemblies;
  w.stalled = -1, work = latch_work, latch_work = 0;
  // Slices short enough that one search for neighbours serves each; one is enough unless something
  // is very fast.
  const auto dt = static_cast<float>(model->dt);
  around.h = dt;
  way = look_ahead(*bodies, dt, around.tank, wall_bits.data());
  slices = way < kTooFast * dt ? 1 + static_cast<int>(way / kSliceMotion) : 0;
  if (slices == 0) return;
  around.h = dt / static_cast<float>(slices);
}

void Motion::Impl::search(const Bodies& b, double distance) {
  neighbours.search(b.x, b.y, distance);
  searched = true;
}

// All that might meet if everything kept its twist, by circles about the bodies' ways.
void Motion::Impl::find_candidates(std::vector<Encounters>& lists, int number_of_world) {
  Bodies& b = *bodies;
  ++number;
  links.clear(), ended.clear(), again.clear();
  sorted = 0;
  if (around.h < static_cast<float>(model->dt)) {
    way = look_ahead(b, around.h, around.tank, wall_bits.data());
  }
  const auto add = [&](int i, int j) {
    const PairKind kind = kind_of(i, j);
    const Encounters::Pair pair =
        i < 0 ? Encounters::Pair{number_of_world, j, -1} : Encounters::Pair{number_of_world, i, j};
    lists[static_cast<std::size_t>(kind)].add(b, around, pair);
  };
  for (std::size_t k = 0; k < wall_bits.size(); ++k) {
    each_bit(wall_bits[k], [&](int bit) {
      const int i = static_cast<int>(64 * k) + bit;
      if (i < b.count) add(-1, i);
    });
  }
  if (!bits.empty()) {
    near_bits(b, b.reach, bits.data());
    for (int i = 0; i < b.count; ++i) {
      each_bit(bits[static_cast<std::size_t>(i)] >> i >> 1 << i << 1, [&](int j) {
        if (b.slot[static_cast<std::size_t>(i)] != b.slot[static_cast<std::size_t>(j)]) add(i, j);
      });
    }
    return;
  }
  const double needed = 2 * static_cast<double>(largest + way) + 1e-4;
  if (!searched || needed > neighbours.distance()) search(b, needed);
  for (int i = 0; i < b.count; ++i) {
    neighbours.above(i, [&](int j) {
      if (b.slot[static_cast<std::size_t>(i)] == b.slot[static_cast<std::size_t>(j)]) return;
      const float dx = b.x[j] - b.x[i], dy = b.y[j] - b.y[i], touch = b.reach[i] + b.reach[j];
      if (dx * dx + dy * dy < touch * touch) add(i, j);
    });
  }
}

void Motion::Impl::link(int a, int b) {
  links.push_back({a, b, 0, true});
}

// Puts links in order of islands and, within one, of bodies, the wall first.
void Motion::Impl::find_roots() {
  sorted = links.size();
  const auto slot = [&](int i) { return bodies->slot[static_cast<std::size_t>(i)]; };
  if (links.size() == 1) {
    links[0].root = slot(links[0].b);
    return;
  }
  for (const Link& l : links) {
    root[slot(l.b)] = slot(l.b);
    if (l.a >= 0) root[slot(l.a)] = slot(l.a);
  }
  const auto find = [&](int k) {
    while (root[k] != k) k = root[k] = root[root[k]];
    return k;
  };
  for (const Link& l : links) {
    if (l.a < 0) continue;
    const int p = find(slot(l.a)), q = find(slot(l.b));
    root[std::max(p, q)] = std::min(p, q);
  }
  for (Link& l : links) l.root = find(slot(l.b));
  std::sort(links.begin(), links.end(), before);
}

bool Motion::Impl::linked(int a, int b) const {
  const auto same = [&](const Link& l) { return l.a == a && l.b == b; };
  const auto last = links.begin() + static_cast<std::ptrdiff_t>(sorted);
  if (std::any_of(last, links.end(), same)) return true;
  if (sorted < 8) return std::any_of(links.begin(), last, same);
  int island = bodies->slot[static_cast<std::size_t>(b)];
  while (root[island] != island) island = root[island];
  const auto at = std::lower_bound(links.begin(), last, Link{a, b, island, false}, before);
  return at != last && same(*at);
}

// Free flight for all, and the ends of those that islands moved.
void Motion::Impl::place_ends() {
  Bodies& b = *bodies;
  fly_all(b, around.h);
  for (Compound& g : b.groups) {
    const End& e = ends[static_cast<std::size_t>(g.slot)];
    if (e.slice == number && e.moved) continue;
    g.to_x = g.x + around.h * g.vx, g.to_y = g.y + around.h * g.vy;
    g.to_c = g.c, g.to_s = g.s;
    small_turn(g.to_c, g.to_s, around.h * g.omega);
    b.place_members_at_end(g, *assemblies);
  }
  for (const int k : ended) {
    const End& e = ends[static_cast<std::size_t>(k)];
    if (!e.moved) continue;
    if (Compound* g = b.group_of(k)) {
      g->to_x = e.x, g->to_y = e.y, g->to_c = e.c, g->to_s = e.s;
      b.place_members_at_end(*g, *assemblies);
    } else {
      b.to_x[k] = e.x, b.to_y[k] = e.y, b.to_c[k] = e.c, b.to_s[k] = e.s;
    }
  }
}

// What those that were solved last came near without a link.
void Motion::Impl::find_strays(std::vector<Encounters>& lists, int number_of_world) {
  Bodies& b = *bodies;
  const auto look_at = [&](int i, int j) {
    if (b.slot[static_cast<std::size_t>(i)] == b.slot[static_cast<std::size_t>(j)]) return;
    const float dx = b.to_x[j] - b.to_x[i], dy = b.to_y[j] - b.to_y[i];
    const float touch = b.size[i] + b.size[j];
    if (dx * dx + dy * dy >= touch * touch) return;
    const int low = std::min(i, j), high = std::max(i, j);
    if (linked(low, high)) return;
    lists[static_cast<std::size_t>(kind_of(low, high))].add_ends(b, around,
                                                                 {number_of_world, low, high});
  };
  for (const int k : again) {
    if (!ends[static_cast<std::size_t>(k)].moved) continue;
    for (int i = assemblies->first[k]; i >= 0; i = assemblies->next[i]) {
      const float x = b.to_x[i], y = b.to_y[i], rim = around.tank - b.size[i];
      if ((rim < 0 || x * x + y * y > rim * rim) && !linked(-1, i))
        lists[static_cast<std::size_t>(kind_of(-1, i))].add_ends(b, around,
                                                                 {number_of_world, i, -1});
      if (!bits.empty()) {
        each_bit(bits_about(b, x, y, b.size[i] + largest, 0), [&](int j) { look_at(i, j); });
        continue;
      }
      const float dx = x - b.x[i], dy = y - b.y[i];
      const double needed = 2 * static_cast<double>(largest + way) +
                            static_cast<double>(std::sqrt(dx * dx + dy * dy));
      if (needed > neighbours.distance()) search(b, needed + 5e-3);
      neighbours.around(i, [&](int j) { look_at(i, j); });
    }
  }
}

void Motion::Impl::finish() {
  Bodies& b = *bodies;
  for (const int k : ended) {
    const End& e = ends[static_cast<std::size_t>(k)];
    if (!e.moved) continue;
    if (Compound* g = b.group_of(k))
      g->vx = e.vx, g->vy = e.vy, g->omega = e.omega;
    else
      b.vx[k] = e.vx, b.vy[k] = e.vy, b.omega[k] = e.omega;
  }
  const bool last = --slices == 0;
  const float linear = last ? world->linear : 0, angular = last ? world->angular : 0;
  arrive_all(b, linear, angular);
  std::swap(b.arm_x, b.to_arm_x), std::swap(b.arm_y, b.to_arm_y);
  // Every member is damped as if alone; the assembly keeps the sum of their momenta.
  for (Compound& g : b.groups) {
    g.x = g.to_x, g.y = g.to_y, g.c = g.to_c, g.s = g.to_s;
    g.vx -= linear * g.vx, g.vy -= linear * g.vy;
    g.omega -= (g.own_share * angular + (1 - g.own_share) * linear) * g.omega;
    b.turn_members(g, *assemblies);
  }
  searched = false;
}

Motion::Motion(const Model& model, std::int64_t most_work)
    : impl_(std::make_unique<Impl>(model, most_work)) {}
Motion::~Motion() = default;
Motion::Motion(Motion&&) noexcept = default;

void Motion::forget() {
  impl_->searched = false;
}

std::span<const std::pair<int, int>> Motion::near_pairs(const Bodies& b, double distance) {
  Impl& m = *impl_;
  m.found.clear();
  const int n = m.model->module.count;
  const auto reach = static_cast<float>(distance);
  if (!m.bits.empty()) {
    if (m.near_distance != reach) {
      m.near_distance = reach;
      for (RowOf<kBlockLanes>& row : m.near_reach)
        std::fill(row.v, row.v + kBlockLanes, 0.5f * reach + 1e-6f);
    }
    near_bits(b, reinterpret_cast<const float*>(m.near_reach.data()), m.bits.data());
    for (int i = 0; i < n; ++i) {
      each_bit(m.bits[static_cast<std::size_t>(i)] >> i >> 1 << i << 1, [&](int j) {
        if (j < n) m.found.emplace_back(i, j);
      });
    }
    return m.found;
  }
  m.search(b, std::max(distance, static_cast<double>(2 * (m.largest + kUsualWay))));
  for (int i = 0; i < n; ++i) {
    m.neighbours.above(i, [&](int j) {
      const float dx = b.x[j] - b.x[i], dy = b.y[j] - b.y[i];
      if (j < n && dx * dx + dy * dy < (reach + 2e-6f) * (reach + 2e-6f))
        m.found.emplace_back(i, j);
    });
  }
  return m.found;
}

}  // namespace lilytank
