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
  int k = 1;
  Estimate reached;          ///< share of runs that had k copies while they ran, Wilson's
  Survival survival;         ///< share of runs still below k copies, over time (s)
  Estimate restricted_mean;  ///< s, of min(time, StudySummary::restricted_to)
};

/// One setting. Everything but the counts of runs and `illegal` is from its finished runs only.
struct SettingSummary {
  std::string label;
  std::vector<double> values;  ///< as in RunRow; empty where the table has no run of the setting
  int runs = 0;                ///< finished
  int diverged = 0, stopped = 0;
  std::int64_t illegal = 0;     ///< assemblies that the rules cannot make, in all runs
  int possible = 0;             ///< copies that the modules could make
  Estimate copies;              ///< standing at the end, mean with Student's interval, cut to what
                                ///< is possible
  Estimate full_yield;          ///< share of runs that had all possible copies, Wilson's
  Estimate rate;                ///< copies/s up to the end or to full yield, Garwood's
  std::vector<CopyTime> times;  ///< for each k of StudySummary::copies up to `possible`
  CurveBand yield;              ///< mean count of copies reached over time (s), bootstrap band
};

/// Log-rank test of the time to the k-th copy.
struct SurvivalTest {
  int k = 1;
  int a = -1, b = -1;  ///< settings; -1, -1: all of them at once
  TestResult result;
  double adjusted_p = 1;  ///< after Holm, over the pairs of settings tested for this k
};

/// Setting a less setting b, replicate by replicate: runs that share a seed.
struct PairTest {
  int k = 0;  ///< restricted time to the k-th copy (s); 0: copies standing at the end
  int a = 0, b = 0;
  int pairs = 0;
  bool reached = true;  ///< a run had the k-th copy in time; else the rest says nothing
  PairedComparison result;
  double adjusted_p = 1;  ///< after Holm, over the pairs of settings tested for this k
};

/// A study's statistics, all intervals at 95 %.
struct StudySummary {
  std::string name;
  std::vector<std::string> axes;  ///< dotted paths
  double horizon = 0;             ///< s
  /// s, where restricted means end: the horizon, or the longest that some setting was watched
  double restricted_to = 0;
  std::vector<int> copies;  ///< the k that are told of: all, or some round ones where that is many
  std::vector<SettingSummary> settings;  ///< by number
  bool all_pairs = true;                 ///< else each setting is compared with setting 0 only
  std::vector<SurvivalTest> survival_tests;
  std::vector<PairTest> pair_tests;
};

/// Computes everything. The table may be of any part of a study, in any order of rows.
StudySummary summarise(const StudyTable& table);

/// The report, without its provenance.
ReportDocument study_report(const StudySummary& summary);
std::string study_text(const StudySummary& summary);

/// Tidy tables, one observation a row, SI units except copies per hour (a column says so); unknown
/// and unbounded cells are empty. Settings come as number, label and one column an axis (in the
/// unit of its key, see Setting::texts; for words and overlays their position in the study file).
std::string summary_csv(const StudySummary& summary);      ///< a row an estimate
std::string yield_curve_csv(const StudySummary& summary);  ///< a row a time
std::string survival_csv(const StudySummary& summary);     ///< a row a step, from (0 s, 1) on
std::string comparisons_csv(const StudySummary& summary);  ///< a row a test

/// Writes summary.txt (the report), summary.csv, yield_curve.csv, survival.csv and comparisons.csv
/// to a directory, made if absent. Throws InputError if it cannot.
void write_study_summary(const StudySummary& summary, const ReportDocument& report,
                         const std::string& dir);

}  // namespace lilytank
