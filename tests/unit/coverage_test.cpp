// Which recordings are long enough for a flow map, a calibration and a diagnosis.
#include <gtest/gtest.h>

#include <cmath>

#include "lilytank/coverage.hpp"

namespace lilytank {
namespace {

constexpr int kCells = 50;
constexpr double kExtent = 0.3;

// A flow of 0.2 m/s with a standard error, of which cells with x < `until` hold `samples`.
FlowEstimate flow_with(double until, int samples, double error) {
  FlowEstimate flow;
  flow.name = "smooth", flow.cells = kCells, flow.extent = kExtent;
  flow.cell.resize(kCells * kCells);
  for (int i = 0; i < kCells * kCells; ++i) {
    FlowCell& cell = flow.cell[static_cast<std::size_t>(i)];
    cell.flow = {0.2, 0, 0.15, 0.15}, cell.error = {error, error, error, error};
    cell.samples = flow.x(i) < until ? samples : 0;
    cell.measured = cell.samples >= 4;
  }
  return flow;
}

// One body that passes along y = 0 from -0.25 m to 0.25 m at an even pace.
Recording passing(BodyKind body, int bodies, double minutes) {
  Recording r;
  r.body = body, r.rate = 10, r.frames = static_cast<int>(minutes * 60 * r.rate);
  for (int b = 0; b < bodies; ++b) {
    Track t;
    t.id = b;
    for (int f = 0; f < r.frames; ++f) {
      t.x.push_back(-0.25 + 0.5 * f / r.frames), t.y.push_back(0);
    }
    r.tracks.push_back(t);
  }
  return r;
}

TEST(Coverage, LongRecordingsInAMeasuredFlowMeetEveryRequirement) {
  const Recording balls = passing(BodyKind::ball, 24, 10), lilies = passing(BodyKind::lily, 15, 4);
  const FlowEstimate flow = flow_with(1, 20, 0.01);
  const Coverage c = coverage_of(&flow, {&balls, 1}, {&lilies, 1});
  EXPECT_NEAR(c.ball_minutes, 240, 1e-6);
  EXPECT_NEAR(c.lily_minutes, 60, 1e-6);
  EXPECT_DOUBLE_EQ(c.measured, 1);
  EXPECT_NEAR(c.flow_error, 0.01, 1e-12);
  EXPECT_NEAR(c.flow_speed, 0.2, 1e-12);
  EXPECT_TRUE(c.flow.empty());
  EXPECT_TRUE(c.lilies.empty());
}

// Not the tank's cells count, but those where the Lilies went.
TEST(Coverage, FlowMustBeMeasuredWhereLiliesWent) {
  const Recording balls = passing(BodyKind::ball, 24, 1), lilies = passing(BodyKind::lily, 15, 4);
  const FlowEstimate half = flow_with(0, 20, 0.01);
  const Coverage c = coverage_of(&half, {&balls, 1}, {&lilies, 1});
  EXPECT_NEAR(c.measured, 0.5, 0.03);
  ASSERT_EQ(c.flow.size(), 1u);
  EXPECT_NE(c.flow[0].what.find("(at least 90 %)"), std::string::npos) << c.flow[0].what;
  EXPECT_NE(to_record(c.flow).find("min more of 24 balls"), std::string::npos) << to_record(c.flow);
  Recording left = lilies;
  for (Track& t : left.tracks) {
    for (double& x : t.x) x = -std::fabs(x) - 0.01;
  }
  EXPECT_TRUE(coverage_of(&half, {&balls, 1}, {&left, 1}).flow.empty());
}

// The standard error falls with the root of the time: an error 1.5 times too large needs 1.25 times
// as much time in addition.
TEST(Coverage, MinutesToRecordFollowTheStandardError) {
  const Recording balls = passing(BodyKind::ball, 24, 4), lilies = passing(BodyKind::lily, 15, 4);
  const FlowEstimate flow = flow_with(1, 20, 1.5 * kLargestFlowError * 0.2);
  const Coverage c = coverage_of(&flow, {&balls, 1}, {&lilies, 1});
  ASSERT_EQ(c.flow.size(), 1u);
  EXPECT_EQ(to_record(c.flow), "5 min more of 24 balls");
}

// Where cells get samples evenly, the recommended minutes measure them.
TEST(Coverage, MinutesToRecordMeasureTheCells) {
  const Recording balls = passing(BodyKind::ball, 24, 1), lilies = passing(BodyKind::lily, 15, 4);
  FlowEstimate flow = flow_with(1, 3, 0.01);
  flow.cell[0].samples = 4, flow.cell[0].measured = true;
  const Coverage c = coverage_of(&flow, {&balls, 1}, {&lilies, 1});
  ASSERT_EQ(c.flow.size(), 1u);
  // 4 + 1.28 * 2 samples a cell where there are 3: 2.19 times the time.
  EXPECT_EQ(to_record(c.flow), "1.2 min more of 24 balls");
}

TEST(Coverage, GustsMustBeKnown) {
  const Recording balls = passing(BodyKind::ball, 24, 2), lilies = passing(BodyKind::lily, 15, 4);
  FlowEstimate flow = flow_with(1, 20, 0.01);
  flow.noise = NoiseBudget{};
  flow.noise->gusts = 0.15, flow.noise->gusts_error = 2 * kLargestGustError * 0.15;
  const Coverage c = coverage_of(&flow, {&balls, 1}, {&lilies, 1});
  EXPECT_NEAR(c.gust_error, 2 * kLargestGustError, 1e-12);
  ASSERT_EQ(c.flow.size(), 1u);
  EXPECT_EQ(to_record(c.flow), "6 min more of 24 balls");
}

TEST(Coverage, ShortfallsOfADiagnosisNameTheirRequirements) {
  const Recording balls = passing(BodyKind::ball, 24, 1), lilies = passing(BodyKind::lily, 5, 1);
  FlowEstimate flow = flow_with(0, 20, 2 * kLargestFlowError * 0.2);
  flow.noise = NoiseBudget{};
  flow.noise->gusts = 0.15, flow.noise->gusts_error = 2 * kLargestGustError * 0.15;
  std::string names;
  for (const Shortfall& s : shortfalls_of(&flow, {&balls, 1}, {&lilies, 1})) {
    names += name_of(s.requirement) + "; ";
  }
  EXPECT_EQ(names, "measured cells; mean flow; gusts; time of the Lilies; ");
}

// Of each kind of body the longest.
TEST(Coverage, WhatToRecordMeetsAllRequirements) {
  EXPECT_EQ(to_record({{Requirement::mean_flow, "", 2, BodyKind::ball, 24},
                       {Requirement::gusts, "", 8, BodyKind::ball, 24},
                       {Requirement::lily_time, "", 0.02, BodyKind::lily, 15}}),
            "0.1 min more of 15 Lilies and 8 min more of 24 balls");
}

TEST(Coverage, AKnownFlowNeedsOnlyLilies) {
  const Recording lilies = passing(BodyKind::lily, 15, 0.5);
  const Coverage c = coverage_of(nullptr, {}, {&lilies, 1});
  EXPECT_TRUE(c.flow.empty());
  EXPECT_TRUE(std::isnan(c.flow_error));
  ASSERT_EQ(c.lilies.size(), 1u);
  EXPECT_EQ(c.lilies[0].what, "time of the Lilies, summed over modules: 7.5 min (at least 15 min)");
  EXPECT_EQ(to_record(c.lilies), "0.5 min more of 15 Lilies");
}

}  // namespace
}  // namespace lilytank
