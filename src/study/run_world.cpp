#include "study/run_world.hpp"

#include "jobs/report.hpp"

namespace lilytank {
namespace {

constexpr std::int64_t kStepsPerLook = 64;  // between reports of simulated time

}  // namespace

WorldRun run_world(const Scenario& scenario, std::uint64_t seed, EarlyEnd early,
                   const JobControl& control, const std::function<void(double)>& simulated) {
  control.check_stop();
  WorldRun out;
  RunRow& row = out.row;
  row.seed = seed;
  World world(scenario.model, seed);
  AssemblyRecord record(scenario.model);
  record.observe(world);
  const double dt = scenario.model.dt;
  const std::int64_t steps = planned_steps(scenario);
  double reported = 0;
  const auto report = [&] {
    if (simulated) simulated(world.time() - reported);
    reported = world.time();
  };
  bool left = false;
  while (world.steps() < steps && row.status == RunStatus::ok && !left) {
    control.check_stop();
    row.status = world.step();
    record.observe(world);
    // Looked at where something happened: what stands changes with events only.
    left = !world.events().empty() && over(early, world, record);
    if (world.steps() % kStepsPerLook == 0) report();
  }
  report();
  out.simulated = world.time();
  row.duration = left ? static_cast<double>(steps) * dt : world.time();
  row.possible = record.possible_copies();
  row.copies = record.copies();
  row.illegal = record.illegal();
  row.completion = record.completion_times();
  if (row.status == RunStatus::diverged) {
    row.note = divergence_text(world.divergence(), scenario.model);
  }
  return out;
}

WorldRun run_world(const Study& study, int setting, int replicate, const JobControl& control,
                   const std::function<void(double)>& simulated) {
  control.check_stop();
  const StudyPlan& plan = study.plan();
  WorldRun out =
      run_world(study.scenario(setting), plan.seed_of(replicate),
                plan.until_settled ? EarlyEnd::settled : EarlyEnd::never, control, simulated);
  out.row.setting = setting, out.row.replicate = replicate;
  out.row.id = plan.id_of(setting, replicate);
  out.row.values = plan.settings[static_cast<std::size_t>(setting)].values;
  return out;
}

}  // namespace lilytank
