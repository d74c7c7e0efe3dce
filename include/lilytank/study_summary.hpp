// What a study found: setting by setting, and setting against setting; as text and tidy tables.
#pragma once
#include <string>
#include <vector>

#include "lilytank/report.hpp"
#include "lilytank/statistics.hpp"
#include "lilytank/study_table.hpp"

namespace lilytank {

/// When k copies first stood, over the runs of a setting; censored where a run ended before.
struct CopyTime {
  /// Number of copies.
  int k = 1;
  /// Share of runs that had k copies while they ran, Wilson's.
  Estimate reached;
  /// Share of runs still below k copies, over time (s).
  Survival survival;
  /// s, of min(time, StudySummary::restricted_to).
  Estimate restricted_mean;
};

/// One setting. Everything but the counts of runs and `illegal` is from its finished runs only.
struct SettingSummary {
  std::string label;
  /// As in RunRow; empty where the table has no run of the setting.
  std::vector<double> values;
  /// Finished runs.
  int runs = 0;
  /// Runs without a result; statistics leave them out.
  int diverged = 0;
  /// Assemblies that the rules cannot make, in all runs.
  std::int64_t illegal = 0;
  /// Copies that the modules could make.
  int possible = 0;
  /// Standing at the end, mean with Student's interval, cut to what is possible.
  Estimate copies;
  /// Share of runs that had all possible copies, Wilson's.
  Estimate full_yield;
  /// Copies per second up to the end or to full yield, with Garwood's interval.
  Estimate rate;
  /// For each k of StudySummary::copies up to `possible`.
  std::vector<CopyTime> times;
  /// Mean count of copies reached over time (s), bootstrap band.
  CurveBand yield;
};

/// Log-rank test of the time to the k-th copy.
struct SurvivalTest {
  /// Number of copies.
  int k = 1;
  /// Settings; -1, -1: all of them at once.
  int a = -1, b = -1;
  /// Chi-squared statistic with its degrees of freedom.
  TestResult result;
  /// After Holm, over the pairs of settings tested for this k.
  double adjusted_p = 1;
};

/// Setting a less setting b, replicate by replicate: runs that share a seed.
struct PairTest {
  /// Restricted time to the k-th copy (s); 0: copies standing at the end.
  int k = 0;
  /// Numbers of the two settings.
  int a = 0, b = 0;
  /// Replicates that both settings have finished.
  int pairs = 0;
  /// Whether any run had the k-th copy in time; if not, the rest is not meaningful.
  bool reached = true;
  /// Mean of a - b, its interval and Student's test.
  PairedComparison result;
  /// After Holm, over the pairs of settings tested for this k.
  double adjusted_p = 1;
};

/// A study's statistics, all intervals at 95 %.
struct StudySummary {
  /// Name of the study.
  std::string name;
  std::vector<std::string> axes;  ///< dotted paths
  /// Longest duration of a setting, s.
  double horizon = 0;
  /// s, where restricted means end: the horizon, or the longest that some setting was watched
  double restricted_to = 0;
  /// The k that are reported: all, or a few round ones where there are many.
  std::vector<int> copies;
  std::vector<SettingSummary> settings;  ///< by number
  /// Else each setting is compared with setting 0 only.
  bool all_pairs = true;
  /// Over all settings, and over the pairs.
  std::vector<SurvivalTest> survival_tests;
  /// Of the pairs with common seeds.
  std::vector<PairTest> pair_tests;
};

/// Computes everything. The table may be of any part of a study, in any order of rows.
StudySummary summarise(const StudyTable& table);

/// The report, without its provenance.
ReportDocument study_report(const StudySummary& summary);
/// The same document as text.
std::string study_text(const StudySummary& summary);

/// One row per estimate.
std::string summary_csv(const StudySummary& summary);
/// One row per time.
std::string yield_curve_csv(const StudySummary& summary);
/// One row per step of each curve, from (0 s, 1) on.
std::string survival_csv(const StudySummary& summary);
/// One row per test.
std::string comparisons_csv(const StudySummary& summary);

/// Writes summary.txt (the report), summary.csv, yield_curve.csv, survival.csv and comparisons.csv
/// to a directory, made if absent. Throws InputError if it cannot.
void write_study_summary(const StudySummary& summary, const ReportDocument& report,
                         const std::string& dir);

}  // namespace lilytank
