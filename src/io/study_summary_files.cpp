#include <filesystem>
#include <system_error>

#include "io/atomic_file.hpp"
#include "lilytank/study_summary.hpp"

namespace lilytank {

void write_study_summary(const StudySummary& summary, const std::string& dir) {
  const std::filesystem::path path(dir);
  make_directory(dir);
  write_atomically((path / "summary.csv").string(), summary_csv(summary));
  write_atomically((path / "yield_curve.csv").string(), yield_curve_csv(summary));
  write_atomically((path / "survival.csv").string(), survival_csv(summary));
  write_atomically((path / "comparisons.csv").string(), comparisons_csv(summary));
  write_atomically((path / "summary.txt").string(), study_text(summary));
}

}  // namespace lilytank
