// lilytank prove --grid: false positives by the amount of data.
#include <iostream>

#include "cli/progress.hpp"
#include "cli/prove_verb.hpp"
#include "cli/results.hpp"
#include "lilytank/proof_grid.hpp"
#include "proof/foreign_tank.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

GridAxes axes_of(const VerbOptions& options, const std::vector<std::string>& cells,
                 bool known_flow) {
  GridAxes axes;
  for (const std::string& text : cells) {
    if (known_flow && text.starts_with("balls=")) {
      options.refuse("--cells " + text + " with --known-flow: no balls are recorded");
    }
    try {
      set_axis(axes, text);
    } catch (const InputError& e) {
      options.refuse("--cells " + std::string(e.what()));
    }
  }
  return axes;
}

// The proof of a cell, as one that is carried through alone.
std::string command_of(const ProofOptions& p) {
  Arguments words{"lilytank", "prove", "--only", p.only};
  const auto value = [&](const std::string& name, const std::string& of) {
    words.insert(words.end(), {name, of});
  };
  const auto flag = [&](const std::string& name, bool is) {
    if (is) words.push_back(name);
  };
  value("--worlds", std::to_string(p.worlds)), value("--minutes", shortest(p.minutes));
  if (!p.known_flow) value("--ball-minutes", shortest(p.ball_minutes));
  value("--modules", std::to_string(p.modules));
  value("--budget", shortest(p.diagnosis.minutes)), value("--modelled", "0");
  flag("--known-flow", p.known_flow), flag("--drawn-tank", p.drawn_tank);
  if (!p.latches.empty()) value("--latches", p.latches);
  flag("--event-log", p.event_log);
  flag("--foreign", p.foreign), flag("--uncertified", p.diagnosis.uncertified);
  value("--seed", std::to_string(p.diagnosis.seed)), value("--out", p.diagnosis.out);
  return joined(words, " ");
}

int dry_run(const GridOptions& job) {
  const DiagnosisOptions& d = job.proof.diagnosis;
  check_directory_of("grid", d.out, d.force);
  if (job.proof.foreign) static_cast<void>(foreign_engine());  // is there one?
  const std::vector<GridCell> cells = job.axes.cells(job.proof.known_flow);
  std::cout << "would simulate " << counted(job.experiments, "null experiment") << " in each of "
            << counted(std::ssize(cells), "cell") << ", and diagnose those that are sufficient; in "
            << d.out << "\n";
  for (const GridCell& cell : cells) {
    const ProofOptions p = proof_of(job, cell);
    std::cout << "  " << command_of(p) << (finished_proof(p) ? "  # finished" : "") << "\n";
  }
  return Exit::done;
}

}  // namespace

int prove_on_grid(const VerbOptions& options, const ProofOptions& proof,
                  const std::vector<std::string>& cells, const Arguments& arguments, bool quiet,
                  const Host& host) {
  options.refuse_given({"minutes", "ball-minutes", "modules", "budget"},
                       "is an axis of the grid: write --cells AXIS=VALUE");
  options.refuse_given(
      {"only", "effect", "sizes", "closed-loop", "modelled", "figure-width", "no-titles"},
      "has no effect with --grid");
  GridOptions job;
  job.proof = proof, job.axes = axes_of(options, cells, proof.known_flow);
  if (options.has("worlds")) job.experiments = proof.worlds;
  DiagnosisOptions& d = job.proof.diagnosis;
  d.out = options.out("out/grid");
  if (options.has("dry-run")) return dry_run(job);
  const auto report_of = [&](const ProofGrid& grid) {
    ReportDocument report = grid_report(grid);
    report.provenance = provenance("prove", arguments, d.seed, {});
    return report;
  };
  job.finished = [&](const ProofGrid& so_far) { write_grid(so_far, report_of(so_far), d.out); };
  std::shared_ptr<const DirectoryLock> lock;  // until the report is written
  d.lock = &lock;
  Progress progress(quiet, host);
  progress.watch(d);
  const ProofGrid grid = prove_grid(job);
  progress.clear();
  const ReportDocument report = report_of(grid);
  write_grid(grid, report, d.out);
  return print_results(report, d.out, host);
}

}  // namespace lilytank::cli
