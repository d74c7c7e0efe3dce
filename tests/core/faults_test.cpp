// Messages that are lost and latches that fail.
#include <gtest/gtest.h>

#include <cmath>

#include "support/control_rig.hpp"

using namespace lilytank;
using lilytank::test::chain;
using lilytank::test::hasty;
using lilytank::test::quiet_model;
using lilytank::test::Rig;
using lilytank::test::rules_of;

namespace {

// Two modules that hold each other and never decide anything for good.
Rig idle_pair(double message_loss, Clock clock) {
  Model model = quiet_model(2, {rules_of("r1: (0,0) (0,0) -> (1,1)-(2,1) p=0\n")});
  model.control.clock = clock;
  model.control.message_loss = message_loss;
  return Rig(std::move(model), 5);
}

TEST(Faults, LostMessagesMakeEvaluationsRarer) {
  for (const Clock clock : {Clock::firmware, Clock::events}) {
    double evaluations[2];
    for (const bool lossy : {false, true}) {
      Rig rig = idle_pair(lossy ? 0.6 : 0, clock);
      rig.place(0, 0, 0);
      rig.place_at(1, 2, 0, 0);
      rig.run(100000);
      EXPECT_EQ(rig.face(0, 0).status, FaceStatus::latched);
      evaluations[lossy] = static_cast<double>(rig.tallies.evaluations);
    }
    // Both counts vary no more than Poisson's; a machine that lost a message waits no longer than
    // one that was answered by more than a few ticks, so the firmware's share is not 0.4 sharp.
    const double share = evaluations[1] / evaluations[0];
    const double deviation = share * std::sqrt(1 / evaluations[0] + 1 / evaluations[1]);
    EXPECT_NEAR(share, 0.4, 4 * deviation + (clock == Clock::firmware ? 0.1 : 0));
  }
}

TEST(Faults, AnAnswerThatIsLostLeavesTheInitiatorWithItsOldLabels) {
  Model model = hasty(2, {chain()});
  model.control.answer_loss = 1;
  Rig rig(std::move(model), 1);
  rig.place(0, 0, 0);
  rig.place_at(1, 2, 0, 0);
  ASSERT_TRUE(rig.until(EventKind::link));
  const int labels[2] = {rig.state.firmware[0].label, rig.state.firmware[1].label};
  EXPECT_EQ(std::min(labels[0], labels[1]), 0);
  EXPECT_EQ(std::max(labels[0], labels[1]), 2);  // the rule's second side is the responder's
  EXPECT_EQ(rig.face(0, 0).status, FaceStatus::bonded);
}

TEST(Faults, ALatchThatFailsStaysOffUntilTheFacesPart) {
  Model model = hasty(2, {chain()});
  model.control.latch_failure = 1;
  Rig rig(std::move(model), 1);
  rig.place(0, 0, 0);
  rig.place_at(1, 2, 0, 0);
  rig.run(4000);
  EXPECT_EQ(rig.count(EventKind::latch), 0);
  EXPECT_EQ(rig.face(0, 0).status, FaceStatus::off);
  rig.place(1, 1, 1);
  rig.run(2000);  // far beyond the mean of 20 ticks
  EXPECT_EQ(rig.face(0, 0).status, FaceStatus::enabled);
}

TEST(Faults, ALatchThatHoldsOnIsDecidedAgainAndAgain) {
  Model model = hasty(2, {rules_of("r1: (1,1) (1,1) -> (1,1)-(2,1) p=1\n")});
  model.control.release_failure = 0.9;
  Rig rig(std::move(model), 1);
  int ticks = 0, runs = 300;
  for (int k = 0; k < runs; ++k) {
    rig.place(0, 0, 0);
    rig.place_at(1, 2, 0, 0);
    ASSERT_TRUE(rig.until(EventKind::latch));
    const std::int64_t begin = rig.state.step;
    ASSERT_TRUE(rig.until(EventKind::unlatch));
    ticks += static_cast<int>(rig.state.step - begin);
    rig.place(1, 1, 1);
    rig.run(2000);
  }
  // One evaluation a tick, of which a tenth lets go: a geometric waiting time.
  EXPECT_NEAR(ticks / static_cast<double>(runs), 10, 4 * std::sqrt(90.0 / runs));
}

}  // namespace
