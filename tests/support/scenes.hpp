// Worlds that the determinism tests, and whoever wants the same ones, share.
#pragma once
#include <string>

#include "support/worlds.hpp"

namespace lilytank::test {

/// 15 Lilies of the paper building chains of five, by the given clock.
inline Model chain_scene(Clock clock) {
  Model model = standard_model();
  model.rulesets = {read_ruleset(LILYTANK_SOURCE_DIR "/scenarios/rulesets/chain5.rules")};
  for (Rule& rule : model.rulesets[0].rules) {
    if (rule.kind == RuleKind::unlink && rule.p > 0) rule.p = 0.1;
  }
  model.control.clock = clock;
  return model;
}

/// 24 balls and 10 modules without latches, at half the step.
inline Model mixed_scene() {
  Model model = with_step(standard_model(), 2);
  model.module.count = 10, model.ball.count = 24;
  model.start.radius = 0.25;
  model.control.latches = false;
  return model;
}

/// Modules packed so that many touch at all times.
inline Model packed_scene() {
  Model model = standard_model();
  model.module.count = 120;
  model.start = {Layout::lattice, 0.255, 0.038};
  model.control.latches = false;
  return model;
}

/// 40 modules that build chains, in gusts drawn by their moments, and one gust a module.
inline Model drawn_scene(Gusts gusts, FlowAt at) {
  Model model = chain_scene(Clock::firmware);
  model.module.count = 40;
  model.start.radius = 0.25;
  model.flow.gusts = gusts, model.flow.at = at;
  return model;
}

/// The same in eddies and local streams.
inline Model stirred_scene() {
  Model model = drawn_scene(Gusts::per_point, FlowAt::points);
  for (const char* name : {"correlated_gusts", "local_flow", "wall_layer"}) {
    ActiveForce force = with_defaults(*find_force(name));
    force.p[0] = 0.05;
    model.forces.push_back(force);
  }
  return model;
}

}  // namespace lilytank::test
