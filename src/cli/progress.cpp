#include "cli/progress.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <iostream>
#include <system_error>

#include "text/printable.hpp"

namespace lilytank::cli {
namespace {

constexpr auto kFirstLine = std::chrono::seconds(5), kBetweenLines = std::chrono::seconds(30);
constexpr auto kBetweenChanges = std::chrono::milliseconds(200);  // of the line on a terminal
// Before so much is done the mean rate is that of the first few rows, and says little.
constexpr double kEnoughDone = 0.03;
constexpr auto kEnoughTime = std::chrono::minutes(2);

// A signal handler can reach nothing but a global.
std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void request_stop(int) {
  stop_requested.store(true, std::memory_order_relaxed);
}

/// Becomes true once a signal requests a stop. The first call installs the handlers; a second
/// signal then ends the process at once, as usual.
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

double seconds(std::chrono::steady_clock::duration d) {
  return std::chrono::duration<double>(d).count();
}

}  // namespace

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

Progress::Progress(bool quiet, const Host& host)
    : host_(host),
      quiet_(quiet || host.progress),
      terminal_(::isatty(STDERR_FILENO) != 0),
      start_(Clock::now()) {
  next_line_ = terminal_ ? start_ : start_ + kFirstLine;
  if (quiet_ || terminal_) return;
  try {
    clock_ = std::thread([this] { print_while_silent(); });
  } catch (const std::system_error&) {
    // Threads are limited: then there are lines only where the job reports.
  }
}

Progress::~Progress() {
  {
    const std::lock_guard hold(lock_);
    ended_ = true;
  }
  end_.notify_all();
  if (clock_.joinable()) clock_.join();
  clear();
}

void Progress::watch(JobControl& job) {
  job.stop = host_.stop != nullptr ? host_.stop : &stop_signal();
  job.progress = [this](double done, const std::string& note) { show(done, note); };
}

void Progress::show(double done, const std::string& note) {
  if (host_.progress) host_.progress(done, note);
  if (quiet_) return;
  const std::lock_guard hold(lock_);
  const auto now = Clock::now();
  if (first_done_ < 0) first_done_ = done, first_ = now;
  done_ = done, note_ = note;
  if (now >= next_line_) print(now);
}

// A job may work for minutes on what it cannot count.
void Progress::print_while_silent() {
  std::unique_lock hold(lock_);
  while (!ended_) {
    const auto due = next_line_;
    const auto over = [this] { return ended_; };
    if (end_.wait_until(hold, due, over)) return;
    if (Clock::now() >= next_line_) print(Clock::now());
  }
}

void Progress::print(Clock::time_point now) {
  char share[32];
  std::snprintf(share, sizeof share, "%5.1f %%  ", 100 * done_);
  std::string line = share + printable(note_) + "  " + time_left(now);
  next_line_ = now + (terminal_ ? Clock::duration(kBetweenChanges) : kBetweenLines);
  if (!terminal_) {
    // Not by std::cerr, which the job's own thread may be using.
    line += "\n";
    static_cast<void>(!::write(STDERR_FILENO, line.data(), line.size()));
    return;
  }
  const std::size_t before = shown_;
  shown_ = line.size();
  std::cerr << '\r' << line << std::string(before > shown_ ? before - shown_ : 0, ' ')
            << std::flush;
}

std::string Progress::time_left(Clock::time_point now) const {
  const double here = done_ - first_done_, rest = 1 - done_;
  const bool known = first_done_ >= 0 && here > 0 &&
                     (here >= kEnoughDone * (1 - first_done_) || now - first_ >= kEnoughTime);
  if (!known) return duration_text(seconds(now - start_)) + " so far";
  return duration_text(seconds(now - first_) * rest / here) + " left";
}

void Progress::clear() {
  const std::lock_guard hold(lock_);
  if (shown_ > 0) std::cerr << '\r' << std::string(shown_, ' ') << '\r' << std::flush;
  shown_ = 0;
}

}  // namespace lilytank::cli
