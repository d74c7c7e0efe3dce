// How far a job is, on stderr: one line that changes on a terminal; elsewhere a plain line after 5
// s and then one a minute.
#pragma once
#include <atomic>
#include <chrono>
#include <string>

namespace lilytank::cli {

class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` is the share done, 0 .. 1; `note` is shown beside it, as "4200 times real time".
  void show(double done, const std::string& note);
  /// Takes the changing line away, before other output.
  void clear();

 private:
  std::string time_left(double done) const;
  bool quiet_, terminal_;
  std::size_t shown_ = 0;  ///< characters of the changing line
  std::chrono::steady_clock::time_point start_, last_line_;
  double first_done_ = -1;
};

/// Becomes true once a signal requests a stop. The first call installs the handlers; a second
/// signal then ends the process at once, as usual.
const std::atomic<bool>& stop_signal();

}  // namespace lilytank::cli
