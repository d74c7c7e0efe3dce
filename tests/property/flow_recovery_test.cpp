// Flows found again in recordings that were simulated in them.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <filesystem>
#include <limits>
#include <ostream>
#include <vector>

#include "lilytank/experiment.hpp"
#include "lilytank/flow_report.hpp"
#include "support/flow_tank.hpp"

namespace lilytank {
namespace {

struct Found {
  FlowEstimate paper, smooth;
  FlowError paper_error, smooth_error;
};

Found find(const test::FlowTank& tank) {
  const std::vector<Recording> recordings = tank.record();
  Found f{estimate_paper(recordings, BallPhysics()),
          estimate_smooth(recordings, BallPhysics()),
          {},
          {}};
  f.paper_error = compare_flow(f.paper, tank.truth(), true);
  f.smooth_error = compare_flow(f.smooth, tank.truth(), true);
  return f;
}

// Six minutes of 24 balls. Kicks of q = 0.025 m^2/s^3 over T = 4.4 s a cell leave an error of
// sqrt(q / T) = 0.075 m/s^2 in a cell's mean acceleration, 0.025 m/s in its flow; smoothness over
// ten cells brings it to about 0.008.
TEST(flowRecovery, theSmoothEstimateIsCloserThanThePapers) {
  const Found f = find({});
  EXPECT_LT(f.smooth_error.mean_rms, 0.013);
  EXPECT_LT(f.smooth_error.mean_rms, 0.5 * f.paper_error.mean_rms);
  EXPECT_LT(std::fabs(f.smooth_error.mean_radial), 0.006);
  EXPECT_LT(std::fabs(f.smooth_error.mean_around), 0.006);
  EXPECT_LT(f.smooth_error.deviation_rms, 0.035);
  EXPECT_LT(f.smooth_error.deviation_rms, f.paper_error.deviation_rms);
  // Standard errors cover what they should; those of neighbouring cells go together, so that the
  // share itself is uncertain by some percent.
  EXPECT_GT(f.smooth_error.mean_coverage, 0.90);
  EXPECT_GT(f.smooth_error.deviation_coverage, 0.75);
  ASSERT_TRUE(f.smooth.noise);
  const NoiseBudget& n = *f.smooth.noise;
  EXPECT_NEAR(n.tracking, 0.0003, 0.00005);
  // Frames beat with the 25 ms for which forces are held: up to 3 %.
  EXPECT_NEAR(n.stochastic, 12.68e-3, 0.04 * 12.68e-3);
  EXPECT_NEAR(n.gusts, 0.182, 4 * n.gusts_error);
}

// The mean flow is drawn with the variance that a cell's standard error says: of 200 draws a
// variance is known to 10 %, its average over cells, few of which go together, to less.
TEST(flowRecovery, drawsScatterLikeTheStandardErrors) {
  test::FlowTank tank;
  tank.duration = 40;
  const FlowEstimate f = estimate_smooth(tank.record(), BallPhysics(), {.draws = 200});
  ASSERT_EQ(f.draws.size(), 200u);
  double drawn = 0, told = 0, gusts_drawn = 0, gusts_told = 0;
  for (std::size_t i = 0; i < f.cell.size(); ++i) {
    const FlowCell& cell = f.cell[i];
    if (!cell.measured) continue;
    told += cell.error.mu_x * cell.error.mu_x;
    gusts_told += cell.error.sigma_x * cell.error.sigma_x;
    for (const FlowDifference& d : f.draws) {
      drawn += d[i].mu_x * d[i].mu_x / 200, gusts_drawn += d[i].sigma_x * d[i].sigma_x / 200;
    }
  }
  EXPECT_NEAR(drawn / told, 1, 0.1);
  // Draws of the deviation are by factors, the standard error is to first order.
  EXPECT_NEAR(gusts_drawn / gusts_told, 1, 0.35);
}

// A component scatters among draws by its own standard deviation, and two do not go together: of
// 400 draws a variance is known to 7 %, a correlation to 5 %.
TEST(flowRecovery, componentsAreThoseOfThePosterior) {
  constexpr int kDraws = 400, kComponents = 24;
  test::FlowTank tank;
  tank.duration = 40;
  const FlowEstimate f =
      estimate_smooth(tank.record(), BallPhysics(), {.draws = kDraws, .components = kComponents});
  ASSERT_EQ(f.components.size(), static_cast<std::size_t>(kComponents));
  // Values within the region where the components are orthogonal.
  const auto values = [&](const FlowDifference& of) {
    std::vector<double> out;
    for (int i = 0; i < static_cast<int>(of.size()); ++i) {
      if (std::hypot(f.x(i), f.y(i)) > 0.96 * BallPhysics().tank_radius) continue;
      const FlowSample& s = of[static_cast<std::size_t>(i)];
      out.insert(out.end(), {s.mu_x, s.mu_y});
    }
    return Eigen::Map<const Eigen::VectorXd>(out.data(), static_cast<Eigen::Index>(out.size()))
        .eval();
  };
  Eigen::MatrixXd amplitudes(kDraws, kComponents);
  double before = std::numeric_limits<double>::infinity(), held = 0;
  for (int k = 0; k < kComponents; ++k) {
    const Eigen::VectorXd own = values(f.components[static_cast<std::size_t>(k)]);
    const double variance = own.squaredNorm();
    EXPECT_LE(variance, before * (1 + 1e-9));
    before = variance, held += variance;
    for (int d = 0; d < kDraws; ++d) {
      amplitudes(d, k) = own.dot(values(f.draws[static_cast<std::size_t>(d)])) / variance;
    }
  }
  const Eigen::MatrixXd among = amplitudes.transpose() * amplitudes / kDraws;
  for (int k = 0; k < kComponents; ++k) {
    EXPECT_NEAR(among(k, k), 1, 4 * std::sqrt(2.0 / kDraws)) << k;
    for (int j = 0; j < k; ++j) {
      EXPECT_NEAR(among(j, k), 0, 4.5 / std::sqrt(kDraws)) << j << " " << k;
    }
  }
  // Those of few draws seem to hold more than the posterior's own, which hold the most.
  Eigen::MatrixXd drawn(values(f.draws[0]).size(), kDraws);
  for (int d = 0; d < kDraws; ++d) drawn.col(d) = values(f.draws[static_cast<std::size_t>(d)]);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(drawn.transpose() * drawn / kDraws);
  const double seeming = solved.eigenvalues().tail(kComponents).sum();
  EXPECT_LT(held, 1.02 * seeming);
  EXPECT_GT(held, 0.7 * seeming);
}

TEST(flowRecovery, errorsFallWithMoreData) {
  test::FlowTank little, much;
  little.duration = 40, much.duration = 240;
  const Found a = find(little), b = find(much);
  // Six times the data; smoothing gives some of sqrt(6) away.
  EXPECT_LT(b.smooth_error.mean_rms, 0.75 * a.smooth_error.mean_rms);
  EXPECT_GT(b.smooth_error.mean_coverage, 0.90);
  EXPECT_GT(a.smooth_error.mean_coverage, 0.85);
}

struct Case {
  const char* name;
  test::FlowTank tank;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}
class Circumstances : public testing::TestWithParam<Case> {};

TEST_P(Circumstances, theSmoothEstimateHolds) {
  const Found f = find(GetParam().tank);
  EXPECT_LT(f.smooth_error.mean_rms, 0.02);
  EXPECT_LT(f.smooth_error.mean_rms, f.paper_error.mean_rms);
  EXPECT_GT(f.smooth_error.mean_coverage, 0.85);
  // The simulator's own steps, between which the camera goes straight, look like 0.1 mm of noise.
  const double noise = GetParam().tank.noise, found = f.smooth.noise->tracking;
  EXPECT_NEAR(found * found, noise * noise, 1e-8 + 0.05 * noise * noise);
}

test::FlowTank with(double noise, double force, double gusts, double rate, double power) {
  test::FlowTank t;
  t.noise = noise, t.random_force = force, t.gusts = gusts, t.rate = rate, t.pump_power = power;
  return t;
}
INSTANTIATE_TEST_SUITE_P(flowRecovery, Circumstances,
                         testing::Values(Case{"noisy", with(1e-3, 12.68e-3, 1, 30, 69)},
                                         Case{"noiseless", with(0, 12.68e-3, 1, 30, 69)},
                                         Case{"calm", with(3e-4, 4e-3, 1, 30, 69)},
                                         Case{"still_gusts", with(3e-4, 12.68e-3, 0.3, 30, 69)},
                                         Case{"fast_camera", with(3e-4, 12.68e-3, 1, 60, 69)},
                                         Case{"slow_camera", with(3e-4, 12.68e-3, 1, 20, 69)},
                                         Case{"strong_pumps", with(3e-4, 12.68e-3, 1, 30, 90)}),
                         [](const auto& info) { return info.param.name; });

TEST(flowRecovery, samplesThatCountAsIndependentAre) {
  // In still water without gusts a ball's motion is that of its own random force: normal samples.
  // The share of cells rejected at 5 % is then 5 %; 1500 cells that are not quite independent.
  test::FlowTank tank;
  tank.pump_power = 0.001, tank.duration = 200;
  FlowOptions options;
  const FlowEstimate e = estimate_paper(tank.record(), BallPhysics(), options);
  int tested = 0, rejected = 0;
  for (const FlowCell& c : e.cell) {
    if (c.normal_x.samples < 10) continue;
    tested += 2;
    rejected += (c.normal_x.p < 0.05 ? 1 : 0) + (c.normal_y.p < 0.05 ? 1 : 0);
  }
  ASSERT_GT(tested, 1000);
  EXPECT_GT(static_cast<double>(rejected) / tested, 0.02);
  EXPECT_LT(static_cast<double>(rejected) / tested, 0.12);
}

TEST(flowRecovery, biasesOfEq3AreMeasured) {
  test::FlowTank tank;
  tank.recordings = 1, tank.duration = 60;
  const std::vector<Recording> recordings = tank.record();
  const FlowEstimate smooth = estimate_smooth(recordings, BallPhysics());
  const auto rows = measure_flow_bias(recordings, smooth, BallPhysics(), {}, 1);
  ASSERT_GE(rows.size(), 10u);
  const auto row = [&](const std::string& what, const std::string& who) {
    for (const FlowBiasRow& r : rows) {
      if (r.what == what && r.estimator == who) return r.error;
    }
    ADD_FAILURE() << what;
    return FlowError{};
  };
  // More random force, more of what Eq. 3 takes for the water's deviation.
  EXPECT_GT(row("random force x 2", "paper").deviation_bias,
            row("as recorded", "paper").deviation_bias + 0.02);
  EXPECT_LT(row("as recorded", "smooth").mean_rms, row("as recorded", "paper").mean_rms);
  EXPECT_LT(row("window of 1.2 s", "paper").deviation_bias,
            row("window of 0.17 s", "paper").deviation_bias);
}

// Recordings made by another program, with its key.
TEST(flowRecovery, practiceRecordings) {
  const std::string folder = LILYTANK_SOURCE_DIR "/../shared/recordings/practice/tank";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no practice recordings beside the tree";
  const Experiment experiment = load_experiment(
      {folder + "/experiment.toml"}, {},
      [](const RecordingSource& source) { return source.options.body == BodyKind::ball; });
  const BallPhysics ball = ball_physics(experiment.base.model);
  const FlowTruth truth = read_flow_truth(folder + "/true_flow.csv", 50);
  const FlowError paper = compare_flow(estimate_paper(experiment.recordings, ball), truth, true);
  const FlowError smooth = compare_flow(estimate_smooth(experiment.recordings, ball), truth, true);
  EXPECT_LT(smooth.mean_rms, 0.5 * paper.mean_rms);
  EXPECT_LT(smooth.mean_rms, 0.013);
  EXPECT_LT(smooth.deviation_rms, paper.deviation_rms);
  EXPECT_GT(smooth.mean_coverage, 0.9);
}

}  // namespace
}  // namespace lilytank
