// How often a bond is evaluated. The paper's reverse probabilities are per evaluation, so their
// meaning in seconds hangs on this rate.
#include <gtest/gtest.h>

#include "support/control_rig.hpp"

using namespace lilytank;
using lilytank::test::quiet_model;
using lilytank::test::Rig;
using lilytank::test::rules_of;

namespace {

struct Measured {
  double rate = 0;       // evaluations per bond and second
  double deviation = 0;  // of the rate, for Poisson counts
};

/// A row of modules, or module 0 with the others around it, held by bonds that no rule concerns.
Measured evaluations(int modules, bool row, Clock clock, int ticks) {
  Model model = quiet_model(modules, {rules_of("(99,1) (98,1) -> (99,1)-(98,1)\n")});
  model.control.clock = clock;
  Rig rig(std::move(model), 11);
  rig.place(0, 0, 0);
  for (int i = 1; i < modules; ++i) {
    const Connector a{row ? i - 1 : 0, row ? 0 : i - 1}, b{i, 2};
    rig.place_at(i, b.face, a.module, a.face);
    hold(rig.state, a, b);
    face_of(rig.state, a).status = face_of(rig.state, b).status = FaceStatus::bonded;
    merge(rig.model, rig.state, rig.bodies, a.module, a.face, b.module, b.face);
  }
  rig.run(ticks);
  EXPECT_TRUE(rig.log.empty());
  const double time = ticks * kTick * (modules - 1);
  const double count = static_cast<double>(rig.tallies.evaluations);
  return {count / time, std::sqrt(count) / time};
}

// An independent program of the authors' message machine gave 0.66, 0.67 and 0.70 per second and
// bond: two digits, so half a unit of the second digit is added to three deviations.
void expect_rate(int modules, bool row, double authors) {
  const Measured m = evaluations(modules, row, Clock::firmware, 1000000);
  EXPECT_NEAR(m.rate, authors, 0.005 + 3 * m.deviation);
  ::testing::Test::RecordProperty("rate", std::to_string(m.rate));
}

TEST(EvaluationRate, FirmwareDimer) {
  expect_rate(2, true, 0.66);
}
TEST(EvaluationRate, FirmwareTrimer) {
  expect_rate(3, true, 0.67);
}
TEST(EvaluationRate, FirmwareCross) {
  expect_rate(5, false, 0.70);
}

TEST(EvaluationRate, EventClockHasTheRateThatIsSet) {
  for (const int modules : {2, 5}) {
    const Measured m = evaluations(modules, modules == 2, Clock::events, 1000000);
    EXPECT_NEAR(m.rate, 0.68, 3 * m.deviation) << modules;
  }
}

// Waiting times of the event-driven clock have no memory: the gaps' deviation equals their mean.
TEST(EvaluationRate, EventClockIsPoisson) {
  Model model =
      quiet_model(2, {rules_of("(99,1) (98,1) -> (99,1)-(98,1)\n(0,0) (0,0) -> (1,1)-(2,1)\n")});
  model.control.clock = Clock::events;
  Rig rig(std::move(model), 4);
  rig.place(0, 0, 0);
  rig.place_at(1, 2, 0, 0);
  double n = 0, sum = 0, squares = 0, last = 0;
  for (int t = 0; t < 1000000; ++t) {
    const auto before = rig.tallies.evaluations;
    rig.tick();
    if (rig.tallies.evaluations == before) continue;
    const double gap = t - last;
    last = t;
    if (n++ > 0) sum += gap, squares += gap * gap;
  }
  const double mean = sum / (n - 1), variance = squares / (n - 1) - mean * mean;
  const double expected = 1 / (0.68 * kTick);
  EXPECT_NEAR(mean, expected, 3 * expected / std::sqrt(n));
  // Geometric: variance mean^2 - mean; kurtosis 9 makes its relative error sqrt(8/n).
  EXPECT_NEAR(variance / (expected * expected - expected), 1, 3 * std::sqrt(8 / n));
}

// A reverse probability p undoes a dimer after 1 / (p * rate) on average.
TEST(EvaluationRate, LifeOfADimerFollowsFromItsReverseProbability) {
  const double p = 0.4796;  // the paper's optimised p_1
  double total = 0;
  const int runs = 1500;
  for (int seed = 1; seed <= runs; ++seed) {
    Model model = quiet_model(
        2, {rules_of("(0,0) (0,0) -> (1,1)-(2,1)\n(1,1)-(2,1) -> (0,0) (0,0) p=0.4796\n")});
    Rig rig(std::move(model), static_cast<std::uint64_t>(seed));
    rig.place(0, 0, 0);
    rig.place_at(1, 2, 0, 0);
    ASSERT_TRUE(rig.until(EventKind::link));
    const auto linked = rig.state.step;
    ASSERT_TRUE(rig.until(EventKind::unlink));
    total += static_cast<double>(rig.state.step - linked) * kTick;
  }
  const double expected = 1 / (p * 0.656);
  EXPECT_NEAR(total / runs, expected, 3 * expected / std::sqrt(runs) + 0.02 * expected);
}

}  // namespace
