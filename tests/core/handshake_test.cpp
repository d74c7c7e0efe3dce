// The confirmed handshake: what two modules agree on while messages are lost.
#include <gtest/gtest.h>

#include <cmath>

#include "support/control_rig.hpp"

using namespace lilytank;
using lilytank::test::chain;
using lilytank::test::hasty;
using lilytank::test::quiet_model;
using lilytank::test::Rig;
using lilytank::test::rules_of;
using lilytank::test::with_p;

namespace {

Model lossy(Model model, double message_loss, double answer_loss) {
  model.control.handshake = Handshake::confirmed;
  model.control.message_loss = message_loss;
  model.control.answer_loss = answer_loss;
  return model;
}

void meet(Rig& rig) {
  rig.place(0, 0, 0);
  rig.place_at(1, 2, 0, 0);
}

bool all_free(const Rig& rig) {
  for (const Firmware& firmware : rig.state.firmware)
    if (firmware.bound != 0) return false;
  return true;
}

TEST(Handshake, WithoutLossItDecidesInTheSameTickAsThePlainOne) {
  for (const Clock clock : {Clock::firmware, Clock::events}) {
    std::int64_t step[2];
    for (const bool confirmed : {false, true}) {
      Model model = quiet_model(2, {chain()});
      model.control.clock = clock;
      model.control.handshake = confirmed ? Handshake::confirmed : Handshake::plain;
      Rig rig(std::move(model), 3);
      meet(rig);
      ASSERT_TRUE(rig.until(EventKind::link));
      step[confirmed] = rig.state.step;
      EXPECT_TRUE(all_free(rig));
    }
    EXPECT_EQ(step[0], step[1]);
  }
}

TEST(Handshake, ALostAnswerDelaysTheDecisionAndBothSidesAgree) {
  for (const Clock clock : {Clock::firmware, Clock::events}) {
    double ticks[2];
    for (const bool lost : {false, true}) {
      Model model = lossy(quiet_model(2, {chain()}), 0, lost ? 0.9 : 0);
      model.control.clock = clock;
      ticks[lost] = 0;
      for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        Rig rig(model, seed);
        meet(rig);
        ASSERT_TRUE(rig.until(EventKind::link));
        ticks[lost] += static_cast<double>(rig.state.step) / 100;
        EXPECT_GT(rig.state.firmware[0].label, 0);
        EXPECT_GT(rig.state.firmware[1].label, 0);
        EXPECT_EQ(rig.state.firmware[0].label + rig.state.firmware[1].label, 3);
      }
    }
    // Nine in ten answers are lost: 9 repetitions in the mean, every fourth tick; deviation 3.8
    // ticks.
    EXPECT_NEAR(ticks[true] - ticks[false], 36, 15) << static_cast<int>(clock);
  }
}

TEST(Handshake, WhereNoAnswerArrivesNothingChanges) {
  Rig rig(lossy(hasty(2, {chain()}), 0, 1), 1);
  meet(rig);
  rig.run(2000);
  EXPECT_EQ(rig.count(EventKind::link), 0);
  EXPECT_EQ(rig.face(0, 0).status, FaceStatus::latched);
  EXPECT_EQ(rig.state.firmware[0].label, 0);
  EXPECT_EQ(rig.state.firmware[1].label, 0);
}

TEST(Handshake, ALatchThatParts_FreesBoth) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Rig rig(lossy(hasty(2, {rules_of("r1: (1,1) (1,1) -> (1,1)-(2,1) p=1\n")}), 0.7, 0.7), seed);
    meet(rig);
    ASSERT_TRUE(rig.until(EventKind::unlatch));
    rig.run(40);  // a bound initiator sees within four ticks that its neighbour has gone
    EXPECT_TRUE(all_free(rig)) << seed;
  }
}

TEST(Handshake, APausedInitiatorIsWaitedFor) {
  bool waited = false;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rig rig(lossy(hasty(2, {chain()}), 0, 0.9), seed);
    meet(rig);
    for (int k = 0; k < 400 && all_free(rig); ++k) rig.tick();
    const int responder = rig.state.firmware[0].bound != 0 ? 0 : 1;
    if (rig.count(EventKind::link) > 0) continue;  // the first answer came through
    rig.state.firmware[1 - responder].power = Power::paused;
    rig.run(1000);
    EXPECT_EQ(rig.count(EventKind::link), 0);
    rig.state.firmware[1 - responder].power = Power::on;
    EXPECT_TRUE(rig.until(EventKind::link));
    waited = true;
  }
  EXPECT_TRUE(waited);
}

// Four modules in a square, all bonds evaluated as often as they can be: circles of modules that
// wait for each other form, and are broken.
TEST(Handshake, NoCircleOfModulesWaitsForEver) {
  const Ruleset rules = with_p(rules_of("r1: (0,0) (0,0) -> (1,1)-(2,1) p=0\n"), RuleKind::link, 0);
  for (const Clock clock : {Clock::firmware, Clock::events}) {
    Model model = lossy(hasty(4, {rules}), 0.5, 0.8);
    model.control.clock = clock, model.control.initiative = 0.5;
    Rig rig(std::move(model), 7);
    meet(rig);
    rig.place_at(2, 3, 0, 1);
    rig.place_at(3, 3, 1, 1);
    for (int round = 0; round < 20; ++round) {
      const std::int64_t before = rig.tallies.evaluations;
      rig.run(1000);
      EXPECT_GT(rig.tallies.evaluations, before) << round;
    }
  }
}

}  // namespace
