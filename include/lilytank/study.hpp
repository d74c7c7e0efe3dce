// Many worlds at once. A world is never split over threads, so results do not depend on how many
// there are.
#pragma once
#include <functional>

namespace lilytank {

/// Calls work(i) once for each i in [0, count), up to `threads` at a time (0: one a core), in no
/// particular order. An exception of work is thrown on after the rest have ended.
void for_each_world(int count, int threads, const std::function<void(int)>& work);

}  // namespace lilytank
