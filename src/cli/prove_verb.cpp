// lilytank prove: is a diagnosis to be trusted?
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/results.hpp"
#include "io/atomic_file.hpp"
#include "io/sha256.hpp"
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

void add_prove_options(VerbOptions& options, ProofOptions& job) {
  DiagnosisOptions& d = job.diagnosis;
  options.add({"worlds", "synthetic experiments (100)", "N"}, &job.worlds, 1, 1000000);
  options.add({"only", "null, named, two or unnamed: experiments of this kind only", "KIND"},
              &job.only, {"null", "named", "two", "unnamed"});
  options.add({"minutes", "of each of an experiment's three recordings (4)", "M"}, &job.minutes,
              0.2, 1e4);
  options.add({"ball-minutes", "of each of the three recordings of balls (as --minutes)", "M"},
              &job.ball_minutes, 0.1, 1e4);
  options.add({"known-flow", "give the diagnosis the true flow instead of balls"}, &job.known_flow);
  options.add({"drawn-tank",
               "draw the tank, too: its pumps, inlets and parameters (the built-in "
               "tank)"},
              &job.drawn_tank);
  options.add({"foreign",
               "record all experiments with another engine (Box2D), flow interpolation and camera"},
              &job.foreign);
  options.add(
      {"closed-loop", "split groups of effects by the experiments that are proposed for them"},
      &job.closed_loop);
  options.add({"modelled", "experiments in which the effect is also fitted and shown (10)", "N"},
              &job.modelled, 0, 1000000);
  options.add({"budget", "minutes for the tank's nulls and fingerprints (10)", "MINUTES"},
              &d.minutes, 1, 1e4);
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
  std::cout << "would simulate and diagnose " << counted(job.worlds, "experiment")
            << (job.only.empty() ? "" : " (of these, " + job.only + " only)")
            << " of 3 recordings of " << significant(job.minutes, 3)
            << " min; the tank's null experiments take about " << significant(d.minutes, 3)
            << " min on two cores; in " << d.out << "\n";
  return Exit::done;
}

// A directory may have had a proof of other experiments of the same tank, with a key of its own.
void forget_other_key(const std::filesystem::path& dir, const std::string& hash) {
  const std::filesystem::path key = dir / "key.txt";
  std::error_code ignored;
  if (!std::filesystem::exists(key, ignored)) return;
  if (sha256(read_whole(key.string())) != hash) std::filesystem::remove(key, ignored);
}

// The key is not among them: it stays closed until the last world is judged.
void keep(const Proof& so_far, const std::filesystem::path& dir) {
  write_atomically((dir / "proof.txt").string(), proof_text({&so_far, 1}));
  write_atomically((dir / "proof.csv").string(), proof_csv(so_far));
  write_atomically((dir / "tank.txt").string(), so_far.tank + "\n");
  write_atomically((dir / "intervals.csv").string(), proof_intervals_csv(so_far));
  const bool loops =
      std::ranges::any_of(so_far.worlds, [](const auto& w) { return w.loop.has_value(); });
  if (loops) write_atomically((dir / "closed_loop.csv").string(), proof_loops_csv(so_far));
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
  add_prove_options(options, job);
  FigureStyle style;
  add_figure_options(options, style);
  options.add({"quiet", "no progress"}, &quiet);
  if (!options.parse(arguments)) return Exit::done;
  if (!options.positional().empty()) {
    options.refuse_given(
        {"worlds", "only", "minutes", "ball-minutes", "known-flow", "drawn-tank", "foreign",
         "closed-loop", "modelled", "budget", "seed", "threads", "dry-run"},
        "is for a new proof");
    return print_together(options.positional(), options.text("out"), style, job.diagnosis.force,
                          host);
  }
  if (options.has("ball-minutes") && job.known_flow) {
    options.refuse("--ball-minutes with --known-flow: no balls are recorded");
  }
  job.diagnosis.out = options.out("out/proof");
  if (options.has("dry-run")) return dry_run(job);
  const std::filesystem::path dir(job.diagnosis.out);
  Progress progress(quiet, host);
  progress.watch(job.diagnosis);
  job.sealed = [&](const std::string& hash) {
    forget_other_key(dir, hash);
    std::cout << "ground truth recorded; its SHA-256: " << hash << std::endl;
  };
  job.judged = [&](const Proof& so_far) { keep(so_far, dir); };
  std::shared_ptr<const DirectoryLock> lock;  // until the report is written
  job.diagnosis.lock = &lock;
  const Proof proof = prove(job);
  progress.clear();
  write_atomically((dir / "key.txt").string(), proof.key);
  return report_proofs({&proof, 1}, job.diagnosis.out, style,
                       provenance("prove", arguments, job.diagnosis.seed, {}), host);
}

}  // namespace lilytank::cli
