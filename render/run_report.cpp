// The pictures of a run beside its report.
#include <filesystem>

#include "html_report.hpp"

namespace lilytank {

void draw_run(const StoredRun& run, const ReportDocument& report, const std::string& dir) {
  const auto path = [&](const char* name) { return (std::filesystem::path(dir) / name).string(); };
  std::vector<std::pair<std::string, std::string>> figures;
  FrameStyle style;
  style.flow = FlowStyle::none;  // thousands of arrows would be most of the page
  draw_frame(run, run.trajectory.time.back(), style, path("frame.svg"));
  figures.emplace_back("frame", "The tank at the end of the run.");
  const Plot yield = yield_plot(run);
  draw_plot(yield, path("yield.png"));
  draw_plot(yield, path("yield.svg"));
  figures.emplace_back("yield", "Completed copies over time.");
  write_html_report(report, figures, dir);
}

}  // namespace lilytank
