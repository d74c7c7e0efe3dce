// What numbers leave open is chosen by displacements; what they tell stays as they tell it.
#include <gtest/gtest.h>

#include <cmath>

#include "calibrate/stages.hpp"

namespace lilytank {
namespace {

// Recordings of known K_v and D_linear, and what a calibration sets up for them.
struct Known {
  std::vector<double> truth{1.2, 0.3};
  CalibrationSetup setup;

  Known() {
    Experiment experiment;
    experiment.base = load_scenario({LILYTANK_SOURCE_DIR "/scenarios/tank_lilies.toml"}, {});
    std::vector<std::string> paths{"flow.K_v", "forces.damping.D_linear"};
    RecordingShape shape;
    shape.bodies = 10, shape.frames = 901, shape.rate = 15, shape.name = "lily";
    const Emulator tank(experiment.base.model, paths, {shape, shape});
    experiment.recordings = *tank.record(truth, 1);
    CalibrationOptions options;
    options.parameters = {{paths[0], "1", 0.4, 2.5, true}, {paths[1], "1", 0, 0.8}};
    options.flow = CalibrationFlow::scenario, options.round = 40;
    setup = set_up(experiment, options);
  }

  // `off` and `known`: of K_v, on its log scale. D_linear is known, and the camera's noise.
  double chosen(double off, double known) {
    Stages stages(setup);
    std::vector<double> values = setup.start;
    values[0] = truth[0] * std::exp(off), values[1] = truth[1];
    const Eigen::VectorXd middle = stages.to_scale(values);
    Eigen::VectorXd deviation = Eigen::VectorXd::Constant(middle.size(), 0.01);
    deviation(0) = known;
    const Eigen::MatrixXd covariance = deviation.cwiseAbs2().asDiagonal();
    const NearestPoint found = nearest_displacements(stages, middle, covariance, middle);
    EXPECT_TRUE(found.settled);
    return found.point(0) - std::log(truth[0]);
  }
};

TEST(NearestDisplacements, findTheWaterThatMovesModulesAlike) {
  Known tank;
  // A third too fast, by numbers that know it to a third: the MSD, whose waves tell how fast
  // modules go round, knows it to a few percent.
  EXPECT_LT(std::fabs(tank.chosen(0.3, 0.3)), 0.1);
}

TEST(NearestDisplacements, leaveWhatIsKnown) {
  Known tank;
  EXPECT_NEAR(tank.chosen(0.04, 0.002), 0.04, 0.01);
}

}  // namespace
}  // namespace lilytank
