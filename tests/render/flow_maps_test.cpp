// Maps of an extracted flow.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "lilytank/render.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

// Eight by eight cells; the lower half measured, its x axis normal and its y axis not.
FlowReport sample_report() {
  FlowReport report;
  report.name = "sample";
  FlowEstimate e;
  e.name = "paper", e.cells = 8, e.extent = 0.3, e.thinning = 0.2;
  e.cell.resize(64);
  FlowTruth truth{8, std::vector<FlowSample>(64)};
  for (std::size_t i = 0; i < 64; ++i) {
    FlowCell& c = e.cell[i];
    c.flow = {0.3, 0.4, 0.1, 0.2}, c.error = {0.01, 0.01, 0.01, 0.01};
    c.measured = i < 32, c.samples = static_cast<int>(i);
    c.all_x.samples = c.all_y.samples = c.normal_x.samples = c.normal_y.samples = i < 32 ? 10 : 0;
    c.all_x.raw_p = 0.9, c.normal_x.p = 0.5, c.all_y.raw_p = 0.04, c.normal_y.p = 0.0001;
    truth.sample[i] = {0.3, 0.1, 0.1, 0.1};
  }
  report.estimates = {e};
  report.truth = truth, report.truth_file = "truth.csv";
  return report;
}

const Map& named(const std::vector<Figure>& maps, const std::string& name) {
  for (const Figure& m : maps) {
    if (m.name == name) return m.map;
  }
  ADD_FAILURE() << "no map " << name;
  return maps.front().map;
}

constexpr std::size_t kCorner = 0, kMeasured = 3 * 8 + 3, kFilled = 4 * 8 + 4;

TEST(flowMaps, showSpeedAndHatchFilledCells) {
  const auto maps = flow_maps(sample_report());
  const MapPanel& speed = named(maps, "flow_paper").panels[0];
  EXPECT_TRUE(std::isnan(speed.values[kCorner]));
  EXPECT_NEAR(speed.values[kMeasured], 0.5, 1e-12);
  EXPECT_FALSE(speed.hatched[kMeasured]);
  EXPECT_TRUE(speed.hatched[kFilled]);
  EXPECT_NEAR(speed.arrow_y[kFilled], 0.4, 1e-12);
  EXPECT_NE(named(maps, "flow_paper").hatching.find("filled"), std::string::npos);
}

TEST(flowMaps, normalityHasARowATestAndAColumnAnAxis) {
  const Map map = named(flow_maps(sample_report()), "normality");
  ASSERT_EQ(map.panels.size(), 4u);
  EXPECT_EQ(map.columns, 2);
  const double rejected[] = {0, 1, 0, 1};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(map.panels[k].values[kMeasured], rejected[k]) << k;
    EXPECT_TRUE(std::isnan(map.panels[k].values[kFilled])) << k;
    EXPECT_EQ(map.panels[k].no_data, "not tested");
  }
}

TEST(flowMaps, normalityTellsTheLevelThatWasAskedFor) {
  FlowReport report = sample_report();
  report.options.significance = 0.01;
  const Map map = named(flow_maps(report), "normality");
  EXPECT_EQ(map.panels[0].title, "All frames, 1 %, x axis");
  report.options.significance = 0.05;
  EXPECT_EQ(named(flow_maps(report), "normality").panels[0].title, "All frames, 5 %, x axis");
}

TEST(flowMaps, errorsAreDifferencesFromTheTruth) {
  const Map map = named(flow_maps(sample_report()), "errors");
  EXPECT_NEAR(map.panels[0].values[kMeasured], 0.3, 1e-12);
  EXPECT_NEAR(map.panels[1].values[kMeasured], 0.05, 1e-12);
  EXPECT_EQ(map.panels[1].scale, ColourScale::diverging);
}

TEST(flowMaps, theReportIsADirectoryOfPictures) {
  const TemporaryDirectory dir;
  std::filesystem::create_directory(dir.path("out"));
  draw_flow(sample_report(), flow_report(sample_report()), dir.path("out"));
  for (const char* name : {"flow_paper", "normality", "errors"}) {
    for (const char* ending : {".png", ".svg"}) {
      const auto file = dir.path("out/" + std::string(name) + ending);
      ASSERT_TRUE(std::filesystem::exists(file)) << file;
      EXPECT_GT(std::filesystem::file_size(file), 2000u) << file;
    }
  }
}

}  // namespace
}  // namespace lilytank
