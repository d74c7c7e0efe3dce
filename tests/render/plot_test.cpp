#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "render/picture.hpp"
#include "render/sample_run.hpp"

namespace lilytank {
namespace {

using sample::Folder;
using sample::kNan;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kMost = std::numeric_limits<double>::max();

Plot plot_of(std::vector<double> x, std::vector<double> y) {
  Plot plot;
  plot.title = "title";
  plot.x_label = "x (m)";
  plot.y_label = "y (m)";
  plot.curves.push_back({"a curve", std::move(x), std::move(y), {}, {}, false, true});
  return plot;
}

TEST(Plot, WritesAllThreeFormats) {
  const Folder folder;
  const Plot plot = plot_of({0, 1, 2}, {1, 3, 2});
  draw_plot(plot, folder.file("a.png"));
  EXPECT_EQ(sample::png_size(folder.file("a.png")), (sample::Size{1800, 1200})) << "twice the size";
  draw_plot(plot, folder.file("a.SVG"));
  EXPECT_NE(sample::bytes_of(folder.file("a.SVG")).find("width=\"900"), std::string::npos);
  draw_plot(plot, folder.file("a.pdf"));
  EXPECT_EQ(sample::bytes_of(folder.file("a.pdf")).substr(0, 5), "%PDF-");
  EXPECT_EQ(folder.names().size(), 3u);
}

TEST(Plot, TextsOfAnSvgAreText) {
  const Folder folder;
  Plot plot = plot_of({0, 1, 2}, {1, 3, 2});
  plot.title = "a <b> & \"c\"";
  draw_plot(plot, folder.file("a.svg"));
  const std::string svg = sample::bytes_of(folder.file("a.svg"));
  for (const char* text : {">a &lt;b&gt; &amp; &quot;c&quot;</text>", ">x (m)</text>",
                           ">y (m)</text>", ">a curve</text>", ">3</text>"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(svg.find("glyph"), std::string::npos) << "no outlines";
  EXPECT_EQ(svg.find("miterlimit:1000"), std::string::npos) << "no place of a text";
}

TEST(Plot, TakesOddNumbers) {
  const Folder folder;
  const std::vector<Plot> plots = {
      Plot{},
      plot_of({}, {}),
      plot_of({1}, {2}),
      plot_of({0}, {0}),
      plot_of({1, 2, 3}, {5, 5, 5}),
      plot_of({1, 1, 1}, {1, 2, 3}),
      plot_of({kNan, kNan}, {1, kNan}),
      plot_of({0, 1, 2, 3, 4}, {1, kNan, 2, kInf, -kInf}),
      plot_of({0, 1}, {kMost, -kMost}),
      plot_of({0, 1}, {1e-320, 2e-320}),
      plot_of({1e-9, 2e-9}, {1e12, 1e13}),
      plot_of({1e15, 1e15 + 1}, {1, 1 + 1e-15}),
      plot_of({-3, -2, -1, 0, 1}, {-1, 0, 1, 2, 1e9}),
      plot_of({0, 1, 2, 3}, {1, 2}),  // lengths that differ
  };
  for (std::size_t i = 0; i < plots.size(); ++i) {
    for (int kind = 0; kind < 8; ++kind) {
      Plot plot = plots[i];
      plot.width = plot.height = 200;
      plot.log_x = kind & 1, plot.log_y = kind & 2;
      for (Curve& c : plot.curves) {
        c.steps = kind & 4;
        c.low = c.y, c.high = c.y;
        if (kind & 4) c.high.resize(c.high.size() / 2);
      }
      EXPECT_NO_THROW(draw_plot(plot, folder.file("a.png"))) << "plot " << i << " kind " << kind;
      EXPECT_NO_THROW(draw_plot(plot, folder.file("a.svg"))) << "plot " << i << " kind " << kind;
    }
  }
}

// Pixels of a clear colour, as curves and markers have.
int coloured_pixels(const std::string& file) {
  return sample::count_pixels(file, [](const sample::Pixel& p) {
    return std::max({p.r, p.g, p.b}) - std::min({p.r, p.g, p.b}) > 100;
  });
}

TEST(Plot, ALegendHidesNoMarker) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "no ffmpeg";
  const Folder folder;
  Plot plot;
  // One at each place where a legend may lie, so it has to lie elsewhere.
  for (const double x : {0.06, 0.5, 0.94}) {
    for (const double y : {0.06, 0.5, 0.94}) {
      Curve& curve = plot.curves.emplace_back();
      curve.x = {x}, curve.y = {y};
      curve.markers = true, curve.line = false;
    }
  }
  plot.x_low = plot.y_low = 0, plot.x_high = plot.y_high = 1;
  draw_plot(plot, folder.file("bare.png"));
  const int bare = coloured_pixels(folder.file("bare.png"));
  EXPECT_GT(bare, 900) << "nine markers of a hundred pixels and more";
  plot.curves.front().name = "with a name of some length";
  draw_plot(plot, folder.file("named.png"));
  EXPECT_GT(coloured_pixels(folder.file("named.png")), bare * 19 / 18)
      << "all nine, and the one in the legend";
}

// Low plots of one row or two have three curves that need their names.
TEST(Plot, ALegendOfThreeIsNeverCut) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "no ffmpeg";
  const Folder folder;
  Plot plot;
  plot.height = 156, plot.title = "low", plot.x_label = "x";
  for (int k = 0; k < 3; ++k) {
    Curve& curve = plot.curves.emplace_back();
    curve.x = {1.0 * k}, curve.y = {0};
    curve.markers = true, curve.line = false;
    if (k < 2) curve.name = "name";
  }
  draw_plot(plot, folder.file("two.png"));
  plot.curves[2].name = "name";
  draw_plot(plot, folder.file("three.png"));
  EXPECT_GT(coloured_pixels(folder.file("three.png")),
            coloured_pixels(folder.file("two.png")) + 30);
}

TEST(Plot, CrowdedMarkersWithoutALineAreAllDrawn) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "no ffmpeg";
  const Folder folder;
  Plot plot;
  Curve& curve = plot.curves.emplace_back();
  curve.x = {0.5, 0.504}, curve.y = {0.5, 0.5};  // some three units apart
  curve.markers = true, curve.line = false;
  plot.x_low = plot.y_low = 0, plot.x_high = plot.y_high = 1;
  draw_plot(plot, folder.file("two.png"));
  curve.x = {0.5}, curve.y = {0.5};
  draw_plot(plot, folder.file("one.png"));
  EXPECT_GT(coloured_pixels(folder.file("two.png")), coloured_pixels(folder.file("one.png")) + 20);
}

// The last column of a frame: the longest dark line upwards in the part of the page from `left`.
int right_frame(const std::string& file, int left, int right) {
  const sample::Pixels pixels(file);
  const int height = sample::png_size(file).height;
  int best = 0, most = 0;
  for (int x = left; pixels.read() && x < right; ++x) {
    int dark = 0;
    for (int y = 0; y < height; ++y) {
      const sample::Pixel p = pixels.at(x, y);
      dark += std::max({p.r, p.g, p.b}) < 110;
    }
    if (dark >= most) best = x, most = dark;
  }
  return best - left;
}

TEST(Plot, PanelsOfAPageAreEquallyWide) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "no ffmpeg";
  const Folder folder;
  PlotPage page;
  page.columns = 2;
  page.plots.assign(2, plot_of({0, 1}, {0, 1}));
  for (Plot& plot : page.plots) plot.width = 500, plot.height = 360;
  page.plots[0].curves[0].name.clear();
  // So much ink that the legend of the second goes beside its area.
  Curve dense;
  for (int i = 0; i < 600; ++i) dense.x.push_back(i / 599.0), dense.y.push_back(i % 2);
  dense.name = "dense";
  page.plots[1].curves.push_back(dense);
  draw_plots(page, folder.file("a.png"));
  const int first = right_frame(folder.file("a.png"), 400, 1000);
  EXPECT_GT(first, 100);
  EXPECT_NEAR(first, right_frame(folder.file("a.png"), 1400, 2000), 2);
}

TEST(Plot, GivenLimitsHold) {
  const Folder folder;
  Plot plot = plot_of({0, 1}, {0, 100});
  plot.y_low = 0, plot.y_high = 1;
  EXPECT_NO_THROW(draw_plot(plot, folder.file("a.png")));
  plot.log_y = true;
  EXPECT_NO_THROW(draw_plot(plot, folder.file("a.png")));
}

TEST(Plot, RowsHaveNamesFromTheTop) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  const Folder folder;
  Plot plot;
  plot.width = 400, plot.height = 300;
  plot.y_names = {"first", "second", "third"};
  Curve dots{"", {1}, {0}, {}, {}};
  dots.markers = true, dots.line = false;
  plot.x_low = 0, plot.x_high = 2;
  plot.curves = {dots};
  draw_plot(plot, folder.file("rows.png"));
  const sample::Pixels pixels(folder.file("rows.png"));
  ASSERT_TRUE(pixels.read());
  int above = 0, below = 0;  // blue of the only marker, in the row of the first name
  for (int y = 0; y < 600; ++y) {
    for (int x = 300; x < 720; ++x) {
      const sample::Pixel p = pixels.at(x, y);
      if (p.b > p.r + 60) ++(y < 300 ? above : below);
    }
  }
  EXPECT_GT(above, 50);
  EXPECT_EQ(below, 0);
}

TEST(Plot, ManyAndLongNamesFit) {
  const Folder folder;
  Plot plot;
  for (int k = 0; k < 60; ++k) {
    plot.curves.push_back({std::string(200, 'w'), {0, 1}, {0.0, double(k)}, {}, {}, false, true});
  }
  plot.title = plot.x_label = plot.y_label = std::string(500, 'm');
  EXPECT_NO_THROW(draw_plot(plot, folder.file("a.png")));
  plot.width = plot.height = 100;
  EXPECT_NO_THROW(draw_plot(plot, folder.file("a.png")));
}

TEST(Plot, AMillionPointsStaySmall) {
  const Folder folder;
  std::vector<double> x, y;
  for (int i = 0; i < 1000000; ++i) x.push_back(i), y.push_back(i * 1e-6);
  Plot plot = plot_of(x, y);
  draw_plot(plot, folder.file("a.pdf"));
  EXPECT_LT(std::filesystem::file_size(folder.file("a.pdf")), 1000000u);
}

TEST(Plot, ShowsItsCurve) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  const Folder folder;
  // A gap between two equal halves: ink left and right of it, none inside.
  Plot plot = plot_of({0, 4, 5, 6, 10}, {0, 0, kNan, 0, 0});
  plot.curves[0].name.clear(), plot.curves[0].markers = false;
  plot.y_low = -1.5, plot.y_high = 1.7;
  draw_plot(plot, folder.file("a.png"));
  const sample::Pixels pixels(folder.file("a.png"));
  ASSERT_TRUE(pixels.read());
  const auto blue_rows = [&](double share) {
    int rows = 0;
    for (int y = 150; y < 1050; ++y) {
      const sample::Pixel p = pixels.at(100 + share * 1648, y);
      rows += p.b > p.r + 90;
    }
    return rows;
  };
  EXPECT_GE(blue_rows(0.25), 3);
  EXPECT_EQ(blue_rows(0.51), 0);
  EXPECT_GE(blue_rows(0.75), 3);
}

TEST(Plot, RefusesUnknownEndingsAndUnwritableFiles) {
  const Folder folder;
  const Plot plot = plot_of({0, 1}, {0, 1});
  EXPECT_THROW(draw_plot(plot, folder.file("a.jpg")), InputError);
  EXPECT_THROW(draw_plot(plot, folder.file("a")), InputError);
  EXPECT_THROW(draw_plot(plot, ""), InputError);
  EXPECT_THROW(draw_plot(plot, folder.file("no/such/a.png")), InputError);
  EXPECT_THROW(draw_plot(plot, "/dev/null/a.pdf"), InputError);
  Plot flat = plot;
  flat.height = 0;
  EXPECT_THROW(draw_plot(flat, folder.file("a.png")), InputError);
  EXPECT_TRUE(folder.names().empty());
}

TEST(SearchPlot, TheFinalSelectionStandsAloneAndOffTheFrame) {
  const std::vector<IterationRecord> history = {
      {1, 100, 5, 7, 9, {}, 1}, {2, 200, 3, 6, 8, {}, 1}, {3, 300, 4, 4.5, 6, {}, 1}};
  const Plot plot = search_plot(history, true, "title", "s");
  ASSERT_EQ(plot.curves.size(), 3u);
  EXPECT_EQ(plot.curves[0].x, (std::vector<double>{100, 200})) << "it has no new points";
  EXPECT_EQ(plot.curves[1].y, (std::vector<double>{5, 3, 3})) << "it does not rise to other worlds";
  EXPECT_EQ(plot.curves[2].name, "final selection");
  EXPECT_EQ(plot.curves[2].x, std::vector<double>{300});
  EXPECT_EQ(plot.curves[2].y, std::vector<double>{4});
  EXPECT_GT(plot.x_high, 300);
  const Plot without = search_plot(history, false, "title", "s");
  ASSERT_EQ(without.curves.size(), 2u);
  EXPECT_EQ(without.curves[1].y, (std::vector<double>{5, 3, 4}));
  const Folder folder;
  EXPECT_NO_THROW(draw_plot(search_plot({}, false, "", ""), folder.file("a.png")));
  EXPECT_NO_THROW(draw_plot(search_plot({history[0]}, true, "", ""), folder.file("a.png")));
}

TEST(YieldPlot, IsAStaircaseUpToThePossibleCopies) {
  const Folder folder;
  const StoredRun run = sample::run(300);
  const Plot plot = yield_plot(run);
  ASSERT_EQ(plot.curves.size(), 2u);
  EXPECT_TRUE(plot.curves[0].steps);
  ASSERT_EQ(plot.curves[0].x.size(), run.metrics_time.size());
  EXPECT_DOUBLE_EQ(plot.curves[0].x.back(), 5) << "minutes";
  EXPECT_EQ(plot.curves[0].y.front(), 0);
  EXPECT_EQ(plot.curves[0].y.back(), 1) << "one chain is complete by then";
  EXPECT_EQ(plot.curves[1].y.back(), 3);
  EXPECT_EQ(plot.x_label, "time (min)");
  EXPECT_NO_THROW(draw_plot(plot, folder.file("a.png")));
}

TEST(YieldPlot, NeedsNeitherMetricsNorTarget) {
  const Folder folder;
  StoredRun run = sample::run(300);
  run.metrics_time.clear(), run.metrics_copies.clear();
  EXPECT_EQ(yield_plot(run).curves[0].y.back(), 1) << "then from the trajectory";
  EXPECT_NO_THROW(draw_plot(yield_plot(StoredRun{}), folder.file("a.png")));
}

}  // namespace
}  // namespace lilytank
