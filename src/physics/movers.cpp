// The stages of a step of many worlds: candidates are measured, islands of all worlds are moved
// side by side in lanes, and what that brings together is solved again.
#include <algorithm>
#include <cmath>

#include "island_loader.hpp"

namespace lilytank {
namespace {

constexpr float kLinkSpare = 2e-5f;   // m, pairs that miss by less are linked
constexpr std::size_t kCrowd = 12;    // links of a world, at least; and half as many as bodies
constexpr float kCrowdSpare = 1e-3f;  // m
constexpr int kLarge = 40;            // pairs; larger islands are by themselves
constexpr int kKinds = 5;

// Making room for a latch.
constexpr float kSettled = 2.5e-4f;     // m, overlap that is left
constexpr float kSettleMargin = 1e-3f;  // m, what is nearer than this may be pushed
constexpr int kSettleRounds = 31;       // searches for what got in the way
constexpr int kSettlePushes = 20;       // sweeps between two searches

}  // namespace

struct Movers::Impl {
  std::vector<Encounters> lists = std::vector<Encounters>(kKinds);
  std::vector<Motion::Impl*> going, solving, doubtful;
  std::vector<Link> links;
  std::vector<Island> islands;
  std::vector<const Island*> order;
  IslandLoader<kBlockLanes> full;
  IslandLoader<kFewLanes> few;
  IslandLoader<1> single;

  template <class Use>
  void each_close(float spare, Use&& use) {
    for (int k = 0; k < kKinds; ++k)
      lists[static_cast<std::size_t>(k)].each_close(static_cast<PairKind>(k), spare, use);
  }
  void clear() {
    for (Encounters& list : lists) list.clear();
  }
  void gather(Motion::Impl& m);
  void solve();
  template <int N>
  void solve(IslandLoader<N>& loader, const Island* const* some, int count) {
    loader.pack(links, some, count);
    run_block(loader.block);
    loader.unpack(some, count);
  }
  void reserve(std::size_t worlds, std::size_t bodies);
  void link_crowds();
  void slice();
  bool settle(Motion::Impl& m, int slot, Tallies& tallies);
  void link_around(Motion::Impl& m, int i, std::size_t k, std::vector<int>& slots_in);
  void take_poses(Motion::Impl& m);
  std::vector<int> entered;  // slots, of settle()
  std::size_t reserved = 0;  // bodies
};

void Movers::Impl::reserve(std::size_t worlds, std::size_t bodies) {
  if (bodies <= reserved && worlds <= going.capacity()) return;
  reserved = std::max(reserved, bodies);
  for (auto* list : {&going, &solving, &doubtful}) list->reserve(worlds);
  for (Encounters& list : lists) list.reserve(8 * bodies + kBlockLanes);
  links.reserve(10 * bodies), islands.reserve(bodies), order.reserve(bodies);
  entered.reserve(bodies);
  single.reserve(bodies), few.reserve(bodies), full.reserve(std::min<std::size_t>(bodies, 64));
}

// Islands with a fresh link.
void Movers::Impl::gather(Motion::Impl& m) {
  m.find_roots();
  m.again.clear(), m.work_before = m.work;
  for (std::size_t k = 0; k < m.links.size();) {
    const int first = static_cast<int>(links.size());
    const int root = m.links[k].root;
    bool fresh = false;
    const std::size_t begin = k;
    for (; k < m.links.size() && m.links[k].root == root; ++k) fresh = fresh || m.links[k].fresh;
    if (!fresh) continue;
    for (std::size_t q = begin; q < k; ++q) m.links[q].fresh = false, links.push_back(m.links[q]);
    islands.push_back({&m, first, static_cast<int>(k - begin)});
  }
}

// The most pairs of an island that shares a block with one of so many.
constexpr int limit(int pairs) {
  return pairs == 1 ? 1 : std::max(kLarge, 2 * pairs);
}

// Moves the islands, those with as many pairs side by side.
void Movers::Impl::solve() {
  order.clear();
  for (const Island& island : islands) order.push_back(&island);
  std::sort(order.begin(), order.end(), [](const Island* p, const Island* q) {
    return p->count != q->count ? p->count < q->count : p < q;
  });
  const bool shared = islands_share_vectors();
  for (std::size_t k = 0; k < order.size();) {
    std::size_t end = k + 1;
    const std::size_t most = order[k]->count > kLarge || !shared ? 1 : kBlockLanes;
    // Islands of one pair have blocks of their own: these are simpler.
    while (end < order.size() && end - k < most && order[end]->count <= limit(order[k]->count))
      ++end;
    const int count = static_cast<int>(end - k);
    if (count == 1)
      solve(single, &order[k], count);
    else if (count <= kFewLanes)
      solve(few, &order[k], count);
    else
      solve(full, &order[k], count);
    k = end;
  }
}

// In a crowd a push surely reaches others: what is near is linked at once.
void Movers::Impl::link_crowds() {
  bool any = false;
  for (Motion::Impl* m : going) {
    m->crowded = m->links.size() > kCrowd && 2 * m->links.size() > m->root.size();
    if (m->crowded) m->links.clear(), any = true;
  }
  if (!any) return;
  each_close(kCrowdSpare, [&](const Encounters::Pair& p) {
    Motion::Impl& m = *going[static_cast<std::size_t>(p.world)];
    if (m.crowded) m.link(p.j < 0 ? -1 : p.i, p.j < 0 ? p.i : p.j);
  });
}

void Movers::Impl::slice() {
  clear();
  for (std::size_t k = 0; k < going.size(); ++k)
    going[k]->find_candidates(lists, static_cast<int>(k));
  each_close(kLinkSpare, [&](const Encounters::Pair& p) {
    Motion::Impl& m = *going[static_cast<std::size_t>(p.world)];
    if (p.j < 0)
      m.link(-1, p.i);
    else
      m.link(p.i, p.j);
  });
  link_crowds();
  solving.clear();
  for (Motion::Impl* m : going) {
    if (!m->links.empty())
      solving.push_back(m);
    else
      m->place_ends();
  }
  // Widening the search makes sure that this ends soon: at last all that is near is linked.
  float spare = -kSlop;
  for (int round = 0; !solving.empty(); ++round) {
    links.clear(), islands.clear();
    for (Motion::Impl* m : solving) gather(*m);
    solve();
    clear();
    for (std::size_t k = 0; k < solving.size(); ++k) {
      Motion::Impl& m = *solving[k];
      if (m.world->stalled >= 0) continue;
      m.place_ends();
      m.find_strays(lists, static_cast<int>(k));
    }
    doubtful.clear();
    if (round >= 3) spare = 1e-4f;
    each_close(spare, [&](const Encounters::Pair& p) {
      Motion::Impl& m = *solving[static_cast<std::size_t>(p.world)];
      const int a = p.j < 0 ? -1 : p.i, b = p.j < 0 ? p.i : p.j;
      if (m.linked(a, b)) return;
      m.link(a, b);
      if (std::find(doubtful.begin(), doubtful.end(), &m) == doubtful.end()) doubtful.push_back(&m);
    });
    solving.swap(doubtful);
  }
}

// Pairs up body i of the k-th assembly with what is near it now, which then joins the island.
// Assemblies before the k-th were paired with this one already.
void Movers::Impl::link_around(Motion::Impl& m, int i, std::size_t k, std::vector<int>& in) {
  const Bodies& b = *m.bodies;
  const auto slot = [&](int body) { return b.slot[static_cast<std::size_t>(body)]; };
  const float x = b.x[i], y = b.y[i], rim = m.around.tank - b.size[i] - kSettleMargin;
  const auto take = [&](int low, int high) { links.push_back({low, high, 0, false}); };
  if (rim < 0 || x * x + y * y > rim * rim) take(-1, i);
  const auto look_at = [&](int j) {
    const int other = slot(j);
    if (other == slot(i)) return;
    const auto at = std::find(in.begin(), in.end(), other);
    if (at < in.begin() + static_cast<std::ptrdiff_t>(k)) return;
    const float near = b.size[i] + b.size[j] + kSettleMargin;
    const float dx = b.x[j] - x, dy = b.y[j] - y;
    if (dx * dx + dy * dy > near * near) return;
    if (at == in.end()) in.push_back(other);
    take(std::min(i, j), std::max(i, j));
  };
  if (m.bits.empty()) {
    m.neighbours.around(i, look_at);
    return;
  }
  for (int j = 0; j < b.count; ++j) look_at(j);
}

// The poses of the block's only island.
void Movers::Impl::take_poses(Motion::Impl& m) {
  for (int k = 1; k < single.block.movers; ++k) {
    const int slot = single.slot(k, 0);
    if (slot < 0) continue;
    const MoverRowsOf<1>& r = single.block.mover[static_cast<std::size_t>(k)];
    Bodies& b = *m.bodies;
    if (Compound* g = b.group_of(slot)) {
      g->x = r.x.v[0], g->y = r.y.v[0], g->c = r.c.v[0], g->s = r.s.v[0];
      b.place_members(*g, *m.assemblies);
    } else {
      b.x[slot] = r.x.v[0], b.y[slot] = r.y.v[0], b.c[slot] = r.c.v[0], b.s[slot] = r.s.v[0];
    }
  }
}

bool Movers::Impl::settle(Motion::Impl& m, int slot, Tallies& tallies) {
  entered.assign(1, slot);
  for (int round = 0; round < kSettleRounds; ++round) {
    links.clear();
    if (m.bits.empty()) m.search(*m.bodies, static_cast<double>(2 * m.largest + kSettleMargin));
    const std::size_t count = entered.size();
    for (std::size_t k = 0; k < count; ++k) {
      for (int i = m.assemblies->first[entered[k]]; i >= 0; i = m.assemblies->next[i])
        link_around(m, i, k, entered);
    }
    if (links.empty()) return true;
    std::sort(links.begin(), links.end(),
              [](const Link& p, const Link& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
    const Island island{&m, 0, static_cast<int>(links.size())};
    const Island* one = &island;
    single.pack(links, &one, 1);
    survey_block(single.block);
    const float deepest = single.block.deepest.v[0];
    if (deepest <= kSettled) {
      tallies.deepest_overlap = std::max(tallies.deepest_overlap, static_cast<double>(deepest));
      return true;
    }
    if (round + 1 == kSettleRounds) return false;
    push_block(single.block, kSettlePushes);
    m.latch_work += single.block.work.v[0];
    take_poses(m);
  }
  return false;
}

bool Movers::settle(Motion& motion, Bodies& bodies, const Assemblies& assemblies, int slot,
                    Tallies& tallies) {
  Motion::Impl& m = *motion.impl_;
  if (m.latch_work > m.most_work / 4) return false;
  m.bodies = &bodies, m.assemblies = &assemblies, m.searched = false;
  return impl_->settle(m, slot, tallies);
}

Movers::Movers() : impl_(std::make_unique<Impl>()) {}
Movers::~Movers() = default;
Movers::Movers(Movers&&) noexcept = default;
Movers& Movers::operator=(Movers&&) noexcept = default;

void Movers::advance(std::span<InMotion> worlds) {
  Impl& all = *impl_;
  std::size_t bodies = 0;
  for (const InMotion& w : worlds) bodies += static_cast<std::size_t>(w.bodies->count);
  all.reserve(worlds.size(), bodies);
  all.going.clear();
  for (InMotion& w : worlds) {
    Motion::Impl& m = *w.motion->impl_;
    m.begin(w);
    if (m.slices > 0) all.going.push_back(&m);
  }
  while (!all.going.empty()) {
    all.slice();
    std::erase_if(all.going, [](Motion::Impl* m) {
      if (m->world->stalled >= 0) return true;
      m->finish();
      return m->slices == 0;
    });
  }
}

}  // namespace lilytank
