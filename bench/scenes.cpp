#include "scenes.hpp"

#include <cmath>
#include <stdexcept>

namespace lilytank::bench {
namespace {

// The built-in tank's flow for a tank `wider` times as wide. Its inflow is weaker by as much: an
// inflow of the same speed over a longer way would pack all modules at the centre, where the
// paper's 15 are spread.
FlowField wide_flow(double radius, double wider) {
  const AnalyticTank tank{.radius = radius,
                          .cells = static_cast<int>(std::lround(AnalyticTank{}.cells * wider))};
  const FlowField as_is = analytic_tank(tank, Interpolation::bilinear);
  std::vector<FlowSample> samples = as_is.samples();
  const double pitch = 2 * radius / tank.cells;
  for (int i = 0; i < tank.cells * tank.cells; ++i) {
    const double x = (i % tank.cells + 0.5) * pitch - radius;
    const double y = (i / tank.cells + 0.5) * pitch - radius;
    FlowSample& flow = samples[i];
    const double away = (1 / wider - 1) * (flow.mu_x * x + flow.mu_y * y) / (x * x + y * y + 1e-12);
    flow.mu_x += away * x, flow.mu_y += away * y;
  }
  return {tank.cells, radius, samples, as_is.measured(), Interpolation::bilinear};
}

}  // namespace

double tank_radius(int modules) {
  return TankParameters{}.radius * std::sqrt(modules / 15.0);
}

Model loose_world(int modules, Gusts gusts) {
  Model model = standard_model();
  const double wider = tank_radius(modules) / model.tank.radius;
  model.tank.radius *= wider;
  model.start.radius *= wider;
  model.module.count = modules;
  model.flow.gusts = gusts;
  model.control.latches = false;
  if (modules != 15)
    model.field = std::make_shared<const FlowField>(wide_flow(model.tank.radius, wider));
  return model;
}

Model paper_world(int modules, Gusts gusts) {
  Model model = loose_world(modules, gusts);
  model.control.latches = true;
  model.rulesets = {read_ruleset(LILYTANK_SOURCE_DIR "/scenarios/rulesets/chain5.rules")};
  return model;
}

Model still_world() {
  Model model = paper_world();
  model.field =
      std::make_shared<const FlowField>(2, model.tank.radius, std::vector<FlowSample>(4),
                                        std::vector<bool>(4, true), Interpolation::bilinear);
  for (ActiveForce& force : model.forces) {
    if (force.term->name() == "stochastic") force.p[0] = 0;
  }
  model.start.layout = Layout::lattice;
  model.start.distance = 0.07;
  return model;
}

std::vector<Scene> scenes() {
  Model centre = paper_world(15, Gusts::per_module);
  centre.flow.at = FlowAt::centre;
  return {{"paper", paper_world()},
          {"paper, moment-matched gusts", paper_world(15, Gusts::moment_matched)},
          {"paper, gusts per module", paper_world(15, Gusts::per_module)},
          {"paper, gusts per module, centre", centre},
          {"still water", still_world()},
          {"60 modules", paper_world(60)},
          {"240 modules", paper_world(240)},
          {"1000 modules", paper_world(1000)}};
}

World advanced(World world, double seconds) {
  const auto steps = std::llround(seconds / world.model().dt);
  for (long long i = 0; i < steps; ++i) {
    if (world.step() != RunStatus::ok) throw std::runtime_error("a world of the bench diverged");
  }
  return world;
}

}  // namespace lilytank::bench
