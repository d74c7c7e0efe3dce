// The part of `lilytank check` that counts rates in worlds and runs the well-mixed model on them.
#pragma once
#include <optional>
#include <string>

#include "cli/options.hpp"
#include "lilytank/kinetics.hpp"

namespace lilytank::cli {

/// Options --measure, --rates, --gillespie, --kappa, --bngl and what belongs to them.
void add_kinetics_options(VerbOptions& options);
/// Refuses those that would have no effect or overwrite what is read, before any work is done.
void check_kinetics_options(const VerbOptions& options);
/// Reads what they name, before any work is done: the rates of --rates, or nothing. Throws
/// InputError for files that cannot be used, those of --measure included.
std::optional<RateTable> kinetics_input(const VerbOptions& options, const Ruleset& rules,
                                        int modules);
/// Does what they ask for, on the `rates` that were read or those that it measures; the text for
/// the report, or nothing if a signal stopped it. Throws InputError.
std::optional<std::string> run_kinetics(const VerbOptions& options, const Ruleset& rules,
                                        int modules, std::optional<RateTable> rates);

}  // namespace lilytank::cli
