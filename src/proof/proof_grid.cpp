#include "lilytank/proof_grid.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "finder/diagnosis_setup.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/error.hpp"
#include "lilytank/random.hpp"
#include "proof/proof_tank.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr int kEachOfNull = 4;  // every fourth experiment of a seed is a null experiment
// Of the cost of a cell, for the progress: experiments that are simulated beside the null ensemble,
// and the fraction of the cost where the Lilies were not recorded for long enough.
constexpr double kBesideNulls = 400, kInsufficient = 0.02;

std::string identity_of(const GridOptions& options) {
  const ProofOptions& p = options.proof;
  return "1 " + std::to_string(p.diagnosis.seed) + (p.known_flow ? " known-flow" : "") +
         (p.drawn_tank ? " drawn-tank" : "") + (p.foreign ? " foreign" : "") +
         (p.latches.empty() ? "" : " " + words_for_latches(p)) +
         (p.diagnosis.uncertified ? " uncertified" : "");
}

// A seed that the command line takes.
std::uint64_t seed_of(std::uint64_t seed, const GridCell& cell) {
  const auto milliseconds = [](double s) {
    return static_cast<std::uint64_t>(std::llround(1e3 * s));
  };
  for (const std::uint64_t of : {milliseconds(cell.balls), milliseconds(cell.lilies),
                                 static_cast<std::uint64_t>(cell.modules)}) {
    seed = derived_seed(seed, of);
  }
  return seed >> 33;
}

double cost_of(const GridOptions& options, const GridCell& cell) {
  const double simulated =
      cell.lilies * cell.modules *
      (DiagnosisBudget(cell.budget).nulls + kBesideNulls + kOfANull * options.experiments);
  const bool enough = 3 * cell.lilies / 60 * cell.modules > kLeastLilyMinutes;
  return enough || options.proof.diagnosis.uncertified ? simulated : kInsufficient * simulated;
}

void add(ProofGrid& grid, GridRow row) {
  const auto after = std::ranges::upper_bound(grid.rows, row.cell, {}, &GridRow::cell);
  grid.rows.insert(after, std::move(row));
}

// Of another budget, where the same recordings are all insufficient.
std::optional<GridRow> insufficient_as(const ProofGrid& grid, const GridCell& cell) {
  for (GridRow row : grid.rows) {
    const double budget = std::exchange(row.cell.budget, cell.budget);
    if (budget == cell.budget || row.cell != cell || row.answered() > 0) continue;
    return row;
  }
  return std::nullopt;
}

GridRow run_cell(const GridOptions& options, const GridCell& cell,
                 const std::function<void(double, const std::string&)>& progress) {
  ProofOptions p = proof_of(options, cell);
  const std::string& dir = p.diagnosis.out;
  p.diagnosis.progress = progress;
  std::shared_ptr<const DirectoryLock> lock;
  p.diagnosis.lock = &lock;
  p.sealed = [&](const std::string& hash) { forget_other_key(dir, hash); };
  p.judged = [&](const Proof& so_far) { write_proof(so_far, dir); };
  try {
    const Proof proof = prove(p);
    open_key(proof, dir);
    return grid_row(cell, p.diagnosis.seed, proof);
  } catch (const InputError& error) {
    throw InputError("cell " + cell.name() + ": " + error.what());
  }
}

}  // namespace

GridRow grid_row(const GridCell& cell, std::uint64_t seed, const Proof& proof) {
  GridRow row{cell, seed};
  for (const ProofWorld& w : proof.worlds) {
    row.experiments += 1;
    for (const Requirement r : w.shortfalls) row.unmet[r] += 1;
    if (w.insufficient()) {
      row.insufficient += 1;
    } else if (w.right()) {
      row.complete += 1;
    } else {
      row.false_positives += 1;
      row.reported[w.findings.empty()
                       ? name_of(w.verdict)
                       : joined(w.findings, " + ", std::mem_fn(&ProofFinding::effect))] += 1;
    }
  }
  return row;
}

ProofOptions proof_of(const GridOptions& options, const GridCell& cell) {
  ProofOptions p = options.proof;
  p.only = "null", p.worlds = kEachOfNull * options.experiments, p.modelled = 0;
  p.minutes = cell.lilies / 60, p.ball_minutes = cell.balls / 60, p.modules = cell.modules;
  DiagnosisOptions& d = p.diagnosis;
  d.seed = seed_of(options.proof.diagnosis.seed, cell), d.minutes = cell.budget;
  d.out = (std::filesystem::path(options.proof.diagnosis.out) / cell.name()).string();
  d.lock = nullptr;
  return p;
}

ProofGrid prove_grid(const GridOptions& options) {
  const DiagnosisOptions& job = options.proof.diagnosis;
  const auto lock =
      claim_directory(job.out, job.force, {"grid", identity_of(options), grid_files()});
  if (job.lock != nullptr) *job.lock = lock;
  ProofGrid grid;
  std::vector<GridCell> left;
  double all = 0, spent = 0;
  for (const GridCell& cell : options.axes.cells(options.proof.known_flow)) {
    grid.cells += 1;
    const ProofOptions p = proof_of(options, cell);
    if (const auto there = finished_proof(p)) {
      add(grid, grid_row(cell, p.diagnosis.seed, *there));
    } else {
      left.push_back(cell), all += cost_of(options, cell);
    }
  }
  for (const GridCell& cell : left) {
    const double cost = cost_of(options, cell);
    const auto report = [&](double done, const std::string& note) {
      job.report((spent + cost * done) / all, "cell " + std::to_string(grid.rows.size() + 1) +
                                                  " of " + std::to_string(grid.cells) + ", " +
                                                  cell.name() + ": " + note);
    };
    if (const auto known = insufficient_as(grid, cell)) {
      add(grid, *known);
    } else {
      add(grid, run_cell(options, cell, report));
    }
    spent += cost;
    if (options.finished) options.finished(grid);
  }
  return grid;
}

}  // namespace lilytank
