// How far a job is, on stderr: one line that changes on a terminal; elsewhere a plain line after 5
// s and then one every 30 s at least, whether or not the job reports anything.
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "cli/host.hpp"
#include "lilytank/job_control.hpp"

namespace lilytank::cli {

/// "40 s", "12 min", "2.5 h".
std::string duration_text(double seconds);

class Progress {
 public:
  /// The host must outlive it.
  Progress(bool quiet, const Host& host);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows the job's progress, and stops the job on a signal or where the host says so. The job
  /// must not outlive this object.
  void watch(JobControl& job);
  /// `done` is the fraction done, 0 .. 1; `note` is shown beside it, as "4200 times real time".
  void show(double done, const std::string& note);
  /// Takes the changing line away, before other output.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  void print(Clock::time_point now);
  void print_while_silent();
  std::string time_left(Clock::time_point now) const;

  const Host& host_;
  bool quiet_, terminal_;
  std::mutex lock_;  ///< of all below
  bool ended_ = false;
  std::condition_variable end_;
  double done_ = 0, first_done_ = -1;  ///< a resumed job begins in the middle
  std::string note_ = "preparing";
  std::size_t shown_ = 0;  ///< characters of the changing line
  Clock::time_point start_, first_, next_line_;
  std::thread clock_;
};

}  // namespace lilytank::cli
