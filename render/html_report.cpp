#include "html_report.hpp"

#include <cmath>
#include <filesystem>

#include "io/atomic_file.hpp"

namespace lilytank {

void write_html_report(const ReportDocument& report, const std::vector<Figure>& figures,
                       const std::string& dir) {
  const std::filesystem::path path(dir);
  std::vector<ReportPicture> pictures;
  for (const Figure& f : figures) {
    for (const char* ending : {".png", ".svg"}) {
      const std::string file = (path / (f.name + ending)).string();
      if (!f.page.plots.empty()) draw_plots(f.page, file);
      if (!f.map.panels.empty()) draw_map(f.map, file);
    }
    pictures.push_back({read_whole((path / (f.name + ".svg")).string()), f.name, f.caption});
  }
  write_atomically((path / "report.html").string(), report_html(report, pictures));
}

void draw_run(const StoredRun& run, const ReportDocument& report, const std::string& dir) {
  FrameStyle style;
  style.flow = FlowStyle::none;  // thousands of arrows would be most of the page
  draw_frame(run, run.trajectory.time.back(), style,
             (std::filesystem::path(dir) / "frame.svg").string());
  write_html_report(report,
                    {{"frame", "The tank at the end of the run.", {}, {}},
                     {"yield", "Completed copies over time.", {{yield_plot(run)}}, {}}},
                    dir);
}

Plot search_plot(const std::vector<IterationRecord>& history, bool selected,
                 const std::string& title, const std::string& y_label) {
  Plot plot;
  plot.title = title, plot.x_label = "evaluations", plot.y_label = y_label;
  Curve best{"best point so far"}, median{"median of an iteration's new points"};
  Curve last{"final selection"};
  best.steps = true, median.markers = true;
  last.markers = true, last.line = false;
  const auto add = [](Curve& curve, const IterationRecord& record, double value) {
    if (!std::isfinite(value)) return;
    curve.x.push_back(static_cast<double>(record.evaluations));
    curve.y.push_back(value);
  };
  for (const IterationRecord& record : history) {
    // A selection has no new points, and what it counts is not what the best so far were chosen by.
    if (selected && &record == &history.back()) {
      add(last, record, record.best);
      if (!best.y.empty()) add(best, record, best.y.back());
      continue;
    }
    add(best, record, record.best), add(median, record, record.median);
  }
  // Points at the end of the search keep off the frame.
  if (!history.empty()) plot.x_high = 1.03 * static_cast<double>(history.back().evaluations);
  plot.curves = {std::move(median), std::move(best)};
  if (!last.x.empty()) plot.curves.push_back(std::move(last));
  return plot;
}

void draw_search(const Plot& plot, const ReportDocument& report, const std::string& dir) {
  const std::string caption =
      "Convergence: the best point so far and the median of each iteration.";
  write_html_report(report, {{"fitness", caption, {{plot}}, {}}}, dir);
}

void draw_study(const StudySummary& summary, const ReportDocument& report, const std::string& dir) {
  write_html_report(report, study_plots(summary), dir);
}

}  // namespace lilytank
