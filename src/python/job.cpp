#include "job.hpp"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace lilytank::python {
namespace {

namespace py = pybind11;

constexpr auto kBetweenSignals = std::chrono::milliseconds(50);

class Job {
 public:
  Job(bool reports, const std::function<void(const JobControl&)>& work) {
    control_.stop = &stop_;
    if (reports) {
      control_.progress = [this](double done, const std::string& note) {
        const std::lock_guard hold(lock_);
        report_ = {done, note};
      };
    }
    thread_ = std::thread([this, &work] { do_work(work); });
  }

  /// Whether the job has ended, once that is so or some time has passed.
  bool ended() {
    const py::gil_scoped_release release;
    std::unique_lock hold(lock_);
    return end_.wait_for(hold, kBetweenSignals, [this] { return ended_; });
  }
  /// The last report that was not yet taken.
  std::optional<std::pair<double, std::string>> take_report() {
    const std::lock_guard hold(lock_);
    return std::exchange(report_, std::nullopt);
  }
  void stop() { stop_ = true; }
  /// Waits for the end; what the work threw.
  std::exception_ptr join() {
    const py::gil_scoped_release release;
    thread_.join();
    return failure_;
  }

 private:
  void do_work(const std::function<void(const JobControl&)>& work) {
    try {
      work(control_);
    } catch (...) {
      failure_ = std::current_exception();
    }
    const std::lock_guard hold(lock_);
    ended_ = true;
    end_.notify_all();
  }

  std::atomic<bool> stop_{false};
  JobControl control_;
  std::mutex lock_;  ///< of the two below
  bool ended_ = false;
  std::optional<std::pair<double, std::string>> report_;
  std::condition_variable end_;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace

void run_job(const py::object& progress, const std::function<void(const JobControl& control)>& work,
             const std::function<void()>& check) {
  Job job(!progress.is_none(), work);
  std::exception_ptr interruption;
  while (!job.ended()) {
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (const auto report = job.take_report()) progress(report->first, report->second);
      if (check) check();
    } catch (...) {
      if (!interruption) interruption = std::current_exception();
      job.stop();
    }
  }
  const std::exception_ptr failure = job.join();
  if (interruption) std::rethrow_exception(interruption);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace lilytank::python
