// Which further experiment is proposed, and its file.
#include "finder/next_experiment.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "lilytank/experiment.hpp"
#include "scores/nuisances.hpp"
#include "support/filmed.hpp"
#include "support/recordings.hpp"
#include "support/uncertain_maps.hpp"

namespace lilytank {
namespace {

using test::drifting;
using test::filmed;
using test::plan_for;

constexpr int kModules = 6;

EffectHypothesis hypothesis(const ScorePlan& plan, const std::string& name) {
  for (const Effect& effect : plan.effects) {
    if (effect.name != name) continue;
    const auto count = static_cast<Eigen::Index>(effect.paths.size());
    return {effect, Eigen::VectorXd::Ones(count)};
  }
  throw std::logic_error("no effect " + name);
}

const ProposedExperiment& of_modules(const std::vector<ProposedExperiment>& all, int modules) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const ProposedExperiment& one) {
    return one.modules == modules && !one.alone();
  });
  if (found == all.end()) throw std::logic_error("not proposed: " + std::to_string(modules));
  return *found;
}

class NextExperiment : public testing::Test {
 protected:
  OpenQuestion between(const std::string& one, const std::string& other) const {
    return {{hypothesis(plan_, one), hypothesis(plan_, other)}, {}};
  }
  const std::vector<Recording> recordings_ = filmed(drifting(kModules), 60, 3);
  ScorePlan plan_ = plan_for(drifting(kModules), recordings_);
};

// Modules meet four times as often where there are twice as many, and never alone.
TEST_F(NextExperiment, ForcesBetweenModulesNeedMoreOfThem) {
  const auto all =
      propose_experiments({plan_, recordings_}, between("pair_attraction", "lubrication"), 1);
  EXPECT_EQ(all.front().modules, 2 * kModules);
  EXPECT_GT(all.front().relative, 1.5);
  EXPECT_TRUE(std::ranges::none_of(all, [](const auto& one) { return one.modules == 1; }));
  EXPECT_DOUBLE_EQ(of_modules(all, kModules).relative, 1);
  EXPECT_EQ(all.front().pair, "pair_attraction or lubrication");
  for (const ProposedExperiment& one : all) {
    EXPECT_TRUE(one.information >= kWantedInformation || one.minutes == 60) << one.text();
  }
}

// More balls show as much as the flow map leaves open; none are proposed where the flow is known.
TEST_F(NextExperiment, BallsHelpPoorFlowMaps) {
  const OpenQuestion question = between("body_force", "coriolis");
  const Model model = drifting(kModules);
  const auto by_balls = [&](double error) {
    const auto nuisances =
        std::make_shared<const Nuisances>(model, test::uncertain_maps(*model.field, error), 1);
    plan_.nuisances = nuisances;
    const RecordedSoFar so_far{plan_, recordings_, 24, 2,
                               nuisances->known_for(FlowMaps(model.field), 2)};
    const auto all = propose_experiments(so_far, question, 1);
    for (const ProposedExperiment& one : all) {
      EXPECT_TRUE(!one.alone() || one.ball_minutes > 0) << one.text();  // a flow of its own
      if (one.modules == 0) return one.information / one.ball_minutes;
    }
    return 0.0;
  };
  EXPECT_GT(by_balls(0.015), 10 * by_balls(3e-4));
  for (const auto& one : propose_experiments({plan_, recordings_}, question, 1)) {
    EXPECT_EQ(one.balls, 0);
  }
}

TEST_F(NextExperiment, SameSeedSameProposals) {
  const OpenQuestion question = between("spin_torque", "rotational_drag");
  const auto text_of = [&](std::uint64_t seed, int threads) {
    std::string out;
    for (const ProposedExperiment& one :
         propose_experiments({plan_, recordings_}, question, seed, threads)) {
      out += one.text() + " " + std::to_string(one.information) + "\n";
    }
    return out;
  };
  const std::string once = text_of(1, 1);
  EXPECT_EQ(text_of(1, 3), once);
  EXPECT_NE(text_of(2, 3), once);
  EXPECT_TRUE(propose_experiments({plan_, recordings_}, {{question.candidates[0]}, {}}, 1).empty());
}

// Every kind of proposal is a scenario, and an experiment once its recordings are there.
TEST(NextExperimentFile, IsAnOverlay) {
  ProposedExperiment lilies;
  lilies.modules = 1, lilies.minutes = 12, lilies.information = 9, lilies.pair = "a or b";
  ProposedExperiment balls;
  balls.balls = 3, balls.ball_minutes = 8;
  ProposedExperiment both = lilies;
  both.balls = 3, both.ball_minutes = 8, both.power = 0.7;
  const ProposedExperiment longer = to_meet({{Requirement::mean_flow, "", 3.2, BodyKind::ball, 3},
                                             {Requirement::gusts, "", 7.5, BodyKind::ball, 3},
                                             {Requirement::lily_time, "", 2, BodyKind::lily, 2}});
  EXPECT_EQ(longer.text(), "2 min of 2 Lilies and 8 min of 3 balls");
  EXPECT_EQ(both.text(), "12 min of 1 Lily and 8 min of 3 balls, pumps at 70 % of their power");
  const TemporaryDirectory here;
  write_recording(circling(2, 60), here.path("old.csv"));
  write_recording(circling(2, 60), here.path("next_lilies.csv"));
  write_recording(circling(3, 60, 30, false), here.path("next_balls.csv"));
  const std::string old =
      here.write("old.toml", "[[recording]]\nfile = \"old.csv\"\nlatches = \"off\"\n");
  for (const ProposedExperiment& one : {lilies, balls, both, longer}) {
    const std::string file = here.write("next_experiment.toml", next_experiment_toml("old", one));
    const Scenario scenario = load_scenario({old, file}, {});
    EXPECT_EQ(scenario.model.module.count, one.modules);
    EXPECT_DOUBLE_EQ(scenario.duration, 60 * std::max(one.minutes, one.ball_minutes));
    const Experiment experiment = load_experiment({old, file});
    const std::size_t added = (one.minutes > 0 ? 1u : 0u) + (one.ball_minutes > 0 ? 1u : 0u);
    EXPECT_EQ(experiment.recordings.size(), added + (one.alone() ? 0u : 1u));
    EXPECT_EQ(experiment.name, "old-next");
  }
}

}  // namespace
}  // namespace lilytank
