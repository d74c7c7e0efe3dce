// Recordings of balls in a flow that is known because it was simulated.
#pragma once
#include <memory>
#include <vector>

#include "lilytank/camera.hpp"
#include "lilytank/flow_estimate.hpp"
#include "lilytank/random.hpp"
#include "lilytank/world.hpp"

namespace lilytank::test {

struct FlowTank {
  int balls = 24, recordings = 3;
  double duration = 120;           // s
  double rate = 30;                // frames per second
  double noise = 0.0003;           // m
  double random_force = 12.68e-3;  // N
  double gusts = 1;                // factor on the built-in tank's
  double pump_power = 69;          // percent
  std::uint64_t seed = 1;

  FlowField field() const {
    AnalyticTank tank;
    tank.pump_power = pump_power;
    const FlowField built_in = analytic_tank(tank, Interpolation::bilinear);
    std::vector<FlowSample> samples = built_in.samples();
    for (FlowSample& s : samples) s.sigma_x *= gusts, s.sigma_y *= gusts;
    std::vector<bool> measured(samples.size(), true);
    return FlowField(built_in.cells(), built_in.extent(), std::move(samples), std::move(measured),
                     Interpolation::bilinear);
  }
  FlowTruth truth() const {
    FlowTruth out{field().cells(), field().samples()};
    for (std::size_t i = 0; i < out.sample.size(); ++i) {
      // Nobody can say what lies outside the tank.
      const double x = (static_cast<double>(i % 50) + 0.5) * 0.012 - 0.3;
      const double y = (static_cast<double>(i / 50) + 0.5) * 0.012 - 0.3;
      if (x * x + y * y > 0.09) out.sample[i].mu_x = std::nan("");
    }
    return out;
  }
  Model model() const {
    Model m = standard_model();
    m.steps_per_tick = 2, m.dt = kTick / 2;
    m.module.count = 0, m.ball.count = balls;
    m.flow.K_v = 1;
    m.field = std::make_shared<const FlowField>(field());
    m.start.radius = 0.25, m.start.distance = 0.032;
    ActiveForce drag = with_defaults(*find_force("ball_drag"));
    drag.p[0] = 0.47;
    m.forces = {drag, with_defaults(*find_force("damping"))};
    if (random_force > 0) {
      m.forces.push_back(with_defaults(*find_force("stochastic")));
      m.forces.back().p[0] = random_force;
    }
    return m;
  }
  std::vector<Recording> record() const {
    const Model m = model();
    std::vector<Recording> out;
    for (int r = 0; r < recordings; ++r) {
      World world(m, derived_seed(seed, static_cast<std::uint64_t>(r)));
      while (world.time() < 5) world.step();
      Trajectory trajectory;
      append_poses(world, trajectory);
      while (world.time() < 5 + duration) {
        world.step();
        append_poses(world, trajectory);
      }
      Camera camera;
      camera.rate = rate, camera.position_noise = noise;
      camera.seed = derived_seed(seed, 100 + static_cast<std::uint64_t>(r));
      out.push_back(film(trajectory, camera, BodyKind::ball));
    }
    return out;
  }
};

}  // namespace lilytank::test
