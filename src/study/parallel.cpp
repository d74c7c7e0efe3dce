#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <system_error>
#include <thread>
#include <vector>

#include "lilytank/study.hpp"

namespace lilytank {
namespace {

constexpr int kProbed = 32;  // more than this only where the first loop asks for them

/// How many threads the system grants beside this one, up to `wanted`.
int granted_threads(int wanted) {
  std::atomic<bool> counted{false};
  std::vector<std::thread> threads;
  try {
    while (static_cast<int>(threads.size()) < wanted) {
      threads.emplace_back([&] { counted.wait(false); });
    }
  } catch (const std::system_error&) {
    // Limited (ulimit -u, a container's pids).
  }
  counted = true;
  counted.notify_all();
  for (std::thread& thread : threads) thread.join();
  return static_cast<int>(threads.size());
}

}  // namespace

void for_each_world(int count, int threads, const std::function<void(int)>& work,
                    const JobControl& control) {
  // More threads than cores on request. TBB ends the program where it cannot make a thread, so the
  // threads are counted before its first use; later its own would count against the limit.
  const int cores = tbb::info::default_concurrency();
  static const int most = 1 + granted_threads(std::max({threads, cores, kProbed}) - 1);
  const int used = std::min(threads > 0 ? threads : cores, most);
  if (used == 1) {
    for (int i = 0; i < count; ++i) control.check_stop(), work(i);
    return;
  }
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(used));
  tbb::task_arena arena(used);
  // One world a task: they differ in length, and a world is long beside a task's cost.
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, count, 1),
        [&](const tbb::blocked_range<int>& range) {
          for (int i = range.begin(); i != range.end(); ++i) control.check_stop(), work(i);
        },
        tbb::simple_partitioner());
  });
}

}  // namespace lilytank
