// lilytank check: what can be proved about a ruleset without physics.
#include <algorithm>
#include <iostream>

#include "cli/check_kinetics.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/stop_signal.hpp"
#include "lilytank/lattice.hpp"

namespace lilytank::cli {
namespace {

void add_check_options(VerbOptions& options) {
  const auto text = [] { return cxxopts::value<std::string>(); };
  options.add()("modules", "how many (15; with --measure the scenario's)", text(), "M")(
      "lattice", "simulations of the lattice model (20)", text(), "N")(
      "attempts", "meetings in each (20000)", text(), "N")(
      "seed", "of all random numbers (1)", text(), "N")("force", "replace exported files")(
      "quiet", "no progress");
  add_kinetics_options(options);
}

}  // namespace

int check_verb(const Arguments& arguments) {
  VerbOptions options(
      "check", "RULESET",
      "Proves which assemblies a ruleset can build, where it gets stuck and whether its "
      "reverse rules undo their joins. Measures rates in simulations and runs a "
      "well-mixed model on them.");
  add_check_options(options);
  if (!options.parse(arguments)) return Exit::done;
  if (options.positional().size() != 1)
    options.refuse("one ruleset, please: lilytank check scenarios/rulesets/chain5.rules");
  check_kinetics_options(options);
  const CheckInput input = check_input(options);
  CheckOptions job;
  job.modules = input.modules;
  job.lattice_runs = static_cast<int>(options.whole("lattice", 20, 0, 100000));
  job.lattice.attempts = options.whole("attempts", 20000, 1, 1000000000);
  job.lattice.seed = static_cast<std::uint64_t>(options.whole("seed", 1, 0, INT64_MAX));
  job.lattice.stop = &stop_signal();
  RulesetCheck check;
  {
    Progress progress(options.has("quiet"));
    job.progress = [&](double done) { progress.tell(done, "of the lattice simulations"); };
    check = check_ruleset(input.rules, job);
    progress.clear();
  }
  if (stop_signal().load()) {
    std::cerr << "stopped; lattice simulations are not kept, so the same command starts again\n";
    return Exit::stopped;
  }
  std::cout << input.note << check_text(input.rules, check) << std::flush;
  const KineticsReport kinetics = run_kinetics(options, input);
  if (kinetics.stopped) {
    std::cerr << "stopped; finished simulations are kept, and the same command resumes\n";
    return Exit::stopped;
  }
  std::cout << kinetics.text << std::flush;
  if (kinetics.diverged > 0) return Exit::diverged;
  return check.faults.empty() ? Exit::done : Exit::fault;
}

}  // namespace lilytank::cli
