// The job behind `lilytank study`: what is missing, round by round, over threads.
#include <algorithm>
#include <chrono>

#include "study/row_text.hpp"
#include "study/run_table.hpp"
#include "study/run_world.hpp"
#include "study/study_directory.hpp"

namespace lilytank {
namespace {

constexpr double kBetweenTellings = 0.2;  // s of wall time

/// Adds up what all threads do. Wall time is for people; no result depends on it.
class Meter {
 public:
  Meter(const StudyPlan& plan, const StudyOptions& options) : plan_(&plan), options_(&options) {}

  /// A further round with these runs begins.
  void expect(const std::vector<RunPlace>& runs) {
    const std::lock_guard hold(lock_);
    for (const RunPlace& run : runs) {
      expected_ += plan_->settings[static_cast<std::size_t>(run.setting)].duration;
    }
    now_.left += static_cast<int>(runs.size());
  }

  void simulated(double seconds) {
    const std::lock_guard hold(lock_);
    simulated_ += seconds;
    tell();
  }

  void finished(const WorldRun& world) {
    const std::lock_guard hold(lock_);
    ++now_.runs, --now_.left;
    if (world.row.status == RunStatus::diverged) ++now_.failed;
    // What a world that was given up, or had settled, would still have had to do.
    const auto setting = static_cast<std::size_t>(world.row.setting);
    expected_ -= plan_->settings[setting].duration - world.simulated;
  }

  int runs() const { return now_.runs; }

 private:
  void tell() {
    if (!options_->progress) return;
    const double t = std::chrono::duration<double>(Clock::now() - start_).count();
    if (t - told_ < kBetweenTellings) return;
    told_ = t;
    now_.done = expected_ > 0 ? std::min(1.0, simulated_ / expected_) : 1;
    now_.worlds_per_second = now_.runs / t;
    now_.hours_per_second = simulated_ / 3600 / t;
    options_->progress(now_);
  }

  using Clock = std::chrono::steady_clock;
  const StudyPlan* plan_;
  const StudyOptions* options_;
  std::mutex lock_;
  StudyProgress now_;
  double simulated_ = 0, expected_ = 0, told_ = 0;
  Clock::time_point start_ = Clock::now();
};

class Job {
 public:
  Job(const Study& study, const StudyOptions& options)
      : study_(&study),
        options_(&options),
        plan_(&study.plan()),
        identity_(plan_->identity()),
        run_table_(*plan_),
        writer_(options.out),
        meter_(*plan_, options) {}

  StudyResult run() {
    open_study_directory(options_->out, *plan_, options_->force, lock_);
    read();
    if (options_->begin) options_->begin(static_cast<int>(missing_here().size()));
    for (;;) {
      const std::vector<RunPlace> ours = missing_here();
      if (ours.empty() || stopped()) break;
      round(ours);
      if (plan_->stop && options_->shard.count > 1) read();  // what others did meanwhile
    }
    StudyResult result;
    result.complete = run_table_.complete();
    result.stopped = stopped() && !missing_here().empty();
    result.waiting = !result.stopped && !decided();
    result.runs = meter_.runs();
    result.failed = run_table_.failed();
    return result;
  }

 private:
  bool stopped() const {
    return options_->stop != nullptr && options_->stop->load(std::memory_order_relaxed);
  }

  bool decided() const {
    for (std::size_t s = 0; s < plan_->settings.size(); ++s) {
      if (!run_table_.required(static_cast<int>(s)).decided) return false;
    }
    return true;
  }

  void read() {
    std::string foreign;
    for (RunRow& row : read_rows(options_->out, *plan_, foreign)) run_table_.add(std::move(row));
  }

  std::vector<RunPlace> missing_here() const {
    std::vector<RunPlace> runs = run_table_.missing();
    std::erase_if(runs, [&](const RunPlace& run) {
      return !options_->shard.holds(plan_->id_of(run.setting, run.replicate));
    });
    return runs;
  }

  void round(const std::vector<RunPlace>& runs) {
    meter_.expect(runs);
    for_each_world(static_cast<int>(runs.size()), options_->threads, [&](int i) {
      const RunPlace& run = runs[static_cast<std::size_t>(i)];
      auto world = run_world(*study_, run.setting, run.replicate, options_->stop,
                             [&](double seconds) { meter_.simulated(seconds); });
      if (!world) return;
      writer_.write(row_line(world->row, identity_));
      meter_.finished(*world);
      const std::lock_guard hold(ledger_lock_);
      run_table_.add(std::move(world->row));
    });
  }

  const Study* study_;
  const StudyOptions* options_;
  const StudyPlan* plan_;
  std::uint64_t identity_;
  RunTable run_table_;
  std::mutex ledger_lock_;
  DirectoryLock lock_;
  RowWriter writer_;
  Meter meter_;
};

}  // namespace

StudyResult run_study(const Study& study, const StudyOptions& options) {
  return Job(study, options).run();
}

}  // namespace lilytank
