#include "cli/progress.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <iostream>

namespace lilytank::cli {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kFirstLine = std::chrono::seconds(5);
constexpr auto kBetweenLines = std::chrono::seconds(60);

// A signal handler can reach nothing but a global.
std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void request_stop(int) {
  stop_requested.store(true, std::memory_order_relaxed);
}

double seconds(Clock::duration d) {
  return std::chrono::duration<double>(d).count();
}

std::string duration_text(double s) {
  char text[40];
  if (s < 90) {
    std::snprintf(text, sizeof text, "%.0f s", s);
  } else if (s < 5400) {
    std::snprintf(text, sizeof text, "%.0f min", s / 60);
  } else {
    std::snprintf(text, sizeof text, "%.1f h", s / 3600);
  }
  return text;
}

}  // namespace

Progress::Progress(bool quiet)
    : quiet_(quiet),
      terminal_(::isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_line_(start_ + kFirstLine - kBetweenLines) {}

Progress::~Progress() {
  clear();
}

void Progress::show(double done, const std::string& note) {
  if (quiet_) return;
  if (first_done_ < 0) first_done_ = done;  // a resumed job begins in the middle
  const auto now = Clock::now();
  if (!terminal_ && now - last_line_ < kBetweenLines) return;
  char share[32];
  std::snprintf(share, sizeof share, "%5.1f %%  ", 100 * done);
  const std::string line = share + note + "  " + time_left(done);
  last_line_ = now;
  if (!terminal_) {
    std::cerr << line << std::endl;
    return;
  }
  const std::size_t before = shown_;
  shown_ = line.size();
  std::cerr << '\r' << line << std::string(before > shown_ ? before - shown_ : 0, ' ')
            << std::flush;
}

std::string Progress::time_left(double done) const {
  const double here = done - first_done_;
  if (here <= 0) return "";
  return duration_text(seconds(Clock::now() - start_) * (1 - done) / here) + " left";
}

void Progress::clear() {
  if (shown_ > 0) std::cerr << '\r' << std::string(shown_, ' ') << '\r' << std::flush;
  shown_ = 0;
}

const std::atomic<bool>& stop_signal() {
  struct sigaction action {};
  action.sa_handler = request_stop;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A terminal that goes away, unless nohup said that it does not matter.
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
  return stop_requested;
}

}  // namespace lilytank::cli
