// From a scenario to a directory of results, through any number of interruptions.
#include "lilytank/run.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>

#include "io/atomic_file.hpp"
#include "jobs/bonds.hpp"
#include "jobs/early_end.hpp"
#include "jobs/report.hpp"
#include "jobs/run_directory.hpp"
#include "jobs/run_files.hpp"
#include "jobs/stop_watch.hpp"
#include "text/number.hpp"
#include "text/refusals.hpp"

namespace lilytank {
namespace {

Tallies sum(const Tallies& a, const Tallies& b) {
  return {a.evaluations + b.evaluations, a.snaps_refused + b.snaps_refused,
          a.moves_undone + b.moves_undone, std::max(a.deepest_overlap, b.deepest_overlap)};
}

class Job {
 public:
  Job(const Scenario& scenario, const RunOptions& options)
      : scenario_(&scenario),
        options_(&options),
        directory_(options.out.empty()
                       ? nullptr
                       : std::make_unique<RunDirectory>(options.out, scenario, options.force)),
        world_(begin()),
        record_(scenario.model) {
    steps_ = planned_steps(scenario);
  }

  RunResult run() {
    if (directory_) directory_->open();
    if (directory_ && options_->lock != nullptr) *options_->lock = directory_->lock();
    const Checkpoint* before = checkpoint();
    if (before != nullptr) {
      refusals_of(directory_->path(run_file::checkpoint),
                  [&] { record_.restore(before->record, world_); });
      earlier_ = before->tallies;
      last_event_ = before->last_event;
      outcome_ = {before->status, before->divergence, before->tallies};
    }
    result_.resumed = before != nullptr && !before->finished;
    result_.already_complete = before != nullptr && before->finished;
    if (result_.already_complete) {
      directory_->check_files();
    } else {
      go_on();
    }
    report();
    return finished_result();
  }

 private:
  const Checkpoint* checkpoint() const {
    return directory_ && directory_->checkpoint() ? &*directory_->checkpoint() : nullptr;
  }

  World begin() const {
    if (const Checkpoint* before = checkpoint()) return {scenario_->model, before->state};
    return {scenario_->model, scenario_->seed};
  }

  // Steps to the end, to a divergence or to a stop.
  void go_on() {
    if (directory_) files_ = std::make_unique<RunFiles>(*scenario_, *directory_, record_.copies());
    if (!result_.resumed) {
      record_.observe(world_);
      if (files_) files_->observe(world_, record_);
    }
    first_step_ = world_.steps();
    while (!over_ && world_.steps() < steps_ && result_.status == RunStatus::ok) {
      if (options_->stop_requested()) {
        save(false);
        throw Stopped("stopped at " + without_rounding(world_.time()) + " s of " +
                      shortest(scenario_->duration) + " s; the same command resumes from there");
      }
      result_.status = world_.step();
      record_.observe(world_);
      if (files_) files_->observe(world_, record_);
      if (!world_.events().empty()) last_event_ = world_.steps();
      over_ = over(*scenario_, world_, record_, last_event_);
      look_at_clock();  // after every step: one may take seconds
    }
    outcome_ = {result_.status, world_.divergence(), sum(earlier_, world_.tallies())};
    if (files_) files_->finish(world_, record_);
    save(true);
  }

  void look_at_clock() {
    const auto done = static_cast<double>(world_.steps());
    const auto total = static_cast<double>(std::max<std::int64_t>(1, steps_));
    if (options_->progress && report_watch_.due(kBetweenReports)) {
      const double simulated = (done - static_cast<double>(first_step_)) * scenario_->model.dt;
      char note[48];
      std::snprintf(note, sizeof note, "%.0f times real time", simulated / watch_.seconds());
      options_->report(done / total, note);
    }
    // Not at the last step: what comes after it belongs to the checkpoint of the finished run.
    const bool more = !over_ && world_.steps() < steps_;
    if (more && save_watch_.due(options_->checkpoint_seconds)) save(false);
  }

  void save(bool finished) {
    if (!files_) return;
    Checkpoint c;
    c.finished = finished;
    c.status = outcome_.status == RunStatus::diverged ? outcome_.status : RunStatus::ok;
    c.divergence = outcome_.divergence;
    c.files = files_->flush();
    c.tallies = sum(earlier_, world_.tallies());
    if (scenario_->end.quiet_time > 0) c.last_event = last_event_;
    c.record = record_.to_text();
    c.state = world_.state();
    directory_->save(c);
  }

  void report() const {
    if (!directory_) return;
    directory_->put(run_file::rules, rules_table(scenario_->model, record_));
    directory_->put(run_file::species, species_table(record_));
    const std::string events = directory_->path(run_file::events);
    directory_->put(
        run_file::bonds,
        bonds_table(bonds_of(read_events(read_whole(events), events, scenario_->model.module.count),
                             scenario_->model)));
    directory_->put(run_file::summary_json, summary_json(*scenario_, world_, record_, outcome_));
    directory_->put(run_file::summary_text, summary_text(*scenario_, world_, record_, outcome_));
  }

  RunResult finished_result() {
    result_.status = outcome_.status;
    result_.time = world_.time();
    result_.wall = watch_.seconds();
    result_.fingerprint = fingerprint(world_.state());
    result_.copies = record_.copies();
    result_.possible = record_.possible_copies();
    result_.completion_times = record_.completion_times();
    result_.illegal = record_.illegal();
    result_.divergence = outcome_.divergence;
    return std::move(result_);
  }

  const Scenario* scenario_;
  const RunOptions* options_;
  std::unique_ptr<RunDirectory> directory_;
  World world_;
  AssemblyRecord record_;
  std::unique_ptr<RunFiles> files_;
  std::int64_t steps_ = 0, first_step_ = 0, last_event_ = 0;
  bool over_ = false;  // a condition of Scenario::end holds
  Tallies earlier_;    // of the calls before this one
  Outcome outcome_;
  RunResult result_;
  StopWatch watch_, report_watch_, save_watch_;
};

}  // namespace

RunResult run(const Scenario& scenario, const RunOptions& options) {
  return Job(scenario, options).run();
}

}  // namespace lilytank
