#include "settle.hpp"

namespace lilytank {
namespace {

constexpr double kSettled = 2.5e-4;  // m, overlap that is left
constexpr double kMargin = 1e-3;     // m, what is nearer than this may be pushed
constexpr int kRounds = 30;          // searches for what got in the way
constexpr int kSweeps = 20;          // sweeps between two searches

// Pairs up body i of the k-th assembly with what is near it now; that joins the island. Assemblies
// before the k-th were paired with this one already.
void pair_body(const Model& model, int i, int k, IslandBuilder& builder) {
  const Vec2 at = builder.centre_of(i);
  const double rim = model.tank.radius - builder.size_of(i) - kMargin;
  if (rim < 0 || at.squaredNorm() > rim * rim) builder.link_wall(i);
  for (int j = 0; j < model.bodies(); ++j) {
    const int other = builder.slot_of(j), index = builder.index_of(other);
    if (other == builder.slot_of(i) || (index > 0 && index <= k)) continue;
    const double near = builder.size_of(i) + builder.size_of(j) + kMargin;
    if ((builder.centre_of(j) - at).squaredNorm() > near * near) continue;
    if (index == 0) builder.enter(other, 0);
    builder.link(i, j);
  }
}

}  // namespace

bool make_room(const Model& model, const Assemblies& assemblies, int slot, IslandBuilder& builder) {
  builder.enter(slot, 0);
  Island& island = builder.island();
  for (int round = 0; round < kRounds; ++round) {
    if (round > 0) island.push_apart(kSweeps);
    island.forget_pairs();
    const int count = static_cast<int>(builder.slots().size());
    for (int k = 0; k < count; ++k) {
      const int member_of = builder.slots()[k];
      for (int i = assemblies.first[member_of]; i >= 0; i = assemblies.next[i])
        pair_body(model, i, k, builder);
    }
    island.sort_pairs();
    if (island.survey() <= kSettled) return true;
  }
  return false;
}

}  // namespace lilytank
