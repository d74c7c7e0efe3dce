// What a finished run reports: tables of rules and species, a summary to read and one to parse.
// Nothing in them depends on the clock or the machine.
#pragma once
#include <string>

#include "lilytank/assembly_record.hpp"
#include "lilytank/scenario.hpp"

namespace lilytank {

/// A run at its end.
struct Outcome {
  RunStatus status = RunStatus::ok;
  Divergence divergence;
  Tallies tallies;
};

/// rules.csv: ruleset, rule, kind, p, firings.
std::string rules_table(const Model& model, const AssemblyRecord& record);
/// species.csv: every kind of assembly seen, and how many stand at the end.
std::string species_table(const AssemblyRecord& record);
/// A few lines for people; the last one is "fingerprint 0123456789abcdef".
std::string summary_text(const Scenario& scenario, const World& world, const AssemblyRecord& record,
                         const Outcome& outcome);
/// The same as JSON.
std::string summary_json(const Scenario& scenario, const World& world, const AssemblyRecord& record,
                         const Outcome& outcome);

/// "diverged at 1.2 s (step 48): module 3, largest force face_drag, 12 N".
std::string divergence_text(const Divergence& divergence, const Model& model);

}  // namespace lilytank
