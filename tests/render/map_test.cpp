#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lilytank/render.hpp"
#include "render/picture.hpp"

namespace lilytank {
namespace {

using sample::Folder;
using sample::kNan;

MapPanel panel_of(int cells, double value) {
  MapPanel p;
  p.title = "title";
  p.label = "label (m/s)";
  p.cells = cells, p.extent = 0.3;
  p.values.assign(static_cast<std::size_t>(cells * cells), value);
  return p;
}

TEST(Map, WritesAllThreeFormats) {
  const Folder folder;
  const Map map{"title", 0.3, 2, {panel_of(4, 1), panel_of(50, 2), panel_of(3, 0)}};
  for (const char* ending : {"png", "svg", "pdf"}) {
    draw_map(map, folder.file(std::string("a.") + ending));
  }
  EXPECT_EQ(sample::bytes_of(folder.file("a.pdf")).substr(0, 5), "%PDF-");
  EXPECT_GT(sample::png_size(folder.file("a.png")).width, 1500);
  EXPECT_EQ(folder.names().size(), 3u);
}

TEST(Map, TakesOddNumbers) {
  const Folder folder;
  for (const double value :
       {0.0, kNan, 1e300, -1e300, 1e-300, 5.0, std::numeric_limits<double>::infinity()}) {
    for (const ColourScale scale : {ColourScale::rising, ColourScale::diverging}) {
      MapPanel p = panel_of(7, value);
      p.scale = scale;
      p.values[3] = 1;
      p.arrow_x.assign(49, value), p.arrow_y.assign(20, 1);
      p.hatched.assign(60, true);
      EXPECT_NO_THROW(draw_map({"", 0.3, 1, {p}}, folder.file("a.png"))) << value;
      p.low = 0, p.high = 1e-3;
      EXPECT_NO_THROW(draw_map({"", 0, 3, {p, p}}, folder.file("a.svg"))) << value;
    }
  }
  MapPanel few = panel_of(7, 1);
  few.values.resize(10);
  EXPECT_NO_THROW(draw_map({"", 0.3, 1, {few}}, folder.file("a.png")));
  EXPECT_NO_THROW(draw_map({}, folder.file("a.png")));
}

TEST(Map, RefusesWhatIsNoMap) {
  const Folder folder;
  EXPECT_THROW(draw_map({"", 0.3, 1, {panel_of(0, 1)}}, folder.file("a.png")), InputError);
  EXPECT_THROW(draw_map({"", 0.3, 1, {panel_of(3, 1)}}, folder.file("a.jpg")), InputError);
  Map small{"", 0.3, 1, {panel_of(3, 1)}};
  small.panel_size = 10;
  EXPECT_THROW(draw_map(small, folder.file("a.png")), InputError);
  EXPECT_TRUE(folder.names().empty());
}

// Cell (0, 0) is at the lower left, rows run along x; a panel's square begins at (62, 40) units.
TEST(Map, ShowsCellsWhereTheyAre) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  const Folder folder;
  MapPanel p = panel_of(2, 0);
  p.scale = ColourScale::diverging;
  p.values = {-1, 1, kNan, 0};
  draw_map({"", 0, 1, {p}}, folder.file("a.png"));
  const sample::Pixels pixels(folder.file("a.png"));
  ASSERT_TRUE(pixels.read());
  const auto at = [&](double x, double y) {  // shares of the square, y up
    return pixels.at(2 * (62 + 340 * x), 2 * (40 + 340 * (1 - y)));
  };
  EXPECT_LT(difference(at(0.25, 0.25), {0x21, 0x66, 0xAC}), 6) << "lowest: blue";
  EXPECT_LT(difference(at(0.75, 0.25), {0xB2, 0x18, 0x2B}), 6) << "highest: red";
  EXPECT_LT(difference(at(0.25, 0.75), {255, 255, 255}), 6) << "no data";
  EXPECT_LT(difference(at(0.75, 0.75), {0xF7, 0xF7, 0xF7}), 6) << "zero: pale";
}

TEST(Map, MarksClassesHatchedCellsAndArrows) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  const Folder folder;
  const auto dark = [&](const Map& map) {
    draw_map(map, folder.file("a.png"));
    const sample::Pixels pixels(folder.file("a.png"));
    int n = 0;
    for (int y = 100; y < 740; ++y) {
      for (int x = 140; x < 780; ++x) n += pixels.at(x, y).r < 90;
    }
    return n;
  };
  MapPanel p = panel_of(10, 0);
  p.classes = {"yes", "no"};
  const int plain = dark({"", 0, 1, {p}});
  MapPanel hatched = p, arrows = p, mixed = p;
  hatched.hatched.assign(100, true);
  arrows.arrow_x.assign(100, 1), arrows.arrow_y.assign(100, 1);
  for (std::size_t i = 0; i < 50; ++i) mixed.values[i] = 1;
  EXPECT_GT(dark({"", 0, 1, {hatched}}), plain + 2000);
  EXPECT_GT(dark({"", 0, 1, {arrows}}), plain + 2000);
  EXPECT_GT(dark({"", 0, 1, {mixed}}), plain + 150000) << "half of the square";
}

TEST(Map, TellsWhatHatchedCellsAre) {
  const Folder folder;
  MapPanel p = panel_of(10, 0);
  Map map{"", 0, 1, {p}};
  map.hatching = "filled";
  draw_map(map, folder.file("none.png"));
  map.panels[0].hatched.assign(100, false);
  map.panels[0].hatched[5] = true;
  draw_map(map, folder.file("told.png"));
  map.hatching.clear();
  draw_map(map, folder.file("untold.png"));
  const int bare = sample::png_size(folder.file("untold.png")).height;
  EXPECT_EQ(sample::png_size(folder.file("none.png")).height, bare) << "nothing is hatched";
  EXPECT_GT(sample::png_size(folder.file("told.png")).height, bare + 20);
}

TEST(Map, NamesCellsWithoutDataAmongClasses) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  const Folder folder;
  MapPanel p = panel_of(2, 0);
  p.classes = {"yes", "no"};
  const auto ink = [&](const char* name) {
    p.no_data = name;
    draw_map({"", 0.3, 1, {p}}, folder.file("a.png"));
    return sample::count_pixels(folder.file("a.png"),
                                [](const sample::Pixel& c) { return c.r < 90; });
  };
  EXPECT_GT(ink("not tested"), ink("") + 100);
}

TEST(PlotPage, PutsPlotsBesideAndBelowEachOther) {
  const Folder folder;
  Plot plot;
  plot.curves.push_back({"a", {0, 1}, {0, 1}, {}, {}});
  plot.width = 300, plot.height = 200;
  draw_plots({{plot, plot, plot}, 2}, folder.file("a.png"));
  EXPECT_EQ(sample::png_size(folder.file("a.png")), (sample::Size{1200, 800}));
  draw_plots({{plot, plot, plot}, 2, "above them all"}, folder.file("c.png"));
  EXPECT_GT(sample::png_size(folder.file("c.png")).height, 800);
  EXPECT_THROW(draw_plots({}, folder.file("b.png")), InputError);
}

}  // namespace
}  // namespace lilytank
