// Amplitudes of pushes in innovations, against the recursion done one by one in double precision.
#include "filter/sensitivity.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <array>
#include <cmath>

#include "lilytank/random.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kFeatures = 4;  // of which the last is a nuisance
constexpr int kFrames = 3000;
constexpr double kInterval = 1.0 / 30, kLoss = 1.5, kGainX = 0.3, kGainV = 2, kDeviation = 4e-4;

// Accelerations of one module along x, m/s^2: two that have little to do with each other, one that
// is never there, and a nuisance that looks much like the first.
std::array<double, kFeatures> pushes_at(int frame) {
  const auto noise = [&](std::uint32_t of) {
    return normal_pair({7, Stream::calibrate, frame / 10, of, 0})[0];
  };
  const double a = noise(0), b = noise(1);
  return {a, b, 0, 0.8 * a + 0.6 * noise(2)};
}

// What the features would have done to the place that is seen next, frame by frame.
std::vector<std::array<double, kFeatures>> places() {
  std::vector<std::array<double, kFeatures>> out;
  std::array<double, kFeatures> x{}, v{};
  for (int frame = 0; frame < kFrames; ++frame) {
    const auto push = pushes_at(frame);
    std::array<double, kFeatures> now{};
    for (std::size_t f = 0; f < kFeatures; ++f) {
      now[f] = x[f] + kInterval * (v[f] + 0.5 * kInterval * push[f]);
      const double speed = (1 - kLoss * kInterval) * v[f] + kInterval * push[f];
      x[f] = now[f] - kGainX * now[f], v[f] = speed - kGainV * now[f];
    }
    out.push_back(now);
  }
  return out;
}

// Innovations in which there is so much of every feature, and noise.
Sensitivities seen(const std::array<double, kFeatures>& amplitudes, std::size_t partners,
                   double noise = 0) {
  Sensitivities out(kFeatures, 1, partners);
  const auto all = places();
  Pushes pushes(kFeatures);
  for (int frame = 0; frame < kFrames; ++frame) {
    const auto push = pushes_at(frame);
    double found = noise * kDeviation * normal_pair({8, Stream::calibrate, frame, 0, 0})[0];
    for (std::size_t f = 0; f < kFeatures; ++f) {
      pushes.x[f] = static_cast<float>(push[f]);
      found += amplitudes[f] * all[static_cast<std::size_t>(frame)][f];
    }
    const std::array<double, 1> dx{found}, none{0}, sd{kDeviation}, gain_x{kGainX}, gain_v{kGainV};
    PredictedFrame f;
    f.frame = frame, f.interval = kInterval;
    f.dx = dx, f.dy = none, f.dtheta = none, f.sd_x = sd, f.sd_theta = sd;
    f.gain_x = gain_x, f.gain_v = gain_v, f.gain_theta = gain_x, f.gain_omega = gain_v;
    out.pass(0, pushes, f, f.innovation(0), kLoss, true);
  }
  out.finish();
  return out;
}

const Eigen::MatrixXd kNoNuisance;
Eigen::MatrixXd known(double precision) {
  return Eigen::MatrixXd::Constant(1, 1, precision);
}

// Sums of products by the recursion in double precision.
double product(std::size_t a, std::size_t b) {
  double sum = 0;
  for (const auto& at : places()) sum += at[a] * at[b] / (kDeviation * kDeviation);
  return sum;
}

TEST(Sensitivities, TellWhatIsThereAlone) {
  const auto told = seen({2, 0, 0, 0}, 0).amplitudes(kNoNuisance);
  ASSERT_EQ(told.size(), kFeatures);
  EXPECT_NEAR(told[0].estimate, 2, 1e-3);
  EXPECT_NEAR(told[0].information, product(0, 0), 1e-3 * product(0, 0));
  EXPECT_NEAR(told[0].gain(), 4 * product(0, 0), 4e-3 * product(0, 0));
  EXPECT_NEAR(told[1].estimate, 2 * product(0, 1) / product(1, 1), 2e-3);
  EXPECT_EQ(told[2].estimate, 0);
}

// Products are summed in a frame every 0.3 s, so they are known to some per cent only.
TEST(Sensitivities, AreClearedOfNuisances) {
  const auto plain = seen({0, 0, 0, 3}, 1).amplitudes(kNoNuisance);
  EXPECT_GT(plain[0].estimate, 1.5);
  const auto cleared = seen({0, 0, 0, 3}, 1).amplitudes(known(1e-6));
  ASSERT_EQ(cleared.size(), kFeatures - 1);
  EXPECT_NEAR(cleared[0].estimate, 0, 0.15);
  const auto both = seen({2, 0, 0, 3}, 1).amplitudes(known(1e-6));
  EXPECT_NEAR(both[0].estimate, 2, 0.15);
  const double left = product(0, 0) - product(0, 3) * product(0, 3) / product(3, 3);
  EXPECT_NEAR(both[0].information, left, 0.1 * left);
  // A nuisance that is known not to be there takes nothing.
  const auto sure = seen({2, 0, 0, 0}, 1).amplitudes(known(1e12));
  EXPECT_NEAR(sure[0].estimate, 2, 1e-3);
}

// What is left of two features' common information tells how far one's estimate moves by the other.
TEST(Sensitivities, InformationsTellHowEstimatesMove) {
  const Eigen::MatrixXd left = seen({0, 0, 0, 0}, kFeatures).informations(known(1e-6));
  ASSERT_EQ(left.rows(), static_cast<Eigen::Index>(kFeatures) - 1);
  const auto moved = seen({0, 5, 0, 0}, 1).amplitudes(known(1e-6));
  EXPECT_NEAR(moved[0].estimate, 5 * left(0, 1) / left(0, 0), 0.2);
  EXPECT_EQ(left(2, 2), 0);
  EXPECT_EQ(left(0, 2), 0);
}

// Of noise alone estimates are within four deviations, which are one over the root of information.
TEST(Sensitivities, ScatterAsTheirInformationSays) {
  const auto told = seen({0, 0, 0, 0}, 1, 1).amplitudes(known(1));
  for (const std::size_t f : {0u, 1u}) {
    EXPECT_LT(std::fabs(told[f].estimate) * std::sqrt(told[f].information), 4);
    EXPECT_NE(told[f].estimate, 0);
  }
}

TEST(Sensitivities, AreTheSameByEveryInstructionSet) {
  std::vector<double> first;
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1) {
    hwy::SetSupportedTargetsForTest(left & -left);
    hwy::GetChosenTarget().DeInit();
    std::vector<double> told;
    for (const auto& one : seen({2, 1, 0, 3}, 1, 1).amplitudes(known(1))) {
      told.push_back(one.estimate), told.push_back(one.information);
    }
    if (first.empty()) first = told;
    EXPECT_EQ(told, first);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
  EXPECT_FALSE(first.empty());
}

}  // namespace
}  // namespace lilytank
