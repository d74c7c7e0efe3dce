#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lilytank/error.hpp"
#include "lilytank/render.hpp"
#include "render/picture.hpp"
#include "support/study_tables.hpp"

namespace lilytank {
namespace {

using sample::exponential_study;
using sample::Folder;

/// All files of a study's report.
void draw(const StudyTable& table, const std::string& dir) {
  const StudySummary summary = summarise(table);
  const ReportDocument report = study_report(summary);
  write_study_summary(summary, report, dir);
  draw_study(summary, report, dir);
}

const Plot* find(const std::vector<Figure>& plots, const std::string& name) {
  for (const Figure& p : plots) {
    if (p.name == name) return &p.page.plots[0];
  }
  return nullptr;
}

TEST(StudyReport, WritesTablesAndEveryPlotTwice) {
  const Folder folder;
  StudyTable table = sample::with_diverged(exponential_study({0.01, 0.03}, 8, 100));
  draw(table, folder.file("report"));
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.file("report"))) {
    names.insert(entry.path().filename().string());
  }
  std::set<std::string> expected{"summary.txt",  "summary.csv",     "yield_curve.csv",
                                 "survival.csv", "comparisons.csv", "report.html"};
  for (const char* figure : {"yield", "survival_1", "survival_2", "survival_3", "mean_time"}) {
    for (const char* ending : {".png", ".svg", ".pdf", ".caption.txt"}) {
      expected.insert(std::string(figure) + ending);
    }
  }
  EXPECT_EQ(names, expected);
  EXPECT_EQ(sample::png_size(folder.file("report/yield.png")), (sample::Size{1800, 1200}));
  EXPECT_NE(sample::bytes_of(folder.file("report/yield.svg")).find("<svg"), std::string::npos);
}

TEST(StudyReport, IsTheSameEachTime) {
  const Folder folder;
  StudyTable table = exponential_study({0.01, 0.03}, 8, 100);
  draw(table, folder.file("a"));
  std::reverse(table.rows.begin(), table.rows.end());
  draw(table, folder.file("b"));
  for (const char* name : {"summary.txt", "summary.csv", "yield_curve.csv", "yield.png"}) {
    EXPECT_EQ(sample::bytes_of(folder.file("a/" + std::string(name))),
              sample::bytes_of(folder.file("b/" + std::string(name))))
        << name;
  }
}

TEST(StudyReport, SurvivalFallsInStepsFromOneAndMarksWhatWasCensored) {
  StudyTable table;
  table.name = "hand", table.labels = {"only"}, table.horizon = 100;
  table.rows = {sample::run_row(0, 0, {50}), sample::run_row(0, 1, {20, 60}),
                sample::run_row(0, 2, {}, 70), sample::run_row(0, 3, {})};
  const auto plots = study_plots(summarise(table));
  const Plot* plot = find(plots, "survival_1");
  ASSERT_NE(plot, nullptr);
  ASSERT_EQ(plot->curves.size(), 1u);
  const Curve& c = plot->curves[0];
  EXPECT_TRUE(c.steps);
  EXPECT_EQ(c.name, "only");
  EXPECT_EQ(c.x, (std::vector<double>{0, 20, 50, 70, 100}));
  EXPECT_EQ(c.y, (std::vector<double>{1, 0.75, 0.5, 0.5, 0.5}));
  EXPECT_EQ(c.marks, (std::vector<double>{70, 100}));
  EXPECT_EQ(c.low.size(), c.x.size());
  EXPECT_EQ(find(plots, "mean_time"), nullptr) << "no axis";
  EXPECT_EQ(plot->title, "") << "one setting: nothing to test";
}

TEST(StudyReport, SurvivalGoesOnToTheHorizonWhereNobodyIsLeft) {
  StudyTable table;
  table.labels = {"quick"}, table.horizon = 100;
  table.rows = {sample::run_row(0, 0, {10, 20, 30}, 30), sample::run_row(0, 1, {15, 25, 40}, 40)};
  const auto plots = study_plots(summarise(table));
  const Curve& c = find(plots, "survival_1")->curves[0];
  EXPECT_EQ(c.x.back(), 100);
  EXPECT_EQ(c.y.back(), 0);
  EXPECT_TRUE(std::isnan(c.high.back())) << "without a band";
}

TEST(StudyReport, WithoutAnyEventTheBandSaysHowLittleIsKnown) {
  StudyTable table = exponential_study({1e-12}, 5, 100);
  const auto plots = study_plots(summarise(table));
  const Curve& c = find(plots, "survival_1")->curves[0];
  for (const double low : c.low) EXPECT_NEAR(low, std::pow(0.025, 0.2), 1e-12);
}

TEST(StudyReport, TimesAreInAUnitThatSuits) {
  const auto plots = study_plots(summarise(exponential_study({1e-4, 3e-4}, 8, 14400)));
  EXPECT_EQ(find(plots, "yield")->x_label, "time (h)");
  EXPECT_DOUBLE_EQ(find(plots, "yield")->curves[0].x.back(), 4);
  EXPECT_NE(find(plots, "survival_2")->title.find("(log-rank p "), std::string::npos);
}

TEST(StudyReport, EquallyManyCopiesHaveNoFirst) {
  const auto title = [](const std::vector<double>& rates) {
    return find(study_plots(summarise(exponential_study(rates, 8, 14400))), "yield")->title;
  };
  EXPECT_NE(title({1, 2}).find("all settings have 3 of 3 copies"), std::string::npos);
  EXPECT_NE(title({1e-6, 1, 2}).find("2 settings have 3 of 3 copies"), std::string::npos);
  EXPECT_NE(title({1e-6, 1}).find(" has most completed copies"), std::string::npos);
}

TEST(StudyReport, MeanTimesNeedOneAxisOfNumbers) {
  StudyTable table = exponential_study({0.01, 0.02, 0.04}, 8, 100);
  const auto with_labels = [&](std::vector<std::string> labels) {
    table.labels = std::move(labels);
    return study_plots(summarise(table));
  };
  const auto numbers = with_labels({"p=0.1", "p=20 %", "p=-3e-1"});
  const Plot* plot = find(numbers, "mean_time");
  ASSERT_NE(plot, nullptr);
  ASSERT_EQ(plot->curves.size(), 3u);
  EXPECT_TRUE(plot->curves[0].bars);
  ASSERT_EQ(plot->curves[1].x.size(), 3u);
  EXPECT_DOUBLE_EQ(plot->curves[1].x[2], 0.04) << "the middle curve stands on the values";
  EXPECT_LT(plot->x_low, 0.01);
  EXPECT_GT(plot->x_high, 0.04);
  EXPECT_FALSE(plot->log_x);
  EXPECT_EQ(find(with_labels({"p=0.1", "p=empirical", "p=0.3"}), "mean_time"), nullptr);
  EXPECT_EQ(find(with_labels({"", "p=", "3"}), "mean_time"), nullptr);
  table.labels = {"1", "2", "3"};
  table.axes.push_back("second");
  EXPECT_EQ(find(study_plots(summarise(table)), "mean_time"), nullptr);
  // Values over many decades.
  StudyTable wide = exponential_study({0.001, 0.01, 0.1}, 8, 100);
  const auto wide_plots = study_plots(summarise(wide));
  ASSERT_NE(find(wide_plots, "mean_time"), nullptr);
  EXPECT_TRUE(find(wide_plots, "mean_time")->log_x);
  EXPECT_GT(find(wide_plots, "mean_time")->x_low, 0);
}

TEST(StudyReport, TheAxisTellsTheUnitOfItsKey) {
  StudyTable table = exponential_study({0.01, 0.02}, 8, 100);
  const auto label = [&](const std::string& axis) {
    table.axes = {axis};
    return find(study_plots(summarise(table)), "mean_time")->x_label;
  };
  EXPECT_EQ(label("flow.pump_power"), "flow.pump_power (%)");
  EXPECT_EQ(label("flow.water_level"), "flow.water_level (m)");
  EXPECT_EQ(label("flow.K_v"), "flow.K_v") << "a plain number";
  EXPECT_EQ(label("power"), "power") << "a name that the study gave";
}

TEST(StudyReport, AColourMeansASettingInAllFigures) {
  StudyTable table = exponential_study({0.01, 0.02, 0.04}, 8, 100);
  std::erase_if(table.rows, [](const RunRow& row) { return row.setting == 0; });
  const auto plots = study_plots(summarise(table));
  for (const char* name : {"yield", "survival_1", "survival_3"}) {
    const std::vector<Curve>& curves = find(plots, name)->curves;
    ASSERT_EQ(curves.size(), 3u) << name;
    EXPECT_TRUE(curves[0].x.empty() && curves[0].name.empty()) << name << ": setting 0 is not run";
    EXPECT_EQ(curves[2].name, table.labels[2]) << name;
  }
}

std::vector<std::string> names_in(const Plot& plot) {
  std::vector<std::string> names;
  for (const Curve& curve : plot.curves) {
    if (!curve.name.empty()) names.push_back(curve.name);
  }
  return names;
}

TEST(StudyReport, LegendsSayWhatSettingsDifferIn) {
  StudyTable table = exponential_study({0.01, 0.02}, 4, 100);
  const auto yield_with = [&](std::vector<std::string> axes, std::vector<std::string> labels) {
    table.axes = std::move(axes), table.labels = std::move(labels);
    return *find(study_plots(summarise(table)), "yield");
  };
  const Plot one = yield_with({"module.count", "control.clock"},
                              {"count=10, clock=events", "count=15, clock=events"});
  EXPECT_EQ(names_in(one), (std::vector<std::string>{"count=10", "count=15"}));
  EXPECT_EQ(one.legend_title, "");
  const Plot two =
      yield_with({"p", "flow.pump_power", "control.clock"}, {"p_e, pump_power=60 %, clock=events",
                                                             "p_o, pump_power=80 %, "
                                                             "clock=events"});
  EXPECT_EQ(names_in(two), (std::vector<std::string>{"p_e, 60 %", "p_o, 80 %"}));
  EXPECT_EQ(two.legend_title, "p, pump_power");
  const Plot odd = yield_with({"a", "b"}, {"one, two, three", "one"});
  EXPECT_EQ(names_in(odd), (std::vector<std::string>{"one, two, three", "one"}));
}

TEST(StudyReport, OfManySettingsColoursTellAnAxis) {
  StudyTable table = exponential_study(std::vector<double>(30, 0.02), 4, 100);
  table.axes = {"module.count", "flow.pump_power"};
  for (RunRow& row : table.rows) {
    row.values = {10.0 + row.setting % 15, 60.0 + row.setting};
  }
  for (int s = 0; s < 30; ++s) {
    table.labels[static_cast<std::size_t>(s)] =
        "count=" + std::to_string(10 + s % 15) + ", pump_power=" + std::to_string(60 + s);
  }
  const auto plots = study_plots(summarise(table));
  const Plot* yield = find(plots, "yield");
  EXPECT_EQ(yield->legend_title, "module.count");
  EXPECT_EQ(names_in(*yield), (std::vector<std::string>{"10", "13", "17", "20", "24"}));
  EXPECT_EQ(yield->curves[0].shade, 0);
  EXPECT_EQ(yield->curves[29].shade, 1);
  const Plot* copies = find(plots, "copies_over_module.count");
  ASSERT_NE(copies, nullptr);
  ASSERT_NE(find(plots, "copies_over_flow.pump_power"), nullptr);
  EXPECT_EQ(copies->x_label, "module.count");
  EXPECT_EQ(copies->legend_title, "flow.pump_power (%)");
  ASSERT_EQ(copies->curves.size(), 30u);
  EXPECT_TRUE(copies->curves[3].bars);
  EXPECT_NE(copies->curves[3].x[0], copies->curves[18].x[0]) << "beside each other";
  EXPECT_NEAR(copies->curves[3].x[0], 13, 0.3);
  // Words have no colours.
  for (std::size_t s = 0; s < 30; ++s) table.labels[s] = "a, word" + std::to_string(s);
  EXPECT_EQ(names_in(*find(study_plots(summarise(table)), "yield")).size(), 30u);
}

TEST(StudyReport, OfManySettingsLeavesOutBands) {
  const auto few = study_plots(summarise(exponential_study(std::vector<double>(6, 0.02), 4, 100)));
  EXPECT_FALSE(find(few, "yield")->curves[0].low.empty());
  const auto many = study_plots(summarise(exponential_study(std::vector<double>(7, 0.02), 4, 100)));
  EXPECT_TRUE(find(many, "yield")->curves[0].low.empty());
  EXPECT_TRUE(find(many, "survival_1")->curves[0].low.empty());
}

TEST(StudyReport, TakesLittle) {
  const Folder folder;
  EXPECT_TRUE(study_plots(summarise({})).empty());
  EXPECT_NO_THROW(draw({}, folder.file("empty")));
  StudyTable one = exponential_study({0.05}, 1, 100);
  EXPECT_NO_THROW(draw(one, folder.file("one")));
  one.labels = {"a", "not run yet"};
  EXPECT_EQ(find(study_plots(summarise(one)), "yield")->curves.size(), 1u);
  for (RunRow& row : one.rows) row.possible = 0;
  EXPECT_TRUE(study_plots(summarise(one)).empty()) << "no target, nothing to count";
  EXPECT_THROW(draw(one, "/dev/null/x"), InputError);
}

TEST(Plot, DrawsBarsMarksAndGivenRanges) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  const Folder folder;
  Plot plot;
  Curve curve;
  curve.x = {0, 10}, curve.y = {0, 0}, curve.low = {-1, -1}, curve.high = {1, 1};
  curve.bars = true;
  plot.curves = {curve};
  plot.x_low = -10, plot.x_high = 20, plot.y_low = -2, plot.y_high = 2;
  const auto blue_columns = [&](double height) {
    draw_plot(plot, folder.file("a.png"));
    const sample::Pixels pixels(folder.file("a.png"));
    EXPECT_TRUE(pixels.read());
    int columns = 0;
    for (int x = 120; x < 1740; ++x) {
      const sample::Pixel p = pixels.at(x, height);
      columns += p.b > p.r + 60;
    }
    return columns;
  };
  // Halfway up the bars: two of 1.5 units, 3 pixels, each.
  const double up = 44 + 0.38 * 1076;
  EXPECT_GE(blue_columns(up), 4);
  EXPECT_LE(blue_columns(up), 12);
  // A mark: six units up from the line, and no band any more.
  plot.curves[0].low.clear(), plot.curves[0].high.clear();
  EXPECT_EQ(blue_columns(up), 0);
  plot.curves[0].marks = {5, 15, -3, std::nan("")};
  const double beside = 44 + 0.5 * 1076 - 9;
  EXPECT_GE(blue_columns(beside), 2) << "one mark; the others are not on the curve";
  EXPECT_LE(blue_columns(beside), 6);
}

}  // namespace
}  // namespace lilytank
