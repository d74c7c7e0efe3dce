// The job behind `lilytank study`: what is missing, round by round, over threads.
#include <algorithm>
#include <cstdio>
#include <mutex>

#include "jobs/stop_watch.hpp"
#include "study/row_log.hpp"
#include "study/row_text.hpp"
#include "study/run_table.hpp"
#include "study/run_world.hpp"
#include "study/study_directory.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

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
    left_ += static_cast<int>(runs.size());
  }

  void simulated(double seconds) {
    const std::lock_guard hold(lock_);
    simulated_ += seconds;
    if (options_->progress && reports_.due(kBetweenReports)) report();
  }

  void finished(const WorldRun& world) {
    const std::lock_guard hold(lock_);
    ++runs_, --left_;
    if (world.row.status == RunStatus::diverged) ++failed_;
    // What a world that was given up, or had settled, would still have had to do.
    const auto setting = static_cast<std::size_t>(world.row.setting);
    expected_ -= plan_->settings[setting].duration - world.simulated;
  }

  int runs() const { return runs_; }

 private:
  void report() const {
    const double t = watch_.seconds();
    char note[120];
    std::snprintf(note, sizeof note, "%d runs, %d left, %.3g simulations/s, %.3g simulated h/s%s%s",
                  runs_, left_, runs_ / t, simulated_ / 3600 / t, failed_ > 0 ? ", diverged: " : "",
                  failed_ > 0 ? std::to_string(failed_).c_str() : "");
    options_->report(expected_ > 0 ? std::min(1.0, simulated_ / expected_) : 1, note);
  }

  const StudyPlan* plan_;
  const StudyOptions* options_;
  std::mutex lock_;
  int runs_ = 0, failed_ = 0, left_ = 0;  ///< in this call
  double simulated_ = 0, expected_ = 0;   ///< s of simulated time
  StopWatch watch_, reports_;
};

class Job {
 public:
  Job(const Study& study, const StudyOptions& options)
      : study_(&study),
        options_(&options),
        plan_(&study.plan()),
        identity_(plan_->identity()),
        run_table_(*plan_),
        meter_(*plan_, options) {}

  StudyResult run() {
    open_study_directory(options_->out, *plan_, options_->force, directory_lock_);
    read();
    if (options_->begin) options_->begin(static_cast<int>(missing_here().size()));
    try {
      for (auto ours = missing_here(); !ours.empty(); ours = missing_here()) {
        round(ours);
        if (plan_->stop && options_->shard.count > 1) read();  // what others did meanwhile
      }
    } catch (const Stopped&) {
      throw Stopped("stopped after " + counted(meter_.runs(), "run") +
                    ", which are kept; the same command resumes the study");
    }
    StudyResult result;
    result.complete = run_table_.complete();
    result.waiting = !decided();
    result.runs = meter_.runs();
    result.failed = run_table_.failed();
    return result;
  }

 private:
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
    const auto one = [&](int i) {
      const RunPlace& run = runs[static_cast<std::size_t>(i)];
      WorldRun world = run_world(*study_, run.setting, run.replicate, *options_,
                                 [&](double seconds) { meter_.simulated(seconds); });
      log().append(row_line(world.row, identity_));
      meter_.finished(world);
      const std::lock_guard hold(lock_);
      run_table_.add(std::move(world.row));
    };
    for_each_world(static_cast<int>(runs.size()), options_->threads, one, *options_);
  }

  /// The rows file of this call, begun with its first row.
  RowLog& log() {
    const std::lock_guard hold(lock_);
    if (!log_) log_.emplace(claim_rows_file(options_->out), row_header(), "");
    return *log_;
  }

  const Study* study_;
  const StudyOptions* options_;
  const StudyPlan* plan_;
  std::uint64_t identity_;
  RunTable run_table_;
  std::mutex lock_;
  DirectoryLock directory_lock_;
  std::optional<RowLog> log_;
  Meter meter_;
};

}  // namespace

StudyResult run_study(const Study& study, const StudyOptions& options) {
  return Job(study, options).run();
}

}  // namespace lilytank
