#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "lilytank/study.hpp"

namespace lilytank {

void for_each_world(int count, int threads, const std::function<void(int)>& work) {
  // More threads than cores on request.
  const auto most = static_cast<std::size_t>(std::max(threads, tbb::info::default_concurrency()));
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, most);
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  // One world a task: they differ in length, and a world is long beside a task's cost.
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, count, 1),
        [&](const tbb::blocked_range<int>& range) {
          for (int i = range.begin(); i != range.end(); ++i) work(i);
        },
        tbb::simple_partitioner());
  });
}

}  // namespace lilytank
