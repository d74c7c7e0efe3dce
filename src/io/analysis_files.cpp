#include <filesystem>
#include <system_error>

#include "io/atomic_file.hpp"
#include "lilytank/analysis.hpp"

namespace lilytank {

std::vector<std::string> write_analysis(const Analysis& analysis, const std::string& dir) {
  const std::filesystem::path path(dir);
  make_directory(dir);
  std::vector<std::string> files;
  const auto write = [&](const std::string& name, const std::string& content) {
    files.push_back((path / name).string());
    write_atomically(files.back(), content);
  };
  write("summary.txt", analysis_text(analysis));
  write("summary.csv", analysis_summary_csv(analysis));
  for (const AnalysisCurves& curves : analysis.curves) {
    write(curves.name + ".csv", curve_csv(analysis, curves));
  }
  if (analysis.options.msd_only) return files;
  write("velocity_map.csv", velocity_map_csv(analysis));
  write("contact_times.csv", contact_times_csv(analysis));
  write("transfer.csv", transfer_csv(analysis));
  return files;
}

}  // namespace lilytank
