// What a calibration simulates with.
#include "calibrate/setup.hpp"

#include <gtest/gtest.h>

namespace lilytank {
namespace {

// Gusts drawn from moments are 1 % off in the variance of short displacements: enough for the
// search, too much for estimates.
TEST(CalibrationSetup, wholeExperimentsHaveTheirGustsPointByPoint) {
  Experiment experiment;
  experiment.base = load_scenario({LILYTANK_SOURCE_DIR "/scenarios/tank_lilies.toml"}, {});
  RecordingShape shape;
  shape.bodies = 2, shape.frames = 150, shape.name = "lily";
  const Emulator tank(experiment.base.model, {}, {shape});
  const auto made = tank.record({}, 1);
  ASSERT_TRUE(made);
  experiment.recordings = *made;
  CalibrationOptions options;
  options.flow = CalibrationFlow::scenario;
  const CalibrationSetup setup = set_up(experiment, options);
  using Of = CalibrationSetup::Of;
  EXPECT_EQ(setup.emulator(setup.shapes, Of::experiments).model().flow.gusts, Gusts::per_point);
  EXPECT_EQ(setup.emulator(setup.shapes, Of::pieces).model().flow.gusts, Gusts::moment_matched);
  // A scenario that asks for other gusts has them everywhere.
  CalibrationSetup other = setup;
  other.model.flow.gusts = Gusts::per_module;
  EXPECT_EQ(other.emulator(other.shapes, Of::pieces).model().flow.gusts, Gusts::per_module);
}

// The flow is the balls': of recordings that are kept for testing, it must know nothing.
TEST(CalibrationSetup, ballsThatAreHeldOutTellNothingOfTheFlow) {
  Experiment experiment;
  experiment.base = load_scenario({LILYTANK_SOURCE_DIR "/scenarios/tank_balls.toml"}, {});
  RecordingShape shape;
  shape.body = BodyKind::ball, shape.bodies = 2, shape.frames = 150, shape.name = "ball";
  const auto made = Emulator(experiment.base.model, {}, {shape, shape}).record({}, 1);
  ASSERT_TRUE(made);
  experiment.recordings = *made;
  CalibrationOptions options;
  options.body = BodyKind::ball, options.flow = CalibrationFlow::scenario, options.hold_out = 1;
  const CalibrationSetup counted = set_up(experiment, options);
  options.hold_out = 0, experiment.recordings[1].held_out = true;
  const CalibrationSetup marked = set_up(experiment, options);
  EXPECT_EQ(marked.balls.size(), 1u);
  EXPECT_EQ(counted.balls.size(), 1u);
}

}  // namespace
}  // namespace lilytank
