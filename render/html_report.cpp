#include "html_report.hpp"

#include <filesystem>

#include "io/atomic_file.hpp"

namespace lilytank {

void write_html_report(const ReportDocument& report,
                       const std::vector<std::pair<std::string, std::string>>& figures,
                       const std::string& dir) {
  const std::filesystem::path path(dir);
  std::vector<ReportPicture> pictures;
  for (const auto& [name, caption] : figures) {
    pictures.push_back({read_whole((path / (name + ".svg")).string()), name, caption});
  }
  write_atomically((path / "report.html").string(), report_html(report, pictures));
}

std::vector<std::string> write_html_report(const ReportDocument& report,
                                           const std::vector<ReportFigure>& figures,
                                           const std::string& dir) {
  std::vector<std::string> names;
  std::vector<std::pair<std::string, std::string>> drawn;
  for (const ReportFigure& f : figures) {
    for (const char* ending : {".png", ".svg"}) {
      names.push_back(f.name + ending);
      draw_plots(f.page, (std::filesystem::path(dir) / names.back()).string());
    }
    drawn.emplace_back(f.name, f.caption);
  }
  write_html_report(report, drawn, dir);
  names.push_back("report.html");
  return names;
}

}  // namespace lilytank
