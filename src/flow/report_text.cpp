#include <algorithm>
#include <cmath>
#include <cstdio>

#include "lilytank/flow_report.hpp"
#include "statistics/median.hpp"
#include "statistics/text_table.hpp"

namespace lilytank {
namespace {

// What a field looks like, over its measured cells.
struct Summary {
  double speed = 0, around = 0, inward = 0, deviation = 0;
  double mean_error = 0, deviation_error = 0;  // medians
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

// A table with a column an estimate.
class Columns {
 public:
  explicit Columns(const std::vector<FlowEstimate>& estimates)
      : estimates_(estimates), table_(head(estimates)) {}
  template <class Value>
  void add(const std::string& what, Value value) {
    std::vector<std::string> row{what};
    for (const FlowEstimate& e : estimates_) row.push_back(value(e));
    table_.add(std::move(row));
  }
  std::string text() const { return table_.text(); }

 private:
  static std::vector<std::string> head(const std::vector<FlowEstimate>& estimates) {
    std::vector<std::string> row{""};
    for (const FlowEstimate& e : estimates) row.push_back(e.name);
    return row;
  }
  const std::vector<FlowEstimate>& estimates_;
  TextTable table_;
};

std::string fields(const FlowReport& report) {
  Columns table(report.estimates);
  const int tank = report.estimates.empty() ? 0 : cells_in_tank(report.estimates.front());
  table.add("measured cells, of " + std::to_string(tank) + " in the tank",
            [](const FlowEstimate& e) { return std::to_string(e.measured()); });
  table.add("frames (paper), balances (smooth)",
            [](const FlowEstimate& e) { return std::to_string(e.samples); });
  const auto number = [](double Summary::*member) {
    return [member](const FlowEstimate& e) { return fixed(summary_of(e).*member, 4); };
  };
  table.add("mean speed, m/s", number(&Summary::speed));
  table.add("  counter-clockwise", number(&Summary::around));
  table.add("  inwards", number(&Summary::inward));
  table.add("standard deviation per axis, m/s", number(&Summary::deviation));
  table.add("median standard error of a mean", number(&Summary::mean_error));
  table.add("median standard error of a standard deviation", number(&Summary::deviation_error));
  return table.text();
}

// Of an estimate that is mostly made up from a few cells.
std::string few_cells(const FlowEstimate& e) {
  const int tank = cells_in_tank(e);
  if (5 * e.measured() >= tank) return "";
  return "warning: " + e.name + " measured " + std::to_string(e.measured()) + " of the tank's " +
         std::to_string(tank) +
         " cells and filled all others from these: record longer, or give fewer --cells or a "
         "smaller --least\n";
}

std::string normality(const FlowEstimate& e, double level) {
  std::string out;
  for (const bool along_x : {true, false}) {
    std::vector<double> p;
    int all = 0, tested = 0, alone = 0;
    for (const FlowCell& c : e.cell) {
      const NormalityTest& every = along_x ? c.all_x : c.all_y;
      const NormalityTest& thinned = along_x ? c.normal_x : c.normal_y;
      if (thinned.samples < 4) continue;
      ++tested;
      all += every.raw_p < level ? 1 : 0;
      alone += thinned.p < level ? 1 : 0;
      p.push_back(thinned.p);
    }
    const auto rejected = false_discovery(p, level);
    const auto found = std::count(rejected.begin(), rejected.end(), true);
    char line[200];
    std::snprintf(line, sizeof line,
                  "  %c: of %d cells, all frames as in Fig. 3 reject %d at %g %%; independent "
                  "samples %d, of which %ld stand as discoveries\n",
                  along_x ? 'x' : 'y', tested, all, 100 * level, alone, static_cast<long>(found));
    out += line;
  }
  return out;
}

std::string noise_text(const NoiseBudget& n) {
  char text[300];
  std::snprintf(text, sizeof text,
                "What moves the balls besides the mean flow:\n"
                "  tracking noise  %.3f +- %.3f mm\n"
                "  random force    %.2f +- %.2f mN per axis (sigma_stoch, one draw a 25 ms)\n"
                "  gusts           %.3f +- %.3f m/s per axis, averaged over the cells\n",
                n.tracking * 1e3, n.tracking_error * 1e3, n.stochastic * 1e3,
                n.stochastic_error * 1e3, n.gusts, n.gusts_error);
  return text;
}

std::string errors(const FlowReport& report) {
  Columns table(report.estimates);
  for (const bool measured : {true, false}) {
    const auto add = [&](const std::string& what, auto value, int digits) {
      table.add(what, [&](const FlowEstimate& e) {
        return fixed(value(compare_flow(e, *report.truth, measured)), digits);
      });
    };
    table.add(measured ? "measured cells" : "all cells", [&](const FlowEstimate& e) {
      return std::to_string(compare_flow(e, *report.truth, measured).cells);
    });
    add(
        "  mean: root mean square per axis", [](const FlowError& f) { return f.mean_rms; }, 4);
    add(
        "  mean: outwards", [](const FlowError& f) { return f.mean_radial; }, 4);
    add(
        "  mean: counter-clockwise", [](const FlowError& f) { return f.mean_around; }, 4);
    add(
        "  standard deviation: root mean square",
        [](const FlowError& f) { return f.deviation_rms; }, 4);
    add(
        "  standard deviation: average", [](const FlowError& f) { return f.deviation_bias; }, 4);
    if (!measured) continue;
    add(
        "  fraction of means within 1.96 standard errors",
        [](const FlowError& f) { return f.mean_coverage; }, 3);
    add(
        "  fraction of standard deviations within 1.96 standard errors",
        [](const FlowError& f) { return f.deviation_coverage; }, 3);
  }
  return "\nErrors against " + report.truth_file + ", m/s:\n" + table.text();
}

std::string bias_text(const std::vector<FlowBiasRow>& rows) {
  TextTable table({"synthetic recordings", "estimator", "cells", "mean rms", "outwards", "around",
                   "standard deviation rms", "average"});
  std::string missing;
  for (const FlowBiasRow& row : rows) {
    const FlowError& e = row.error;
    if (!row.missing.empty()) {
      table.add({row.what, row.estimator, "-", "-", "-", "-", "-", "-"});
      missing += "  " + row.what + ", " + row.estimator + ": " + row.missing + "\n";
      continue;
    }
    table.add({row.what, row.estimator, std::to_string(e.cells), fixed(e.mean_rms, 4),
               fixed(e.mean_radial, 4), fixed(e.mean_around, 4), fixed(e.deviation_rms, 4),
               fixed(e.deviation_bias, 4)});
  }
  return "\nErrors on synthetic recordings in this flow, m/s:\n" + table.text() + missing;
}

}  // namespace

int cells_in_tank(const FlowEstimate& estimate) {
  int count = 0;
  for (int i = 0; i < static_cast<int>(estimate.cell.size()); ++i) {
    count += std::hypot(estimate.x(i), estimate.y(i)) <= estimate.extent ? 1 : 0;
  }
  return count;
}

std::string flow_text(const FlowReport& report) {
  std::string out = "flow of " + report.name + "\n" + fields(report);
  for (const FlowEstimate& e : report.estimates) {
    out += e.name + ": " + e.filter + "\n";
    if (e.dropped > 0) {
      out += "  " + std::to_string(e.dropped) + " balances left out: a contact or the wall\n";
    }
  }
  for (const FlowEstimate& e : report.estimates) out += few_cells(e);
  for (const FlowEstimate& e : report.estimates) {
    if (e.noise) out += "\n" + noise_text(*e.noise);
    if (e.thinning > 0) {
      out += "\nNormality of the " + e.name +
             " samples in cells (Kolmogorov, Smirnov; frames of a "
             "ball within " +
             fixed(e.thinning, 2) + " s count once):\n" + normality(e, report.options.significance);
    }
  }
  if (report.truth) out += errors(report);
  if (!report.bias.empty()) out += bias_text(report.bias);
  return out;
}

}  // namespace lilytank
