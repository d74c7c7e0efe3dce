// Figures for papers: their size on paper, live text, titles, captions.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <regex>

#include "lilytank/render.hpp"
#include "render/picture.hpp"
#include "render/sample_run.hpp"

namespace lilytank {
namespace {

using sample::Folder;

constexpr double kPoints = 72 / 25.4;  // a millimetre

// The size of a PDF's page, points; its dictionaries are not compressed.
std::array<double, 2> pdf_size(const std::string& file) {
  const std::string bytes = sample::bytes_of(file);
  std::smatch found;
  const std::regex box("/MediaBox \\[ 0 0 ([0-9.]+) ([0-9.]+) \\]");
  if (!std::regex_search(bytes, found, box)) return {0, 0};
  return {std::atof(found[1].str().c_str()), std::atof(found[2].str().c_str())};
}

// Sizes of an SVG's texts, points.
std::vector<double> text_sizes(const std::string& svg) {
  std::vector<double> sizes;
  const std::regex text("matrix\\(([-0-9.e]+) ([-0-9.e]+) [^>]*font-size=\"([0-9.]+)\"");
  for (std::sregex_iterator at(svg.begin(), svg.end(), text), end; at != end; ++at) {
    const auto number = [&](int k) { return std::atof((*at)[k].str().c_str()); };
    sizes.push_back(std::hypot(number(1), number(2)) * number(3));
  }
  return sizes;
}

void expect_readable(const std::string& svg, const std::string& what) {
  const std::vector<double> sizes = text_sizes(svg);
  EXPECT_GT(sizes.size(), 1u) << what;
  for (const double size : sizes) EXPECT_GE(size, 6 - 1e-3) << what;
}

bool has_poppler() {
  return !sample::output_of("command -v pdftotext").empty() &&
         !sample::output_of("command -v pdffonts").empty();
}

Plot sample_plot() {
  Plot plot;
  plot.title = "The MSD rises by 4 cm² in 3 s, which takes more than one line in a column.";
  plot.x_label = "lag (s)", plot.y_label = "MSD (cm²)";
  plot.curves = {{"recorded", {0, 1, 2, 3}, {0, 1, 3, 4}, {0, 0.5, 2, 3}, {0, 1.5, 4, 5}},
                 {"simulated", {0, 1, 2, 3}, {0, 2, 3, -5}, {}, {}}};
  return plot;
}

Map sample_map(int panels) {
  Map map;
  map.title = "The flow is fast.";
  map.tank_radius = 0.3, map.columns = 3;
  for (int k = 0; k < panels; ++k) {
    MapPanel p;
    p.title = "panel", p.label = "speed (m/s)";
    p.cells = 8, p.extent = 0.3;
    for (int i = 0; i < 64; ++i) p.values.push_back(0.01 * i);
    map.panels.push_back(p);
  }
  return map;
}

Corner sample_corner(int parameters) {
  Corner corner;
  corner.title = "K_v and K_F correlate by −0.98.";
  corner.draws_name = "simulated";
  for (int k = 0; k < parameters; ++k) {
    corner.axes.push_back({"D_linear", "1/s", false, 0, 0.8, 0.4, 0.3, 0.5, 0.35});
  }
  for (int i = 0; i < 50; ++i) corner.draws.emplace_back(parameters, 0.3 + 0.2 * i / 50);
  return corner;
}

Target chain_target() {
  return parse_target("name chain3\n###\n", "chain3");
}

std::string stages_of_chain(const std::string& file, const FigureStyle& style) {
  const Target target = chain_target();
  const Plan plan = make_plan(target, Algorithm::singleton);
  return stages_picture(target, stages_of(target, plan), target.name, file, style);
}

TEST(Paper, FiguresAreAsWideAsAColumn) {
  const Folder folder;
  const std::string file = folder.file("a.pdf");
  for (const double width : {85.0, 174.0}) {
    const FigureStyle style{width};
    const auto expect_width = [&](const std::string& what) {
      EXPECT_NEAR(pdf_size(file)[0] / kPoints, width, 0.05) << what;
      EXPECT_LE(pdf_size(file)[1] / kPoints, 245) << what << " fits a page";
    };
    draw_plot(sample_plot(), file, style);
    expect_width("plot");
    PlotPage page{std::vector<Plot>(12, sample_plot()), 4, "Twelve."};
    for (Plot& plot : page.plots) plot.title = "panel";
    draw_plots(page, file, style);
    expect_width("page of plots");
    for (const int panels : {1, 3, 9}) {
      draw_map(sample_map(panels), file, style);
      expect_width("map of " + std::to_string(panels));
    }
    for (const int parameters : {1, 2, 5}) {
      draw_corner(sample_corner(parameters), file, style);
      expect_width("corner of " + std::to_string(parameters));
    }
    draw_frame(sample::run(60), 50, {}, file, style);
    expect_width("tank");
  }
}

TEST(Paper, OtherFormatsHaveThatSizeToo) {
  const Folder folder;
  draw_plot(sample_plot(), folder.file("a.png"), {85});
  EXPECT_EQ(sample::png_size(folder.file("a.png")).width, std::lround(85 / 25.4 * 600))
      << "600 pixels an inch";
  draw_plot(sample_plot(), folder.file("a.svg"), {85});
  const std::string svg = sample::bytes_of(folder.file("a.svg"));
  std::smatch found;
  ASSERT_TRUE(std::regex_search(svg, found, std::regex("<svg[^>]* width=\"([0-9.]+)pt\"")));
  EXPECT_NEAR(std::atof(found[1].str().c_str()) / kPoints, 85, 0.05);
}

TEST(Paper, NoTextIsBelowSixPoints) {
  const Folder folder;
  const std::string file = folder.file("a.svg");
  const FigureStyle column{85};
  const auto svg = [&] { return sample::bytes_of(file); };
  draw_plot(sample_plot(), file, column);
  expect_readable(svg(), "plot");
  draw_plots({std::vector<Plot>(12, sample_plot()), 4, "Twelve."}, file, column);
  expect_readable(svg(), "page of plots");
  draw_map(sample_map(9), file, column);
  expect_readable(svg(), "map");
  draw_corner(sample_corner(5), file, column);
  expect_readable(svg(), "corner");
  draw_frame(sample::run(60), 50, {}, file, column);
  expect_readable(svg(), "tank");
  expect_readable(stages_of_chain(file, column), "stages");
}

// A dash of the keyboard is no minus sign, and an ellipsis is lost text.
TEST(Paper, TextIsWholeWithTrueMinusSigns) {
  const Folder folder;
  const std::string file = folder.file("a.svg");
  draw_plot(sample_plot(), file, {85});
  const std::string svg = sample::bytes_of(file);
  EXPECT_EQ(svg.find("…"), std::string::npos);
  EXPECT_NE(svg.find(">−4</text>"), std::string::npos);
  EXPECT_EQ(svg.find(">-4</text>"), std::string::npos);
}

TEST(Paper, TheNameOfAnAxisIsWholeBesideLongNamesOfRows) {
  const Folder folder;
  const std::string name = "mean square error / variance of the noise";
  Plot plot = sample_plot();
  plot.y_names = {"Orange_Whiffle_Ball", "gaps at contact, across the image"}, plot.x_label = name;
  draw_plot(plot, folder.file("a.svg"), {85});
  EXPECT_NE(sample::bytes_of(folder.file("a.svg")).find(">" + name + "</text>"), std::string::npos);
  expect_readable(sample::bytes_of(folder.file("a.svg")), "smaller");
}

TEST(Paper, ALegendHidesNotEvenALittleOfALine) {
  const Folder folder;
  const std::string file = folder.file("a.pdf");
  Plot plot;
  // A short line at each place where a legend may lie.
  for (const double x : {0.06, 0.5, 0.94}) {
    for (const double y : {0.06, 0.5, 0.94}) {
      plot.curves.push_back({"", {x, x}, {y, y + 0.02}, {}, {}});
    }
  }
  plot.x_low = plot.y_low = 0, plot.x_high = plot.y_high = 1;
  draw_plot(plot, file, {85});
  const double bare = pdf_size(file)[1];
  plot.curves[0].name = "named";
  draw_plot(plot, file, {85});
  EXPECT_GT(pdf_size(file)[1], bare) << "the legend stands below";
}

TEST(Paper, AStagesPictureThatHasNoRoomIsRefused) {
  std::string wide = "name wide\n" + std::string(30, '#') + "\n";
  const Target target = parse_target(wide, "wide");
  const Plan plan = make_plan(target, Algorithm::singleton);
  EXPECT_THROW(stages_picture(target, stages_of(target, plan), "", "a.pdf", {85}), InputError);
}

TEST(Paper, APdfHasLiveTextInEmbeddedFonts) {
  const Folder folder;
  const std::string file = folder.file("a.pdf");
  draw_plot(sample_plot(), file, {85});
  const std::string bytes = sample::bytes_of(file);
  EXPECT_NE(bytes.find("/FontFile"), std::string::npos);
  EXPECT_NE(bytes.find("/ToUnicode"), std::string::npos);
  if (!has_poppler()) GTEST_SKIP() << "reading the text needs poppler";
  const std::string text = sample::output_of("pdftotext '" + file + "' -");
  for (const char* words : {"recorded", "lag (s)", "MSD (cm²)", "−4", "rises by 4 cm²"}) {
    EXPECT_NE(text.find(words), std::string::npos) << words << " in\n" << text;
  }
  std::istringstream fonts(sample::output_of("pdffonts '" + file + "'"));
  std::string line;
  std::getline(fonts, line), std::getline(fonts, line);
  int embedded = 0;
  while (std::getline(fonts, line)) {
    EXPECT_TRUE(std::regex_search(line, std::regex("yes +yes +yes"))) << line;
    ++embedded;
  }
  EXPECT_GE(embedded, 1);
}

TEST(Paper, EqualPdfsHaveEqualBytes) {
  const Folder folder;
  for (const char* name : {"a.pdf", "b.pdf"}) draw_plot(sample_plot(), folder.file(name), {85});
  EXPECT_TRUE(sample::bytes_of(folder.file("a.pdf")) == sample::bytes_of(folder.file("b.pdf")));
  EXPECT_EQ(sample::bytes_of(folder.file("a.pdf")).find("CreationDate"), std::string::npos);
}

TEST(Paper, TitlesCanBeLeftOutAndPanelsKeepTheirNames) {
  const Folder folder;
  const std::string file = folder.file("a.svg");
  const auto holds = [&](const std::string& text) {
    return sample::bytes_of(file).find(text) != std::string::npos;
  };
  FigureStyle plain;
  plain.untitled = true;
  draw_plot(sample_plot(), file);
  EXPECT_TRUE(holds("rises by"));
  draw_plot(sample_plot(), file, plain);
  EXPECT_FALSE(holds("rises by"));
  PlotPage page{{sample_plot(), sample_plot()}, 2, "Two plots."};
  page.plots[0].title = "left", page.plots[1].title = "right";
  draw_plots(page, file, plain);
  EXPECT_FALSE(holds("Two plots."));
  EXPECT_TRUE(holds(">left</text>"));
  draw_map(sample_map(2), file, plain);
  EXPECT_FALSE(holds("The flow is fast."));
  EXPECT_TRUE(holds(">panel</text>"));
  draw_corner(sample_corner(2), file, plain);
  EXPECT_FALSE(holds("correlate by"));
}

TEST(Paper, CaptionsSayWhatNBandSeedAndCommandAre) {
  const Folder folder;
  Figure figure{"msd", "Mean squared displacement.", {{sample_plot()}}};
  figure.n = "45 bodies in 3 recordings", figure.band = "95 %, bootstrap over bodies";
  draw_figures({figure}, {"lilytank analyze a.toml", "0.1.0", "7", {}}, folder.path(), {85});
  for (const char* file : {"msd.png", "msd.svg", "msd.pdf", "msd.caption.txt"}) {
    EXPECT_FALSE(sample::bytes_of(folder.file(file)).empty()) << file;
  }
  EXPECT_EQ(sample::bytes_of(folder.file("msd.caption.txt")),
            "Mean squared displacement.\n\n"
            "n: 45 bodies in 3 recordings\n"
            "bands: 95 %, bootstrap over bodies\n"
            "seed: 7\n"
            "command: lilytank analyze a.toml\n"
            "version: lilytank 0.1.0\n");
}

TEST(Paper, EveryFigureOfAReportHasACaptionWithNAndLevel) {
  const Folder folder;
  Analysis a;
  a.sources.resize(1);
  a.sources[0].name = "run", a.sources[0].recordings = 1;
  a.sources[0].bodies = 15, a.sources[0].units = 3;
  AnalysisCurves set;
  set.name = "msd_all", set.x_name = "lag", set.x_unit = "s", set.y_name = "msd";
  set.y_unit = "m^2", set.x = {1, 2};
  set.sources.push_back({0, {{1e-4, 2e-4}, {0, 1e-4}, {2e-4, 3e-4}}, {3, 2}, {1, 1}});
  a.curves = {set};
  draw_analysis(a, analysis_report(a), folder.path());
  const std::string caption = sample::bytes_of(folder.file("msd_all.caption.txt"));
  EXPECT_NE(caption.find("n: run: 15 bodies (3 with latched ones as one) in 1 recording"),
            std::string::npos)
      << caption;
  EXPECT_NE(caption.find("bands: 95 %, bootstrap over bodies and assemblies"), std::string::npos)
      << caption;
  for (const std::string& name : folder.names()) {
    if (!name.ends_with(".pdf")) continue;
    const std::string of = caption_file(folder.file(name));
    EXPECT_NE(sample::bytes_of(of).find("\nn: "), std::string::npos) << of;
  }
}

TEST(Paper, ATankAloneHasNoPanel) {
  const Folder folder;
  const StoredRun run = sample::run(60);
  FrameStyle style;
  const auto svg = [&](const FigureStyle& paper) {
    draw_frame(run, 50, style, folder.file("a.svg"), paper);
    return sample::bytes_of(folder.file("a.svg"));
  };
  EXPECT_NE(svg({}).find("time (h:mm:ss)"), std::string::npos);
  EXPECT_EQ(svg({85}).find("time (h:mm:ss)"), std::string::npos) << "on paper";
  EXPECT_NE(svg({85}).find(">10 cm</text>"), std::string::npos) << "but a scale";
  style.panel = false;
  EXPECT_EQ(svg({}).find("time (h:mm:ss)"), std::string::npos);
  draw_frame(run, 50, style, folder.file("a.png"));
  EXPECT_EQ(sample::png_size(folder.file("a.png")), (sample::Size{1080, 1080}));
  const std::string caption = frame_caption(run, 50, style, {"lilytank render x", "", "3", {}});
  EXPECT_NE(caption.find("at 50 s"), std::string::npos);
  EXPECT_NE(caption.find("n: 15 modules in 1 run"), std::string::npos);
}

}  // namespace
}  // namespace lilytank
