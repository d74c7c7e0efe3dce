#include "io/atomic_file.hpp"
#include "lilytank/study_summary.hpp"

namespace lilytank {

std::string study_text(const StudySummary& summary) {
  return report_text(study_report(summary));
}

void write_study_summary(const StudySummary& summary, const ReportDocument& report,
                         const std::string& dir) {
  write_files(dir, {{"summary.csv", summary_csv(summary)},
                    {"yield_curve.csv", yield_curve_csv(summary)},
                    {"survival.csv", survival_csv(summary)},
                    {"comparisons.csv", comparisons_csv(summary)},
                    {"summary.txt", report_text(report)}});
}

}  // namespace lilytank
