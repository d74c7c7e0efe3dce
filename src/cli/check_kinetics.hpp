// The part of `lilytank check` that counts rates in worlds and runs the well-mixed model on them.
#pragma once
#include <optional>
#include <string>

#include "cli/options.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/kinetics.hpp"
#include "lilytank/lattice.hpp"
#include "lilytank/measure.hpp"
#include "lilytank/render.hpp"
#include "lilytank/scenario.hpp"

namespace lilytank::cli {

inline constexpr int kMostModules = 1000;

/// A command line of `lilytank check`.
struct CheckJob {
  VerbOptions options;
  CheckOptions check;
  MeasureOptions measured;  ///< how many simulations, their seed and threads
  std::vector<std::string> scenarios, sets;
  double duration = 0;   ///< s; 0: not given
  int gillespie = 1000;  ///< runs of the well-mixed model
  FigureStyle style;
  ReportProvenance origin;  ///< for captions
  bool force = false, quiet = false, json = false;
};

/// Adds --measure, --rates, --gillespie, --kappa, --bngl and the options that belong to them.
void add_kinetics_options(CheckJob& job);
/// Refuses those that would have no effect or overwrite what is read, before any work is done.
void check_kinetics_options(const CheckJob& job);

/// What is checked.
struct CheckInput {
  Ruleset rules;     ///< with the p that the scenario of --measure sets
  std::string note;  ///< a line on these p, if they are not the ruleset's
  int modules = 15;
  std::optional<Scenario> scenario;  ///< of --measure, with these rules and as many modules
  std::optional<RateTable> rates;    ///< of --rates
};
/// Reads the ruleset and what --measure or --rates name, before any work is done. Throws InputError
/// for files that cannot be used, and for what a scenario says that would have no effect.
CheckInput check_input(const CheckJob& job);

/// Lines on what run_kinetics() would do; writes nothing. Throws InputError for directories that it
/// would refuse.
std::string kinetics_plan(const CheckJob& job, const CheckInput& input);

/// What came of --measure, --rates, --kappa and --bngl.
struct KineticsReport {
  std::string text;
  std::string dir;                            ///< of rates and curves; "": nothing was written
  int diverged = 0;                           ///< worlds, which are left out
  std::shared_ptr<const DirectoryLock> lock;  ///< of `dir`, until the last file is written
};
/// Does what the options require. Throws InputError, Stopped.
KineticsReport run_kinetics(const CheckJob& job, const CheckInput& input, const Host& host);

}  // namespace lilytank::cli
