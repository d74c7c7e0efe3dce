// lilytank prove: is a diagnosis to be trusted?
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/prove_verb.hpp"
#include "cli/results.hpp"
#include "io/atomic_file.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/proof.hpp"
#include "proof/foreign_tank.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

int report_proofs(std::span<const Proof> proofs, const std::string& dir, const FigureStyle& style,
                  const ReportProvenance& origin, const Host& host) {
  ReportDocument report = proof_report(proofs);
  report.provenance = origin;
  write_atomically((std::filesystem::path(dir) / "proof.txt").string(), report_text(report));
  if constexpr (kDraws) draw_proof(proof_figures(proofs), report, dir, style);
  if constexpr (!kDraws) say_undrawn("report.html");
  return print_results(report, dir, host);
}

// `out`: "" to print only.
int print_together(const std::vector<std::string>& dirs, const std::string& out,
                   const FigureStyle& style, bool force, const Host& host) {
  std::vector<Proof> proofs;
  std::string hashes;
  for (const std::string& dir : dirs) {
    proofs.push_back(read_proof(dir));
    for (std::size_t i = 0; i + 1 < proofs.size(); ++i) {
      if (proofs[i].hash == proofs.back().hash) {
        throw InputError(dir + " has the same key as " + dirs[i]);
      }
    }
    hashes += " " + proofs.back().hash;
  }
  ReportProvenance origin{"lilytank prove", LILYTANK_VERSION, "", {}};
  for (const std::string& dir : dirs) origin.command += " " + dir;
  if (out.empty()) {
    ReportDocument report = proof_report(proofs);
    report.provenance = origin;
    std::cout << printed(report, host) << std::flush;
    return Exit::done;
  }
  const auto lock = claim_directory(out, force, {"proof", "pooled" + hashes, proof_files()});
  return report_proofs(proofs, out, style, origin, host);
}

void add_prove_options(VerbOptions& options, ProofOptions& job, std::vector<std::string>* cells) {
  DiagnosisOptions& d = job.diagnosis;
  options.add({"worlds", "synthetic experiments (100), with --grid of each cell (10)", "N"},
              &job.worlds, 1, 1000000);
  options.add({"only", "null, named, two or unnamed: experiments of this kind only", "KIND"},
              &job.only, {"null", "named", "two", "unnamed"});
  options.add({"minutes", "of each of an experiment's three recordings (4)", "M"}, &job.minutes,
              0.2, 1e4);
  options.add({"ball-minutes", "of each of the three recordings of balls (as --minutes)", "M"},
              &job.ball_minutes, 0.1, 1e4);
  options.add({"modules", "in each of an experiment's recordings (15)", "N"}, &job.modules, 2, 100);
  options.add({"known-flow", "give the diagnosis the true flow instead of balls"}, &job.known_flow);
  options.add({"drawn-tank",
               "draw the tank, too: its pumps, inlets and parameters (the built-in "
               "tank)"},
              &job.drawn_tank);
  options.add({"foreign",
               "record all experiments with another engine (Box2D), flow interpolation and camera"},
              &job.foreign);
  options.add(
      {"latches", "latches on, with the rules of this file (recordings are then of self-assembly)",
       "FILE.rules"},
      &job.latches);
  options.add({"event-log", "with --latches: the modules' events are logged"}, &job.event_log);
  options.add({"effect", "draw this effect only (repeat: these effects)", "NAME"}, &job.effects);
  options.add({"sizes", "factor on the effects' amplitudes, at most 1 (1)", "F"}, &job.sizes, 0.01,
              1);
  options.add(
      {"closed-loop", "split groups of effects by the experiments that are proposed for them"},
      &job.closed_loop);
  options.add({"grid", "null experiments by length of recordings, modules and budget"});
  options.add({"cells",
               "only these values of an axis of the grid: balls, lilies, modules or budget; can be "
               "repeated",
               "AXIS=VALUE,..."},
              cells);
  options.add({"modelled", "experiments in which the effect is also fitted and shown (10)", "N"},
              &job.modelled, 0, 1000000);
  options.add({"budget", "minutes for the tank's nulls and fingerprints (10)", "MINUTES"},
              &d.minutes, 1, 1e4);
  options.add({"uncertified", "diagnose insufficient recordings, too"}, &d.uncertified);
  options.add({"seed", "of everything that is drawn (1)", "N"}, &d.seed, 0, INT64_MAX);
  options.add({"out", "directory of the results (out/proof)", "DIR"});
  options.add({"threads", "simulations at a time (default: one a core)", "N"}, &d.threads, 0, 4096);
  options.add({"dry-run", "check everything, write nothing"});
  options.add({"force", "replace another proof's files"}, &d.force);
}

int dry_run(const ProofOptions& job) {
  const DiagnosisOptions& d = job.diagnosis;
  check_directory_of("proof", d.out, d.force);
  if (job.foreign) static_cast<void>(foreign_engine());  // is there one?
  static_cast<void>(finished_proof(job));                // are there such rules, effects, kinds?
  std::cout << "would simulate and diagnose " << counted(job.worlds, "experiment")
            << (job.only.empty() ? "" : " (of these, " + job.only + " only)")
            << " of 3 recordings of " << significant(job.minutes, 3) << " min"
            << (job.modules == ProofOptions{}.modules ? ""
                                                      : " with " + counted(job.modules, "module"))
            << "; the tank's null experiments take about "
            << significant(std::max(d.minutes, kLeastTankMinutes), 3) << " min on two cores; in "
            << d.out << "\n";
  return Exit::done;
}

}  // namespace

int prove_verb(const Arguments& arguments, const Host& host) {
  VerbOptions options(
      "prove", "[PROOF...]",
      "Benchmarks the diagnosis: simulates experiments with known effects, with none, and with "
      "effects outside the catalogue, diagnoses them blind, and compares the verdicts with the "
      "ground truth. With directories of finished benchmarks: pools their experiments, with "
      "--out as a report.");
  ProofOptions job;
  bool quiet = false;
  std::vector<std::string> cells;
  add_prove_options(options, job, &cells);
  FigureStyle style;
  add_figure_options(options, style);
  options.add({"quiet", "no progress"}, &quiet);
  if (!options.parse(arguments)) return Exit::done;
  if (!options.positional().empty()) {
    options.refuse_given(
        {"worlds",  "only",     "minutes",   "ball-minutes", "modules", "known-flow",  "drawn-tank",
         "foreign", "latches",  "event-log", "effect",       "sizes",   "closed-loop", "grid",
         "cells",   "modelled", "budget",    "uncertified",  "seed",    "threads",     "dry-run"},
        "is for a new proof");
    return print_together(options.positional(), options.text("out"), style, job.diagnosis.force,
                          host);
  }
  if (job.event_log && job.latches.empty()) {
    options.refuse("--event-log without --latches: nothing latches");
  }
  if (!job.latches.empty() && job.foreign) {
    options.refuse("--latches with --foreign: Box2D's bodies do not latch");
  }
  if (options.has("ball-minutes") && job.known_flow) {
    options.refuse("--ball-minutes with --known-flow: no balls are recorded");
  }
  if (options.has("grid")) return prove_on_grid(options, job, cells, arguments, quiet, host);
  options.refuse_given({"cells"}, "goes with --grid");
  job.diagnosis.out = options.out("out/proof");
  if (options.has("dry-run")) return dry_run(job);
  const std::string& dir = job.diagnosis.out;
  Progress progress(quiet, host);
  progress.watch(job.diagnosis);
  job.sealed = [&](const std::string& hash) {
    forget_other_key(dir, hash);
    std::cout << "ground truth recorded; its SHA-256: " << hash << std::endl;
  };
  job.judged = [&](const Proof& so_far) { write_proof(so_far, dir); };
  std::shared_ptr<const DirectoryLock> lock;  // until the report is written
  job.diagnosis.lock = &lock;
  const Proof proof = prove(job);
  progress.clear();
  open_key(proof, dir);
  return report_proofs({&proof, 1}, dir, style,
                       provenance("prove", arguments, job.diagnosis.seed, {}), host);
}

}  // namespace lilytank::cli
