// Loops over worlds on several threads.
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

#include "lilytank/study.hpp"

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

}  // namespace
}  // namespace lilytank
