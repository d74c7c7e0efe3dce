// Frames of runs whose pumps are set, and legends that explain what can appear.
#include <gtest/gtest.h>

#include "../../render/layout.hpp"
#include "render/picture.hpp"
#include "render/sample_run.hpp"
#include "view/pumps.hpp"

namespace lilytank {
double legend_height(const StoredRun& run, const FrameStyle& style);  // its header needs Cairo's
namespace {

using sample::Folder;

constexpr double kRow = 64;

std::shared_ptr<const FlowField> still_water() {
  return std::make_shared<FlowField>(2, 0.3, std::vector<FlowSample>(4), std::vector<bool>(4, true),
                                     Interpolation::bilinear);
}

Command set_pumps(double at, int copies, int field) {
  Command c;
  c.kind = CommandKind::pump_power, c.at = at, c.copies = copies, c.field = field;
  return c;
}

// The made-up run with the pumps off from 5 s on.
StoredRun turned_off() {
  StoredRun run = sample::run(10);
  run.scenario.model.other_fields = {still_water()};
  run.scenario.model.commands = {set_pumps(5, 0, 1)};
  return run;
}

TEST(Pumps, FollowCommandsByTime) {
  StoredRun run = turned_off();
  run.scenario.model.commands.push_back(set_pumps(8, 0, 0));
  const Pumps pumps(run);
  EXPECT_EQ(pumps.field_at(0), 0);
  EXPECT_EQ(pumps.field_at(4.99), 0);
  EXPECT_EQ(pumps.field_at(5), 1);
  EXPECT_EQ(pumps.field_at(9), 0);
}

// A last join whose labels are 7 and 8: a copy stands once a module has each.
TEST(Pumps, FollowFinishedCopies) {
  StoredRun run = sample::run(400);
  Model& model = run.scenario.model;
  ASSERT_EQ(final_labels(model.rulesets[0]).size(), 1u);
  model.other_fields = {still_water()};
  model.feedback = {set_pumps(0, 1, 1)};
  const Pumps pumps(run);
  double first = 0;  // when the fourth joins the first chain
  for (int group = 0; group < 3; ++group) {
    const double whole = sample::join_time(group, 4);
    first = group == 0 ? whole : std::min(first, whole);
  }
  EXPECT_EQ(pumps.field_at(first - 1), 0);
  EXPECT_EQ(pumps.field_at(first + 1), 1);
}

TEST(Pumps, HaveNamesWhereTheirPowerChanges) {
  StoredRun run = turned_off();
  EXPECT_EQ(Pumps(run).power_of(0), "") << "made by hand: nothing tells the power";
  run.scenario.entries = {{"flow.pump_power", "69", "%"}};
  run.scenario.resolved =
      "[flow]\npump_power = 69.0  # %\n\n[[command]]\nat = 5  # s\ndo = \"pump_power\"\n"
      "modules = []  # all\npower = 0  # %\n\n[[command]]\nat = 8\npower = 69  # %\n";
  EXPECT_EQ(Pumps(run).power_of(0), "69 %");
  EXPECT_EQ(Pumps(run).power_of(1), "0 %");
  run.scenario.model.other_fields.clear();
  run.scenario.resolved.clear();
  EXPECT_EQ(Pumps(run).power_of(0), "") << "always the same";
}

// Pixels of the stream's blue in the tank.
int stream_pixels(const StoredRun& run, double time) {
  const Folder folder;
  FrameStyle style;
  style.size = 540, style.trail = 0;
  draw_frame(run, time, style, folder.file("a.png"));
  const sample::Pixels pixels(folder.file("a.png"));
  int count = 0;
  for (int y = 60; pixels.read() && y < 480; ++y) {
    for (int x = 70; x < 490; ++x) {
      const sample::Pixel p = pixels.at(x, y);
      count += p.b - p.r > 35 && p.r > 120 && p.r < 205;
    }
  }
  return count;
}

TEST(Frame, ShowsTheFlowInForce) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  const StoredRun run = turned_off();
  EXPECT_GT(stream_pixels(run, 2), 2000);
  EXPECT_LT(stream_pixels(run, 7), stream_pixels(run, 2) / 4);
}

// The mouth of the inlet at the right of the tank, at angle 0.
sample::Pixel inlet(const StoredRun& run) {
  const Folder folder;
  draw_frame(run, 1, {}, folder.file("a.png"));
  const sample::Pixels pixels(folder.file("a.png"));
  return pixels.read() ? pixels.at(kTankCentreX + kTankRadius + 20, kTankCentreY) : sample::Pixel{};
}

TEST(Frame, OfStillWaterHasNoInlets) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  StoredRun run = sample::run(10);
  EXPECT_LT(inlet(run).r, 250);
  run.scenario.model.field = still_water();
  EXPECT_EQ(inlet(run).r, 255);
}

TEST(Legend, HasRowsOnlyForWhatCanAppear) {
  StoredRun run = sample::run(10);
  FrameStyle style;
  EXPECT_EQ(legend_height(run, style), 4 * kRow) << "states, faces, marks, water";
  style.labels = false;
  EXPECT_EQ(legend_height(run, style), 4 * kRow) << "finished copies still stand out";
  run.scenario.model.rulesets[0].target.clear();
  EXPECT_EQ(legend_height(run, style), 3 * kRow) << "no marks at all";
  style.labels = true;
  run.scenario.model.control.latches = false;
  EXPECT_EQ(legend_height(run, style), 2 * kRow) << "state 0 and water";
  run.scenario.model.field = still_water();
  EXPECT_EQ(legend_height(run, style), kRow) << "state 0";
  // Balls have entries in the trajectory, but no states.
  run.trajectory.modules = 0;
  EXPECT_EQ(legend_height(run, style), 0);
}

// As modules are that are not part of a finished copy, which are nearly all.
TEST(Legend, ShowsStatesAsPaleAsModulesAre) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  const Folder folder;
  draw_frame(sample::run(10), 1, {}, folder.file("a.png"));
  const sample::Pixels pixels(folder.file("a.png"));
  ASSERT_TRUE(pixels.read());
  // Beside the number on the second chip, of state 1: (57, 199, 123), with 28 % of white.
  const sample::Pixel chip = pixels.at(1322, 804);
  EXPECT_NEAR(chip.r, 112, 4);
  EXPECT_NEAR(chip.g, 215, 4);
}

}  // namespace
}  // namespace lilytank
