#include <filesystem>
#include <system_error>

#include "io/atomic_file.hpp"
#include "lilytank/analysis.hpp"

namespace lilytank {

std::vector<std::pair<std::string, std::string>> analysis_files(const Analysis& analysis,
                                                                const ReportDocument& report) {
  std::vector<std::pair<std::string, std::string>> files{
      {"summary.txt", report_text(report)}, {"summary.csv", analysis_summary_csv(analysis)}};
  for (const AnalysisCurves& curves : analysis.curves) {
    files.emplace_back(curves.name + ".csv", curve_csv(analysis, curves));
  }
  if (analysis.options.msd_only) return files;
  files.emplace_back("velocity_map.csv", velocity_map_csv(analysis));
  files.emplace_back("contact_times.csv", contact_times_csv(analysis));
  files.emplace_back("transfer.csv", transfer_csv(analysis));
  return files;
}

std::vector<std::string> write_analysis(const Analysis& analysis, const ReportDocument& report,
                                        const std::string& dir) {
  std::vector<std::string> files = write_files(dir, analysis_files(analysis, report));
  for (std::string& file : files) file = (std::filesystem::path(dir) / file).string();
  return files;
}

}  // namespace lilytank
