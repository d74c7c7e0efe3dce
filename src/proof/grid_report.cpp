// The false-positive rates of a grid, as a document and as a table.
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/file_digest.hpp"
#include "lilytank/proof_grid.hpp"
#include "lilytank/statistics.hpp"
#include "proof/rate_text.hpp"
#include "statistics/text_table.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

std::string reported_text(const GridRow& row) {
  return joined(row.reported, "; ", [](const auto& one) {
    return one.first + (one.second > 1 ? " x " + std::to_string(one.second) : "");
  });
}

// "time of the Lilies; gusts x 2": of experiments, where not of all that are insufficient.
std::string unmet_text(const GridRow& row) {
  return joined(row.unmet, "; ", [&](const auto& one) {
    const bool all = one.second == row.insufficient;
    return name_of(one.first) + (all ? "" : " x " + std::to_string(one.second));
  });
}

std::string seconds_text(double seconds) {
  return seconds > 0 ? significant(seconds, 6) : "known flow";
}

ReportSection table_of(const ProofGrid& grid) {
  ReportSection out{"Null experiments by cell"};
  out.table.head = {"balls (s)",     "Lilies (s)",   "modules",  "budget (min)",
                    "experiments",   "insufficient", "complete", "false positives",
                    "95 % interval", "reported",     "not met"};
  for (const GridRow& r : grid.rows) {
    const int n = r.answered();
    out.table.rows.push_back({seconds_text(r.cell.balls), seconds_text(r.cell.lilies),
                              std::to_string(r.cell.modules), significant(r.cell.budget, 4),
                              std::to_string(r.experiments), std::to_string(r.insufficient),
                              std::to_string(r.complete), std::to_string(r.false_positives),
                              n > 0 ? range_text(r.false_positives, n) : "", reported_text(r),
                              unmet_text(r)});
  }
  out.below = {
      "balls and Lilies: length of each of three recordings. Intervals (Wilson) are of the false "
      "positives among the experiments that are not insufficient. not met: requirements that the "
      "insufficient experiments do not meet, with the number of experiments if not all."};
  return out;
}

// Budgets share their experiments: each has a rate of its own.
ReportCard card_of_grid(const ProofGrid& grid) {
  struct Pooled {
    int experiments = 0, insufficient = 0, answered = 0, positives = 0;
  };
  std::map<double, Pooled> by_budget;
  for (const GridRow& r : grid.rows) {
    Pooled& p = by_budget[r.cell.budget];
    p.experiments += r.experiments, p.insufficient += r.insufficient;
    p.answered += r.answered(), p.positives += r.false_positives;
  }
  ReportCard card;
  card.verdict = std::to_string(grid.rows.size()) + " of " +
                 counted(static_cast<std::int64_t>(grid.cells), "cell") + " finished";
  for (const auto& [budget, p] : by_budget) {
    const std::string of = ", budget " + significant(budget, 4) + " min";
    if (p.answered > 0) {
      card.facts.emplace_back("false positives" + of, rate_text(p.positives, p.answered));
    }
    card.facts.emplace_back("insufficient" + of, count_text(p.insufficient, p.experiments));
  }
  return card;
}

}  // namespace

ReportDocument grid_report(const ProofGrid& grid) {
  ReportDocument report;
  report.title = "False positives by the amount of data";
  report.card = card_of_grid(grid);
  report.sections.push_back(table_of(grid));
  return report;
}

std::string grid_csv(const ProofGrid& grid) {
  std::string out =
      "balls_s,lilies_s,modules,budget_min,seed,experiments,insufficient,complete,"
      "false_positives,rate,rate_low,rate_high,reported,not_met,checksum\n";
  for (const GridRow& r : grid.rows) {
    const Estimate e = wilson(r.false_positives, r.answered());
    std::vector<std::string> row{r.cell.balls > 0 ? shortest(r.cell.balls) : "",
                                 shortest(r.cell.lilies), std::to_string(r.cell.modules),
                                 shortest(r.cell.budget), std::to_string(r.seed)};
    for (const int n : {r.experiments, r.insufficient, r.complete, r.false_positives}) {
      row.push_back(std::to_string(n));
    }
    for (const double of : {e.value, e.low, e.high}) {
      row.push_back(r.answered() > 0 ? shortest(of) : "");
    }
    row.push_back(reported_text(r)), row.push_back(unmet_text(r));
    out += with_checksum(joined(row, ",")) + "\n";
  }
  return out;
}

std::vector<std::string> grid_files() {
  return {"grid.txt", "grid.csv", "report.html"};
}

void write_grid(const ProofGrid& grid, const ReportDocument& report, const std::string& dir) {
  const std::filesystem::path path(dir);
  write_atomically((path / "grid.csv").string(), grid_csv(grid));
  write_atomically((path / "grid.txt").string(), report_text(report));
  write_atomically((path / "report.html").string(), report_html(report, {}));
}

}  // namespace lilytank
