// A world takes no memory after its first step, and little before.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "support/scenes.hpp"

namespace {
std::atomic<std::int64_t> calls{0}, bytes{0};
}

void* operator new(std::size_t size) {
  ++calls, bytes += static_cast<std::int64_t>(size);
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t align) {
  ++calls, bytes += static_cast<std::int64_t>(size);
  const auto a = static_cast<std::size_t>(align);
  if (void* memory = std::aligned_alloc(a, (size + a - 1) / a * a)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace lilytank {
namespace {

TEST(Memory, NothingIsAllocatedAfterTheFirstStep) {
  const std::pair<Model, int> scenes[] = {{test::chain_scene(Clock::firmware), 20000},
                                          {test::chain_scene(Clock::events), 20000},
                                          {test::mixed_scene(), 20000},
                                          {test::packed_scene(), 2000}};
  for (const auto& [model, steps] : scenes) {
    World world(model, 5);
    world.step();
    const std::int64_t before = calls;
    for (int step = 0; step < steps; ++step) ASSERT_EQ(world.step(), RunStatus::ok);
    EXPECT_EQ(calls, before);
  }
}

TEST(Memory, NothingIsAllocatedToGoOnFromAnotherState) {
  const Model model = test::chain_scene(Clock::firmware);
  World world(model, 5), other(model, 6);
  for (int step = 0; step < 2000; ++step) world.step(), other.step();
  world.go_on_from(other.state());
  const std::int64_t before = calls;
  world.go_on_from(other.state());
  for (int step = 0; step < 200; ++step) ASSERT_EQ(world.step(), RunStatus::ok);
  EXPECT_EQ(calls, before);
}

TEST(Memory, AWorldOfFifteenLiliesHoldsUnder100Kilobytes) {
  const Model model = test::chain_scene(Clock::firmware);
  World(model, 6).step();  // scratch memory of the thread
  const std::int64_t before = bytes;
  World world(model, 5);
  world.step();
  EXPECT_LT(bytes - before, 100000);
}

}  // namespace
}  // namespace lilytank
