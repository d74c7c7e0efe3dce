#include "study/run_world.hpp"

#include <cmath>

#include "jobs/report.hpp"
#include "lilytank/assembly_record.hpp"

namespace lilytank {
namespace {

constexpr std::int64_t kStepsPerLook = 1024;  // between tellings of simulated time

bool asked(const std::atomic<bool>* stop) {
  return stop != nullptr && stop->load(std::memory_order_relaxed);
}

}  // namespace

std::optional<RunRow> run_world(const Study& study, int setting, int replicate,
                                const std::atomic<bool>* stop,
                                const std::function<void(double)>& simulated) {
  if (asked(stop)) return std::nullopt;
  const Scenario scenario = study.scenario(setting);
  const StudyPlan& plan = study.plan();
  RunRow row;
  row.setting = setting, row.replicate = replicate;
  row.seed = plan.seed_of(replicate), row.id = plan.id_of(setting, replicate);
  row.values = plan.settings[static_cast<std::size_t>(setting)].values;

  World world(scenario.model, row.seed);
  AssemblyRecord record(scenario.model);
  record.observe(world);
  const auto steps =
      static_cast<std::int64_t>(std::floor(scenario.duration / scenario.model.dt + 0.5));
  double told = 0;
  while (world.state().step < steps && row.status == RunStatus::ok) {
    if (asked(stop)) return std::nullopt;
    row.status = world.step();
    record.observe(world);
    if (world.state().step % kStepsPerLook != 0) continue;
    simulated(world.time() - told);
    told = world.time();
  }
  simulated(world.time() - told);
  row.duration = world.time();
  row.possible = record.possible_copies();
  row.copies = record.copies();
  row.illegal = record.illegal();
  row.completion = record.completion_times();
  if (row.status == RunStatus::diverged) {
    row.note = divergence_text(world.divergence(), scenario.model);
  }
  return row;
}

}  // namespace lilytank
