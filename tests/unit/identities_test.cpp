// Modules whose trackers lose them: tracks in pieces, and more identities than bodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lilytank/predictor.hpp"
#include "scores/scores.hpp"
#include "support/filmed.hpp"

namespace lilytank {
namespace {

using test::drifting;
using test::filmed;
using test::plan_for;

// A piece of a track that goes on takes its body along: it is not carried twice.
TEST(Predictor, ABodyIsCarriedOnceWhereItsTrackIsInPieces) {
  const Model model = drifting(4);
  auto recordings = filmed(model, 6, 1);
  Track late = recordings[0].tracks[1];
  Track& first = recordings[0].tracks[1];
  for (auto* of : {&first.x, &first.y, &first.theta}) of->resize(60);
  late.first = 69;  // 0.3 s unseen
  for (auto* of : {&late.x, &late.y, &late.theta}) of->erase(of->begin(), of->begin() + 69);
  recordings[0].tracks.push_back(late);
  std::size_t most = 0;
  predict(model, recordings, predictor_options(model, recordings), [&](const PredictedFrame& f) {
    most = std::max(most, f.dx.size());
    const std::set<int> once(f.module.begin(), f.module.end());
    EXPECT_EQ(once.size(), f.module.size());
  });
  EXPECT_EQ(most, 4u);
}

// More identities than bodies: what modules differ in is not told, and the rest is as before.
TEST(Scores, DoWithoutIdentities) {
  const Model model = drifting(4);
  auto recordings = filmed(model, 20, 1);
  ScorePlan plan = plan_for(model, recordings);
  const std::size_t all = plan.entries().size();
  Track late = recordings[0].tracks[1];
  Track& first = recordings[0].tracks[1];
  for (auto* of : {&first.x, &first.y, &first.theta}) of->resize(300);
  late.first = 300, late.id = 40;
  for (auto* of : {&late.x, &late.y, &late.theta}) of->erase(of->begin(), of->begin() + 300);
  recordings[0].tracks.push_back(late);
  plan.modules = 5, plan.identities = false;
  EXPECT_EQ(plan.entries().size(), all - 12);
  const std::vector<double> of = score(plan, recordings);
  EXPECT_EQ(of.size(), plan.entries().size());
  EXPECT_TRUE(std::all_of(of.begin(), of.end(), [](double v) { return std::isfinite(v); }));
}

// A module of which nothing is told has no part in what modules differ in.
TEST(Scores, AModuleThatIsNotThereIsNotTheLeast) {
  const Model model = drifting(4);
  const auto recordings = filmed(model, 20, 1);
  ScorePlan plan = plan_for(model, recordings);
  const std::vector<double> before = score(plan, recordings);
  plan.modules = 6;
  EXPECT_EQ(score(plan, recordings), before);
}

}  // namespace
}  // namespace lilytank
