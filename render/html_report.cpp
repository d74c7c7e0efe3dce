#include "html_report.hpp"

#include <filesystem>

#include "io/atomic_file.hpp"

namespace lilytank {

std::vector<std::string> write_html_report(const ReportDocument& report,
                                           const std::vector<ReportFigure>& figures,
                                           const std::string& dir) {
  namespace fs = std::filesystem;
  std::vector<std::string> names;
  std::vector<ReportPicture> pictures;
  for (const ReportFigure& f : figures) {
    for (const char* ending : {".png", ".svg"}) {
      draw_plots(f.page, (fs::path(dir) / (f.name + ending)).string());
      names.push_back(f.name + ending);
    }
    const std::string svg = read_whole((fs::path(dir) / (f.name + ".svg")).string());
    pictures.push_back({svg, f.name, f.caption});
  }
  write_atomically((fs::path(dir) / "report.html").string(), report_html(report, pictures));
  names.push_back("report.html");
  return names;
}

}  // namespace lilytank
