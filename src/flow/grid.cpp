#include "flow/grid.hpp"

#include <algorithm>
#include <cmath>

#include "text/number.hpp"

namespace lilytank {

int FlowGrid::cell_at(double x, double y) const {
  const double gx = std::floor((x + extent) / width()), gy = std::floor((y + extent) / width());
  if (!(gx >= 0 && gy >= 0 && gx < cells && gy < cells)) return -1;
  return static_cast<int>(gy) * cells + static_cast<int>(gx);
}

FlowEstimate empty_estimate(std::span<const Recording> recordings, const BallPhysics& ball,
                            const FlowOptions& options, const char* name) {
  if (options.cells < 4 || options.cells > 400) {
    throw InputError("a flow grid needs 4 .. 400 cells a side, not " +
                     std::to_string(options.cells));
  }
  const bool usable = ball.mass > 0 && ball.drag_rate() > 0 && std::isfinite(ball.drag_rate()) &&
                      ball.draws >= 1 && ball.tank_radius > 0 && ball.radius >= 0;
  if (!usable) throw InputError("the balls' mass, drag and tank must be positive numbers");
  const bool balls = std::any_of(recordings.begin(), recordings.end(),
                                 [](const Recording& r) { return r.body == BodyKind::ball; });
  if (!balls) {
    throw InputError(
        "the flow is found from balls, and no recording that may be used is of body = \"ball\"");
  }
  FlowEstimate out;
  out.name = name;
  out.cells = options.cells;
  out.extent = ball.tank_radius;
  out.cell.resize(static_cast<std::size_t>(options.cells) *
                  static_cast<std::size_t>(options.cells));
  return out;
}

void fill_cells(FlowEstimate& estimate) {
  if (estimate.measured() == 0) {
    throw InputError(
        "no cell of the flow grid was visited often enough: longer recordings or "
        "fewer cells are needed");
  }
  const FlowField field = field_of(estimate, Interpolation::bilinear);
  for (std::size_t i = 0; i < estimate.cell.size(); ++i) {
    if (!estimate.cell[i].measured) estimate.cell[i].flow = field.samples()[i];
  }
}

int FlowEstimate::measured() const {
  return static_cast<int>(
      std::count_if(cell.begin(), cell.end(), [](const FlowCell& c) { return c.measured; }));
}

FlowField field_of(const FlowEstimate& estimate, Interpolation interpolation) {
  std::vector<FlowSample> samples;
  std::vector<bool> measured;
  for (const FlowCell& c : estimate.cell) {
    samples.push_back(c.flow);
    measured.push_back(c.measured);
  }
  return FlowField(estimate.cells, estimate.extent, std::move(samples), std::move(measured),
                   interpolation);
}

BallPhysics ball_physics(const Model& model) {
  BallPhysics ball;
  ball.mass = model.ball.mass, ball.radius = model.ball.radius;
  ball.drag_area = model.ball.drag_area, ball.rho = model.flow.rho;
  ball.tank_radius = model.tank.radius;
  ball.damping = 0;
  for (const ActiveForce& force : model.forces) {
    const auto parameters = force.term->parameters();
    if (force.term->name() == "ball_drag") {
      if (force.p[0] != parameters[0].standard) ball.drag_coefficient = force.p[0];
      ball.draws = force.p[1];
    }
    if (force.term->name() == "damping") ball.damping = -std::log(1 - force.p[0]);
  }
  return ball;
}

BallPhysics ball_physics(const Scenario& scenario) {
  BallPhysics ball = ball_physics(scenario.model);
  const auto& entries = scenario.entries;
  const bool set = std::any_of(entries.begin(), entries.end(), [](const ScenarioEntry& entry) {
    return entry.path == "forces.ball_drag.C" && !entry.is_default;
  });
  for (const ActiveForce& force : scenario.model.forces) {
    if (set && force.term->name() == "ball_drag") ball.drag_coefficient = force.p[0];
  }
  return ball;
}

}  // namespace lilytank
