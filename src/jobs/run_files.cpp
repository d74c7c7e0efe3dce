#include "jobs/run_files.hpp"

#include <algorithm>
#include <cmath>

#include "io/scenario_commands.hpp"
#include "lilytank/run_events.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

/// The rule that fired, or what the base station said.
std::string rule_of(const Event& event, const World& world) {
  const Model& model = world.model();
  if (event.kind == EventKind::command) {
    return event.a < 0 ? "" : command_word(command_at(model, event.a).kind);
  }
  const auto ruleset = static_cast<std::size_t>(world.firmware().ruleset);
  if (event.rule < 0 || ruleset >= model.rulesets.size()) return "";
  return model.rulesets[ruleset].rules[static_cast<std::size_t>(event.rule)].name;
}

/// One side's cells: module and face, or label and connector; empty without a module.
std::string pair_of(bool there, int first, int second) {
  if (!there) return ",,";
  return "," + std::to_string(first) + "," + (second < 0 ? "" : std::to_string(second));
}

std::string row_of(const Event& event, const World& world) {
  const bool spoken = event.kind == EventKind::command;
  const bool a = event.a >= 0 && !spoken, b = event.b >= 0;
  return without_rounding(world.time()) + "," + std::to_string(world.steps()) + "," +
         event_words()[static_cast<std::size_t>(event.kind)] + pair_of(a, event.a, event.face_a) +
         pair_of(b, event.b, event.face_b) + "," + rule_of(event, world) +
         pair_of(a, event.label_a, event.last_a) + pair_of(b, event.label_b, event.last_b) + ",\n";
}

std::string metric_columns(int modules) {
  std::string out = "time,copies,most_copies,singles";
  for (int n = 2; n <= modules; ++n) out += ",size_" + std::to_string(n);
  return out + ",illegal\n";
}

const FileDigest* kept(const RunDirectory& directory, FileDigest RunFileDigests::*file) {
  const auto& checkpoint = directory.checkpoint();
  return checkpoint ? &(checkpoint->files.*file) : nullptr;
}

AppendFile begun_or_resumed(const std::string& file, const FileDigest* keep) {
  return keep == nullptr ? AppendFile(file) : AppendFile(file, *keep);
}

std::int64_t step_done(const RunDirectory& directory) {
  const auto& checkpoint = directory.checkpoint();
  return checkpoint ? checkpoint->state.step : -1;
}

}  // namespace

Schedule::Schedule(double interval, std::int64_t done) : interval_(std::max(1.0, interval)) {
  if (done < 0) return;
  next_ = std::max<std::int64_t>(
      0, static_cast<std::int64_t>(static_cast<double>(done) / interval_) - 1);
  while (step_of(next_) <= done) ++next_;
}

std::int64_t Schedule::step_of(std::int64_t index) const {
  return static_cast<std::int64_t>(std::floor(static_cast<double>(index) * interval_ + 0.5));
}

bool Schedule::due(std::int64_t step) {
  if (step < step_of(next_)) return false;
  ++next_;
  return true;
}

RunFiles::RunFiles(const Scenario& scenario, const RunDirectory& directory, int copies)
    : scenario_(&scenario),
      trajectory_(open_trajectory(directory.trajectory_path(), scenario.output.trajectory,
                                  scenario.model, kept(directory, &RunFileDigests::trajectory))),
      events_(begun_or_resumed(directory.path(run_file::events),
                               kept(directory, &RunFileDigests::events))),
      metrics_(begun_or_resumed(directory.path(run_file::metrics),
                                kept(directory, &RunFileDigests::metrics))),
      frames_due_(1 / (scenario.output.rate * scenario.model.dt), step_done(directory)),
      metrics_due_(scenario.output.metrics_interval / scenario.model.dt, step_done(directory)),
      copies_(copies) {
  if (directory.checkpoint()) return;
  events_.append(kEventColumns + "\n");
  metrics_.append(metric_columns(scenario.model.module.count));
}

void RunFiles::observe(const World& world, const AssemblyRecord& record) {
  events(world, record);
  const std::int64_t step = world.steps();
  if (frames_due_.due(step)) trajectory_->write(world, record.complete());
  if (metrics_due_.due(step)) metrics(world, record);
}

void RunFiles::finish(const World& world, const AssemblyRecord& record) {
  if (metrics_step_ != world.steps()) metrics(world, record);
}

RunFileDigests RunFiles::flush() {
  return {trajectory_->flush(), events_.flush(), metrics_.flush()};
}

void RunFiles::events(const World& world, const AssemblyRecord& record) {
  for (const Event& event : world.events()) events_.append(row_of(event, world));
  if (record.copies() == copies_) return;
  copies_ = record.copies();
  events_.append(without_rounding(world.time()) + "," + std::to_string(world.steps()) + "," +
                 event_words()[kCopyEvent] + ",,,,,,,,,," + std::to_string(copies_) + "\n");
}

void RunFiles::metrics(const World& world, const AssemblyRecord& record) {
  metrics_step_ = world.steps();
  std::string row = without_rounding(world.time()) + "," + std::to_string(record.copies()) + "," +
                    std::to_string(record.most_copies());
  const int modules = scenario_->model.module.count;
  for (int n = 1; n <= std::max(1, modules); ++n) {
    const auto i = static_cast<std::size_t>(n);
    const int standing = i < record.by_size().size() ? record.by_size()[i] : 0;
    row += "," + std::to_string(standing);
  }
  metrics_.append(row + "," + std::to_string(record.illegal()) + "\n");
}

}  // namespace lilytank
