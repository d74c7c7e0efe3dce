#include "settle.hpp"

#include <algorithm>

namespace lilytank {
namespace {

constexpr double kSettled = 2.5e-4;  // m, overlap that is left
constexpr double kMargin = 1e-3;     // m, what is nearer than this may be pushed
constexpr int kRounds = 30;          // searches for what got in the way
constexpr int kPushes = 20;          // sweeps between two searches

}  // namespace

Settling::Settling(const Model& model)
    : model_(&model),
      neighbours_(model.bodies(), model.tank.radius),
      x_(static_cast<std::size_t>(model.bodies())),
      y_(x_.size()) {}

// Finds the neighbours of all bodies where they are now.
void Settling::search(const Assemblies& assemblies, const IslandBuilder& builder) {
  std::copy(assemblies.x.begin(), assemblies.x.end(), x_.begin());
  std::copy(assemblies.y.begin(), assemblies.y.end(), y_.begin());
  for (const int slot : builder.slots()) {
    for (int i = assemblies.first[slot]; i >= 0; i = assemblies.next[i]) {
      const Vec2 at = builder.centre_of(i);
      x_[i] = at.x(), y_[i] = at.y();
    }
  }
  double largest = model_->module.count > 0 ? builder.size_of(0) : 0;
  if (model_->ball.count > 0) largest = std::max(largest, model_->ball.radius);
  neighbours_.search(x_, y_, 2 * largest + kMargin);
}

// Pairs up body i of the k-th assembly with what is near it now; that joins the island. Assemblies
// before the k-th were paired with this one already.
void Settling::pair_body(int i, int k, IslandBuilder& builder) const {
  const Vec2 at(x_[i], y_[i]);
  const double rim = model_->tank.radius - builder.size_of(i) - kMargin;
  if (rim < 0 || at.squaredNorm() > rim * rim) builder.link_wall(i);
  neighbours_.around(i, [&](int j) {
    const int other = builder.slot_of(j), index = builder.index_of(other);
    if (other == builder.slot_of(i) || (index > 0 && index <= k)) return;
    const double near = builder.size_of(i) + builder.size_of(j) + kMargin;
    if ((Vec2(x_[j], y_[j]) - at).squaredNorm() > near * near) return;
    if (index == 0) builder.enter(other, 0);
    builder.link(i, j);
  });
}

bool Settling::make_room(const Assemblies& assemblies, int slot, IslandBuilder& builder) {
  builder.enter(slot, 0);
  Island& island = builder.island();
  for (int round = 0; round < kRounds; ++round) {
    if (round > 0) island.push_apart(kPushes);
    island.forget_pairs();
    search(assemblies, builder);
    const int count = static_cast<int>(builder.slots().size());
    for (int k = 0; k < count; ++k) {
      const int member_of = builder.slots()[k];
      for (int i = assemblies.first[member_of]; i >= 0; i = assemblies.next[i])
        pair_body(i, k, builder);
    }
    island.sort_pairs();
    if (island.survey() <= kSettled) return true;
  }
  return false;
}

}  // namespace lilytank
