// The report of a flow map as a document.
#include <algorithm>
#include <cmath>

#include "lilytank/flow_report.hpp"
#include "statistics/median.hpp"
#include "statistics/text_table.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

/// Averages of a field over its measured cells.
struct Summary {
  double speed = 0, around = 0, inward = 0, deviation = 0;
  double mean_error = 0, deviation_error = 0;  ///< medians
};

Summary summary_of(const FlowEstimate& e) {
  Summary s;
  std::vector<double> mean_errors, deviation_errors;
  const double n = e.measured();
  for (std::size_t i = 0; i < e.cell.size(); ++i) {
    const FlowCell& c = e.cell[i];
    if (!c.measured) continue;
    const double x = e.x(static_cast<int>(i)), y = e.y(static_cast<int>(i)), r = std::hypot(x, y);
    s.speed += std::hypot(c.flow.mu_x, c.flow.mu_y) / n;
    s.around += r > 0 ? (c.flow.mu_y * x - c.flow.mu_x * y) / r / n : 0;
    s.inward -= r > 0 ? (c.flow.mu_x * x + c.flow.mu_y * y) / r / n : 0;
    s.deviation += (c.flow.sigma_x + c.flow.sigma_y) / 2 / n;
    for (const double v : {c.error.mu_x, c.error.mu_y}) {
      if (!std::isnan(v)) mean_errors.push_back(v);
    }
    for (const double v : {c.error.sigma_x, c.error.sigma_y}) {
      if (!std::isnan(v)) deviation_errors.push_back(v);
    }
  }
  s.mean_error = median(mean_errors), s.deviation_error = median(deviation_errors);
  return s;
}

/// A table with one column per estimate.
class Columns {
 public:
  explicit Columns(const std::vector<FlowEstimate>& estimates) : estimates_(estimates) {
    table_.head.push_back("");
    for (const FlowEstimate& e : estimates) table_.head.push_back(e.name);
  }
  template <class Value>
  void add(const std::string& what, Value value) {
    std::vector<std::string> row{what};
    for (const FlowEstimate& e : estimates_) row.push_back(value(e));
    table_.rows.push_back(std::move(row));
  }
  const ReportTable& table() const { return table_; }

 private:
  const std::vector<FlowEstimate>& estimates_;
  ReportTable table_;
};

std::string with_error(double value, double error, int decimals) {
  return fixed(value, decimals) + " +- " + fixed(error, decimals);
}

/// Whether an estimate is mostly filled in from a few cells.
bool sparse(const FlowEstimate& e) {
  return 5 * e.measured() < cells_in_tank(e);
}

std::string cells_text(const FlowEstimate& e) {
  return std::to_string(e.measured()) + " of " + std::to_string(cells_in_tank(e));
}

/// Where the flow is not known well enough for the experiment's Lilies.
bool falls_short(const FlowReport& report) {
  return report.coverage && !report.coverage->flow.empty();
}

ReportSection coverage_section(const Coverage& coverage) {
  ReportSection section;
  section.title = "Where the Lilies went";
  section.table.head = {"", "", "needed"};
  section.table.rows = {{"share of their time in measured cells", fixed(coverage.measured, 3),
                         "at least " + fixed(kLeastMeasured, 2)},
                        {"standard error of the mean flow per axis (rms), over the speed (rms)",
                         fixed(coverage.flow_error / coverage.flow_speed, 3),
                         "at most " + fixed(kLargestFlowError, 2)},
                        {"relative standard error of the gusts' standard deviation",
                         std::isnan(coverage.gust_error) ? "-" : fixed(coverage.gust_error, 3),
                         "at most " + fixed(kLargestGustError, 2)}};
  return section;
}

ReportCard card_of(const FlowReport& report) {
  const FlowEstimate& e = report.estimates.back();
  const Summary s = summary_of(e);
  ReportCard card;
  card.tone = sparse(e) || falls_short(report) ? ReportTone::fault : ReportTone::good;
  card.verdict = "the balls measured the flow in " + cells_text(e) + " cells of the tank";
  card.facts = {
      {"mean speed", fixed(s.speed, 4) + " m/s"},
      {"gusts", fixed(s.deviation, 4) + " m/s per axis (standard deviation)"},
      {"standard error", fixed(s.mean_error, 4) + " m/s per axis of a cell's mean (median)"},
      {"next", sparse(e) ? "record the balls for longer, or use fewer --cells"
                         : "simulate in it with flow.file = \"flow_" + e.name + ".csv\""}};
  if (falls_short(report)) card.facts.back().second = "record " + to_record(report.coverage->flow);
  return card;
}

ReportSection fields(const FlowReport& report) {
  ReportSection section;
  section.title = "Field";
  Columns table(report.estimates);
  const int tank = cells_in_tank(report.estimates.front());
  table.add("measured cells, of " + std::to_string(tank) + " in the tank",
            [](const FlowEstimate& e) { return std::to_string(e.measured()); });
  table.add("frames (paper), balances (smooth)",
            [](const FlowEstimate& e) { return std::to_string(e.samples); });
  table.add("balances excluded: a contact or the wall",
            [](const FlowEstimate& e) { return e.dropped > 0 ? std::to_string(e.dropped) : "-"; });
  const auto number = [](double Summary::*member) {
    return [member](const FlowEstimate& e) { return fixed(summary_of(e).*member, 4); };
  };
  table.add("mean speed, m/s", number(&Summary::speed));
  table.add("  counter-clockwise", number(&Summary::around));
  table.add("  inwards", number(&Summary::inward));
  table.add("standard deviation per axis, m/s", number(&Summary::deviation));
  table.add("median standard error of a mean", number(&Summary::mean_error));
  table.add("median standard error of a standard deviation", number(&Summary::deviation_error));
  section.table = table.table();
  for (const FlowEstimate& e : report.estimates) section.below.push_back(e.name + ": " + e.filter);
  return section;
}

ReportSection noise_section(const NoiseBudget& n) {
  ReportSection section;
  section.title = "Noise";
  section.table.head = {"contribution to the balls' motion", "estimate", "unit"};
  section.table.rows = {
      {"tracking noise", with_error(n.tracking * 1e3, n.tracking_error * 1e3, 3), "mm"},
      {"random force per axis (sigma_stoch, one draw every 25 ms)",
       with_error(n.stochastic * 1e3, n.stochastic_error * 1e3, 2), "mN"},
      {"gusts per axis, averaged over the cells", with_error(n.gusts, n.gusts_error, 3), "m/s"}};
  return section;
}

/// Tests of one axis over the cells: name, cells, rejections.
std::vector<std::string> normality_row(const FlowEstimate& e, bool along_x, double level) {
  std::vector<double> p;
  int all = 0, alone = 0;
  for (const FlowCell& c : e.cell) {
    const NormalityTest& every = along_x ? c.all_x : c.all_y;
    const NormalityTest& thinned = along_x ? c.normal_x : c.normal_y;
    if (thinned.samples < 4) continue;
    all += every.raw_p < level ? 1 : 0;
    alone += thinned.p < level ? 1 : 0;
    p.push_back(thinned.p);
  }
  const auto rejected = false_discovery(p, level);
  return {along_x ? "x" : "y", std::to_string(p.size()), std::to_string(all), std::to_string(alone),
          std::to_string(std::count(rejected.begin(), rejected.end(), true))};
}

ReportSection normality_section(const FlowEstimate& e, double level) {
  ReportSection section;
  section.title = "Normality of the " + e.name + " samples in cells";
  section.above = {
      "Cells in which a Kolmogorov-Smirnov test at " + significant(100 * level, 3) +
      " % rejects a normal distribution. Independent samples: frames of a ball within " +
      fixed(e.thinning, 2) + " s count once."};
  section.table.head = {"axis", "cells tested", "all frames, as Fig. 3", "independent samples",
                        "at this false-discovery rate"};
  for (const bool along_x : {true, false}) {
    section.table.rows.push_back(normality_row(e, along_x, level));
  }
  return section;
}

void add_errors(const FlowReport& report, bool measured, Columns& table) {
  const auto add = [&](const std::string& what, double FlowError::*member, int digits) {
    table.add(what, [&](const FlowEstimate& e) {
      return fixed(compare_flow(e, *report.truth, measured).*member, digits);
    });
  };
  table.add(measured ? "measured cells" : "all cells", [&](const FlowEstimate& e) {
    return std::to_string(compare_flow(e, *report.truth, measured).cells);
  });
  add("  mean: root mean square per axis", &FlowError::mean_rms, 4);
  add("  mean: outwards", &FlowError::mean_radial, 4);
  add("  mean: counter-clockwise", &FlowError::mean_around, 4);
  add("  standard deviation: root mean square", &FlowError::deviation_rms, 4);
  add("  standard deviation: average", &FlowError::deviation_bias, 4);
  if (!measured) return;
  add("  fraction of means within 1.96 standard errors", &FlowError::mean_coverage, 3);
  add("  fraction of standard deviations within 1.96 standard errors",
      &FlowError::deviation_coverage, 3);
}

ReportSection errors_section(const FlowReport& report) {
  ReportSection section;
  section.title = "Errors against " + report.truth_file + " (m/s)";
  Columns table(report.estimates);
  for (const bool measured : {true, false}) add_errors(report, measured, table);
  section.table = table.table();
  return section;
}

ReportSection bias_section(const std::vector<FlowBiasRow>& rows) {
  ReportSection section;
  section.title = "Errors on synthetic recordings in this flow (m/s)";
  section.table.head = {
      "synthetic recordings",   "estimator", "cells", "mean rms", "outwards", "around",
      "standard deviation rms", "average"};
  for (const FlowBiasRow& row : rows) {
    const FlowError& e = row.error;
    if (!row.missing.empty()) {
      section.table.rows.push_back({row.what, row.estimator, "-", "-", "-", "-", "-", "-"});
      section.below.push_back(row.what + ", " + row.estimator + ": " + row.missing);
      continue;
    }
    section.table.rows.push_back({row.what, row.estimator, std::to_string(e.cells),
                                  fixed(e.mean_rms, 4), fixed(e.mean_radial, 4),
                                  fixed(e.mean_around, 4), fixed(e.deviation_rms, 4),
                                  fixed(e.deviation_bias, 4)});
  }
  return section;
}

}  // namespace

int cells_in_tank(const FlowEstimate& estimate) {
  int count = 0;
  for (int i = 0; i < static_cast<int>(estimate.cell.size()); ++i) {
    count += std::hypot(estimate.x(i), estimate.y(i)) <= estimate.extent ? 1 : 0;
  }
  return count;
}

ReportDocument flow_report(const FlowReport& report) {
  ReportDocument out;
  out.title = "Flow of " + report.name;
  out.subtitle = "tank of radius " + significant(100 * report.ball.tank_radius, 3) +
                 " cm; balls of radius " + significant(1000 * report.ball.radius, 3) +
                 " mm and drag coefficient " + significant(report.ball.drag_coefficient, 3);
  out.card = card_of(report);
  out.sections.push_back(fields(report));
  for (const FlowEstimate& e : report.estimates) {
    if (e.noise) out.sections.push_back(noise_section(*e.noise));
    if (e.thinning > 0) {
      out.sections.push_back(normality_section(e, report.options.significance));
    }
    if (sparse(e)) {
      out.warnings.push_back(e.name + " measured " + cells_text(e) +
                             " cells of the tank and filled all others from these: record longer, "
                             "or use fewer --cells or a smaller --least");
    }
  }
  if (report.coverage && report.coverage->lily_minutes > 0) {
    out.sections.push_back(coverage_section(*report.coverage));
    for (const Shortfall& s : report.coverage->flow) {
      out.warnings.push_back(s.what + ": record " + to_record({s}));
    }
  }
  if (report.truth) out.sections.push_back(errors_section(report));
  if (!report.bias.empty()) out.sections.push_back(bias_section(report.bias));
  return out;
}

}  // namespace lilytank
