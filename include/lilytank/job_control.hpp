// How every job of the library reports its progress and is stopped.
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "lilytank/error.hpp"

namespace lilytank {

/// The base of each job's options.
struct JobControl {
  /// Set by a signal. The job then throws Stopped: simulations under way are abandoned, finished
  /// work is kept, and the same call goes on from there.
  const std::atomic<bool>* stop = nullptr;
  /// Receives the fraction of the work that is done, 0 .. 1, and words on it, as "round 2 of 4,
  /// best 3100 s". Called by one thread at a time.
  std::function<void(double done, const std::string& note)> progress;

  bool stop_requested() const { return stop != nullptr && stop->load(std::memory_order_relaxed); }
  /// Throws Stopped once `stop` is set.
  void check_stop() const {
    if (stop_requested()) throw Stopped();
  }
  void report(double done, const std::string& note) const {
    if (progress) progress(done, note);
  }
};

}  // namespace lilytank
