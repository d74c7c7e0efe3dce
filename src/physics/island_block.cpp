#include "island_block.hpp"

#include <bit>
#include <cmath>

// Compiled once for each instruction set, with the same bits from each: a lane is an island, and no
// number crosses lanes.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "physics/island_block.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Most blocks are full. A world by itself has few islands. A crowd is an island by itself: its
// numbers are to lie close together.
namespace sixteen {
namespace {
#define LILYTANK_LANES 16
// Each needs those before it.
// clang-format off
#include "lanes_inl.hpp"
#include "shapes_inl.hpp"
#include "island_lanes_inl.hpp"
#include "push_lanes_inl.hpp"
#include "contact_lanes_inl.hpp"
#include "stepper_lanes_inl.hpp"
// clang-format on
#undef LILYTANK_LANES
}  // namespace
}  // namespace sixteen

namespace four {
namespace {
#define LILYTANK_LANES 4
// Each needs those before it.
// clang-format off
#include "lanes_inl.hpp"
#include "shapes_inl.hpp"
#include "island_lanes_inl.hpp"
#include "push_lanes_inl.hpp"
#include "contact_lanes_inl.hpp"
#include "stepper_lanes_inl.hpp"
// clang-format on
#undef LILYTANK_LANES
}  // namespace
}  // namespace four

namespace one {
namespace {
#define LILYTANK_LANES 1
// Each needs those before it.
// clang-format off
#include "lanes_inl.hpp"
#include "shapes_inl.hpp"
#include "island_lanes_inl.hpp"
#include "push_lanes_inl.hpp"
#include "contact_lanes_inl.hpp"
#include "stepper_lanes_inl.hpp"
// clang-format on
#undef LILYTANK_LANES
}  // namespace
}  // namespace one

void run_sixteen(IslandBlock<16>& block) {
  sixteen::run(block);
}
void run_four(IslandBlock<4>& block) {
  four::run(block);
}
void run_one(IslandBlock<1>& block) {
  one::run(block);
}
void push_four(IslandBlock<4>& block, int rounds) {
  four::push(block, rounds);
}
void survey_four(IslandBlock<4>& block) {
  four::survey(block);
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lilytank {

HWY_EXPORT(run_sixteen);
HWY_EXPORT(run_four);
HWY_EXPORT(run_one);
HWY_EXPORT(push_four);
HWY_EXPORT(survey_four);

void run_block(IslandBlock<kBlockLanes>& block) {
  HWY_DYNAMIC_DISPATCH(run_sixteen)(block);
}
void run_block(IslandBlock<4>& block) {
  HWY_DYNAMIC_DISPATCH(run_four)(block);
}
void run_block(IslandBlock<1>& block) {
  HWY_DYNAMIC_DISPATCH(run_one)(block);
}
void push_block(IslandBlock<4>& block, int rounds) {
  HWY_DYNAMIC_DISPATCH(push_four)(block, rounds);
}
void survey_block(IslandBlock<4>& block) {
  HWY_DYNAMIC_DISPATCH(survey_four)(block);
}

}  // namespace lilytank
#endif
