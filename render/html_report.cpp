#include "html_report.hpp"

#include <cmath>
#include <filesystem>

#include "frame.hpp"
#include "io/atomic_file.hpp"
#include "text/number.hpp"

namespace lilytank {

std::string whole_caption(const Figure& figure) {
  std::string out = figure.caption;
  if (!figure.n.empty()) out += " n: " + figure.n + ".";
  if (!figure.band.empty()) out += " Bands: " + figure.band + ".";
  return out;
}

std::string caption_file(const std::string& picture) {
  return std::filesystem::path(picture).replace_extension(".caption.txt").string();
}

std::string caption_text(const Figure& figure, const ReportProvenance& provenance) {
  std::string out = figure.caption + "\n";
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!value.empty()) out += name + ": " + value + "\n";
  };
  out += "\n";
  add("n", figure.n.empty() ? "see the report" : figure.n);
  add("bands", figure.band.empty() ? "none" : figure.band);
  add("seed", provenance.seed);
  add("command", provenance.command);
  add("version", provenance.version.empty() ? "" : "lilytank " + provenance.version);
  return out;
}

void draw_figures(const std::vector<Figure>& figures, const ReportProvenance& provenance,
                  const std::string& dir, const FigureStyle& style) {
  const std::filesystem::path path(dir);
  for (const Figure& f : figures) {
    for (const char* ending : {".png", ".svg", ".pdf"}) {
      const std::string file = (path / (f.name + ending)).string();
      if (!f.page.plots.empty()) draw_plots(f.page, file, style);
      if (!f.map.panels.empty()) draw_map(f.map, file, style);
      if (!f.corner.axes.empty()) draw_corner(f.corner, file, style);
    }
    write_atomically((path / (f.name + ".caption.txt")).string(), caption_text(f, provenance));
  }
}

void write_html_report(const ReportDocument& report, const std::vector<Figure>& figures,
                       const std::string& dir, const FigureStyle& style) {
  draw_figures(figures, report.provenance, dir, style);
  const std::filesystem::path path(dir);
  std::vector<ReportPicture> pictures;
  for (const Figure& f : figures) {
    pictures.push_back({read_whole((path / (f.name + ".svg")).string()), f.name, whole_caption(f)});
  }
  write_atomically((path / "report.html").string(), report_html(report, pictures));
}

std::vector<double> divided(std::vector<double> values, double by) {
  for (double& v : values) v /= by;
  return values;
}

MapPanel velocity_panel(const std::string& title, const VelocityMap& map,
                        const std::vector<double>& values) {
  MapPanel panel;
  panel.title = title;
  panel.cells = map.cells, panel.extent = map.extent;
  panel.values = values, panel.scale = ColourScale::diverging;
  return panel;
}

void draw_run(const StoredRun& run, const ReportDocument& report, const std::string& dir,
              const FigureStyle& style) {
  FrameStyle look;
  look.flow = FlowStyle::none;  // thousands of arrows would be most of the page
  const double end = run.trajectory.time.back();
  for (const char* file : {"frame.svg", "frame.pdf"}) {
    draw_frame(run, end, look, (std::filesystem::path(dir) / file).string(), style);
  }
  Figure frame = frame_figure(run, end, look);
  frame.name = "frame";
  Figure yield{"yield", "Completed copies of the target over time.", {{yield_plot(run)}}, {}};
  yield.n = "1 run of " + bodies_text(run);
  write_html_report(report, {frame, yield}, dir, style);
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

void draw_search(const Plot& plot, const ReportDocument& report, const std::string& dir,
                 const FigureStyle& style) {
  Figure figure{
      "fitness", "Convergence: the best point so far and the median of each iteration.", {{plot}}};
  if (!plot.curves.empty() && !plot.curves[0].x.empty()) {
    figure.n = significant(plot.curves[0].x.back(), 9) + " evaluations in " +
               std::to_string(plot.curves[0].x.size()) + " iterations";
  }
  write_html_report(report, {figure}, dir, style);
}

void draw_study(const StudySummary& summary, const ReportDocument& report, const std::string& dir,
                const FigureStyle& style) {
  write_html_report(report, study_plots(summary), dir, style);
}

}  // namespace lilytank
