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

// Emulated vectors cost more than no vectors, and most of the compiler's time.
#if HWY_TARGET != HWY_EMU128
#define LILYTANK_VECTORS 1
#endif

// Most blocks are full. A world by itself has few islands. A crowd is an island by itself: its
// numbers are to lie close together.
#ifdef LILYTANK_VECTORS
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
#endif

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

#ifdef LILYTANK_VECTORS
bool vectors() {
  return true;
}
void run_sixteen(IslandBlock<16>& block) {
  sixteen::run(block);
}
void run_four(IslandBlock<4>& block) {
  four::run(block);
}
#else
bool vectors() {
  return false;
}
void run_sixteen(IslandBlock<16>&) {}
void run_four(IslandBlock<4>&) {}
#endif
#undef LILYTANK_VECTORS
void run_one(IslandBlock<1>& block) {
  one::run(block);
}
void push_one(IslandBlock<1>& block, int rounds) {
  one::push(block, rounds);
}
void survey_one(IslandBlock<1>& block) {
  one::survey(block);
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lilytank {

HWY_EXPORT(vectors);
HWY_EXPORT(run_sixteen);
HWY_EXPORT(run_four);
HWY_EXPORT(run_one);
HWY_EXPORT(push_one);
HWY_EXPORT(survey_one);

bool islands_share_vectors() {
  return HWY_DYNAMIC_DISPATCH(vectors)();
}
void run_block(IslandBlock<kBlockLanes>& block) {
  HWY_DYNAMIC_DISPATCH(run_sixteen)(block);
}
void run_block(IslandBlock<kFewLanes>& block) {
  HWY_DYNAMIC_DISPATCH(run_four)(block);
}
void run_block(IslandBlock<1>& block) {
  HWY_DYNAMIC_DISPATCH(run_one)(block);
}
void push_block(IslandBlock<1>& block, int rounds) {
  HWY_DYNAMIC_DISPATCH(push_one)(block, rounds);
}
void survey_block(IslandBlock<1>& block) {
  HWY_DYNAMIC_DISPATCH(survey_one)(block);
}

}  // namespace lilytank
#endif
