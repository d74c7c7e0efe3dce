// The false-positive rate of a diagnosis by the amount of data: null experiments on a grid of
// lengths of recordings, numbers of modules and budgets.
#pragma once
#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "lilytank/proof.hpp"

namespace lilytank {

struct ProofGrid;

/// One amount of data, diagnosed with one budget.
struct GridCell {
  double balls = 240;        ///< s, of each of three recordings; 0: the flow is known
  double lilies = 240;       ///< s, likewise
  int modules = 15;          ///< in a recording of Lilies
  double budget = 10;        ///< DiagnosisOptions::minutes
  std::string name() const;  ///< of its directory: "balls-20s_lilies-4min_modules-15_budget-1"
  /// By balls, Lilies, modules, budget.
  auto operator<=>(const GridCell&) const = default;
};

/// The values along each axis, in the order in which their cells run.
struct GridAxes {
  std::vector<double> budget{1, 10}, modules{15, 5, 30};
  std::vector<double> lilies{240, 60, 20}, balls{240, 60, 600, 20};
  /// All combinations: those of the first budget first, of these those of the first number of
  /// modules, then by Lilies and balls. Without balls where the flow is known.
  std::vector<GridCell> cells(bool known_flow) const;
};
/// Replaces an axis by "AXIS=VALUE,...": "lilies=4min,20s", "modules=15". A time without a unit is
/// in minutes. Throws InputError.
void set_axis(GridAxes& axes, const std::string& text);

struct GridOptions {
  GridAxes axes;
  int experiments = 10;  ///< of each cell
  /// Seed, tank, engine, directory, threads, and how it is stopped; what a cell has is replaced.
  ProofOptions proof;
  /// Called after every cell, with all so far.
  std::function<void(const ProofGrid& so_far)> finished;
};

/// A cell and the verdicts on its experiments.
struct GridRow {
  GridCell cell;
  std::uint64_t seed = 0;
  int experiments = 0, insufficient = 0, complete = 0, false_positives = 0;
  std::map<std::string, int> reported;  ///< names, or verdicts, of false positives
  std::map<Requirement, int> unmet;     ///< of insufficient experiments
  int answered() const { return complete + false_positives; }
};
GridRow grid_row(const GridCell& cell, std::uint64_t seed, const Proof& proof);

struct ProofGrid {
  std::size_t cells = 0;      ///< that are to run
  std::vector<GridRow> rows;  ///< of those that were finished, sorted by cell
};

/// The proof of one cell, in a directory of its own within that of the grid. Its seed is derived
/// from the grid's and the cell, not from the budget: budgets are compared on the same experiments.
ProofOptions proof_of(const GridOptions& options, const GridCell& cell);
/// Runs the proof of every cell that is not finished. Where all experiments of a cell are
/// insufficient, so are those with other budgets, which are not recorded again. Throws Stopped,
/// InputError.
ProofGrid prove_grid(const GridOptions& options);

/// Rates with Wilson intervals, by cell and pooled.
ReportDocument grid_report(const ProofGrid& grid);
/// One row a cell.
std::string grid_csv(const ProofGrid& grid);
/// Writes grid.txt, grid.csv and report.html.
void write_grid(const ProofGrid& grid, const ReportDocument& report, const std::string& dir);
/// Names of all files that a grid leaves in its directory, beside those of its cells.
std::vector<std::string> grid_files();

}  // namespace lilytank
