// lilytank prove: is a diagnosis to be trusted?
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "io/atomic_file.hpp"
#include "io/sha256.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/proof.hpp"
#ifdef LILYTANK_HAS_RENDER
#include "lilytank/render.hpp"
#endif

namespace lilytank::cli {
namespace {

void report_proofs(std::span<const Proof> proofs, const std::string& dir) {
  const ReportDocument report = proof_report(proofs);
  const std::string text = report_text(report);
  write_atomically((std::filesystem::path(dir) / "proof.txt").string(), text);
#ifdef LILYTANK_HAS_RENDER
  draw_proof(proof_figures(proofs), report, dir);
#else
  std::cerr
      << "no report.html: this program was built without the renderer (Cairo was not found)\n";
#endif
  std::cout << text << std::flush;
  std::cerr << "results in " << dir << "\n";
}

// `out`: "" to print only.
int print_together(const std::vector<std::string>& dirs, const std::string& out, bool force) {
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
  if (out.empty()) {
    std::cout << proof_text(proofs) << std::flush;
  } else {
    const auto lock = claim_directory(out, force, {"proof", "pooled" + hashes, proof_files()});
    report_proofs(proofs, out);
  }
  return Exit::done;
}

void add_prove_options(VerbOptions& options) {
  const auto text = [] { return cxxopts::value<std::string>(); };
  options.add()("worlds", "synthetic experiments (100)", text(), "N")(
      "only", "null, named, two or unnamed: experiments of this kind only", text(), "KIND")(
      "minutes", "of each of an experiment's three recordings (4)", text(), "M")(
      "known-flow", "give the diagnosis the true flow instead of balls")(
      "drawn-tank", "draw the tank, too: its pumps, inlets and parameters (the built-in tank)")(
      "modelled", "experiments in which the effect is also fitted and shown (10)", text(), "N")(
      "budget", "minutes for the tank's nulls and fingerprints (10)", text(), "MINUTES")(
      "seed", "of everything that is drawn (1)", text(), "N")(
      "out", "directory of the results (out/proof)", text(), "DIR")(
      "threads", "simulations at a time (default: one a core)", text(), "N")(
      "force", "replace another proof's files")("quiet", "no progress");
}

ProofOptions proof_options(VerbOptions& options) {
  ProofOptions job;
  job.worlds = static_cast<int>(options.whole("worlds", job.worlds, 1, 1000000));
  job.only = options.text("only", "");
  const std::vector<std::string> kinds{"null", "named", "two", "unnamed"};
  if (options.has("only") && std::find(kinds.begin(), kinds.end(), job.only) == kinds.end()) {
    options.refuse("--only " + job.only + " is none of null, named, two, unnamed" +
                   did_you_mean(job.only, kinds));
  }
  job.minutes = options.number("minutes", job.minutes, 0.2, 1e4, "");
  job.modelled = static_cast<int>(options.whole("modelled", job.modelled, 0, 1000000));
  job.known_flow = options.has("known-flow"), job.drawn_tank = options.has("drawn-tank");
  job.diagnosis.minutes = options.number("budget", job.diagnosis.minutes, 1, 1e4, "");
  job.diagnosis.seed = static_cast<std::uint64_t>(options.whole("seed", 1, 0, INT64_MAX));
  job.diagnosis.threads = static_cast<int>(options.whole("threads", 0, 0, 4096));
  job.diagnosis.force = options.has("force");
  job.diagnosis.out = options.text("out", (std::filesystem::path("out") / "proof").string());
  if (job.diagnosis.out.empty()) options.refuse("--out is empty");
  return job;
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
}

}  // namespace

int prove_verb(const Arguments& arguments) {
  VerbOptions options(
      "prove", "[PROOF...]",
      "Benchmarks the diagnosis: simulates experiments with known effects, with none, and with "
      "effects outside the catalogue, diagnoses them blind, and compares the verdicts with the "
      "ground truth. With directories of finished benchmarks: pools their experiments, with "
      "--out as a report.");
  add_prove_options(options);
  if (!options.parse(arguments)) return Exit::done;
  if (!options.positional().empty()) {
    for (const char* other : {"worlds", "only", "minutes", "known-flow", "drawn-tank", "modelled",
                              "budget", "seed", "threads"}) {
      if (options.has(other)) options.refuse("--" + std::string(other) + " is for a new proof");
    }
    return print_together(options.positional(), options.text("out", ""), options.has("force"));
  }
  ProofOptions job = proof_options(options);
  const std::filesystem::path dir(job.diagnosis.out);
  Progress progress(options.has("quiet"));
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
  report_proofs({&proof, 1}, job.diagnosis.out);
  return Exit::done;
}

}  // namespace lilytank::cli
