#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "lilytank/study.hpp"

namespace lilytank {
namespace {

/// Items of a loop, taken one by one by any number of threads.
class Loop {
 public:
  Loop(int count, const std::function<void(int)>& work) : count_(count), work_(&work) {}

  /// Works until nothing is left, or an item has failed.
  void run() noexcept {
    while (!failed_.load(std::memory_order_relaxed)) {
      const int i = next_.fetch_add(1, std::memory_order_relaxed);
      if (i >= count_) return;
      try {
        (*work_)(i);
      } catch (...) {
        fail(i);
      }
    }
  }
  /// Throws the failure of the first item that failed, if one did.
  void check() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void fail(int item) {
    const std::lock_guard hold(lock_);
    if (!error_ || item < item_) error_ = std::current_exception(), item_ = item;
    failed_ = true;
  }

  const int count_;
  const std::function<void(int)>* work_;
  std::atomic<int> next_{0};
  std::atomic<bool> failed_{false};
  std::mutex lock_;
  std::exception_ptr error_;
  int item_ = 0;
};

int most_threads(int count, int threads) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return std::min(count, threads > 0 ? threads : cores);
}

}  // namespace

void for_each_world(int count, int threads, const std::function<void(int)>& work) {
  Loop loop(count, work);
  std::vector<std::thread> helpers;
  try {
    for (int n = most_threads(count, threads); n > 1; --n) {
      helpers.emplace_back([&] { loop.run(); });
    }
  } catch (const std::exception&) {
    // Threads or memory are limited (ulimit -u, a container's pids): fewer threads do the same.
  }
  loop.run();
  for (std::thread& helper : helpers) helper.join();
  loop.check();
}

}  // namespace lilytank
