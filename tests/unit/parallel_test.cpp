// Loops over worlds on several threads.
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

#include "lilytank/random.hpp"
#include "lilytank/study.hpp"
#include "support/scenes.hpp"

namespace lilytank {
namespace {

TEST(ForEachWorld, DoesEveryItemOnce) {
  for (const int threads : {0, 1, 3, 64}) {
    std::vector<std::atomic<int>> times(100);
    for_each_world(100, threads, [&](int i) { ++times[static_cast<std::size_t>(i)]; });
    for (const auto& n : times) EXPECT_EQ(n, 1) << threads;
  }
  for_each_world(0, 2, [](int) { FAIL(); });
}

TEST(ForEachWorld, LoopsWithinLoopsEnd) {
  std::atomic<int> items{0};
  for_each_world(4, 2, [&](int) { for_each_world(5, 2, [&](int) { ++items; }); });
  EXPECT_EQ(items, 20);
}

TEST(ForEachWorld, ThrowsAFailureOnceTheOthersHaveEnded) {
  for (const int threads : {1, 4}) {
    std::atomic<int> begun{0}, ended{0};
    try {
      for_each_world(1000, threads, [&](int i) {
        ++begun;
        if (i == 3) {
          ++ended;
          throw std::runtime_error("item 3");
        }
        ++ended;
      });
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& e) {
      EXPECT_STREQ(e.what(), "item 3");
    }
    EXPECT_EQ(begun, ended);
    EXPECT_LE(begun, threads == 1 ? 4 : 1000) << "nothing is begun after a failure";
  }
}

TEST(ForEachWorld, AnyNumberOfThreadsGivesTheSameBits) {
  const Model model = test::chain_scene(Clock::firmware);
  const auto final_hash = [&](int i) {
    World world(model, derived_seed(1, static_cast<std::uint64_t>(i)));
    test::advance(world, 10);
    return hex(fingerprint(world.state()));
  };
  std::vector<std::string> alone(12);
  for (int i = 0; i < 12; ++i) alone[static_cast<std::size_t>(i)] = final_hash(i);
  for (const int threads : {1, 2, 3, 5, 8}) {
    std::vector<std::string> together(12);
    for_each_world(12, threads,
                   [&](int i) { together[static_cast<std::size_t>(i)] = final_hash(i); });
    EXPECT_EQ(together, alone) << threads << " threads";
  }
}

}  // namespace
}  // namespace lilytank
