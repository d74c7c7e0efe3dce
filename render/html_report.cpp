#include "html_report.hpp"

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

void draw_search(const Plot& plot, const ReportDocument& report, const std::string& dir) {
  const std::string caption =
      "Convergence: the best point so far and the median of each iteration.";
  write_html_report(report, {{"fitness", caption, {{plot}}, {}}}, dir);
}

void draw_study(const StudySummary& summary, const ReportDocument& report, const std::string& dir) {
  write_html_report(report, study_plots(summary), dir);
}

}  // namespace lilytank
