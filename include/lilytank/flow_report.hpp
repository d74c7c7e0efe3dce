// The results of `lilytank flow`: estimates side by side, their errors where the truth is known,
// and their biases measured on synthetic recordings.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lilytank/coverage.hpp"
#include "lilytank/flow_estimate.hpp"
#include "lilytank/report.hpp"

namespace lilytank {

/// What was switched off or changed in synthetic recordings, and how far estimates then are from
/// the field that was simulated.
struct FlowBiasRow {
  std::string what;       ///< "as recorded", "no tracking noise", ...
  std::string estimator;  ///< "paper" or "smooth"
  FlowError error;        ///< over the measured cells
  std::string missing;    ///< why there is no error, as too little data; empty: there is one
};

/// What `lilytank flow` writes.
struct FlowReport {
  std::string name;
  BallPhysics ball;
  FlowOptions options;
  std::vector<FlowEstimate> estimates;  ///< in the order of the report; their names differ
  /// Of the last estimate where the experiment's Lilies went; empty: it has none.
  std::optional<Coverage> coverage;
  /// Known field to compare with, and the file that it was read from.
  std::optional<FlowTruth> truth;
  std::string truth_file;
  std::vector<FlowBiasRow> bias;  ///< empty if biases were not measured
};

/// Simulates recordings like those given (bodies, frames, rate) in the flow of a smooth estimate,
/// with its noise budget, and extracts the flow from them again: as recorded, and with one cause of
/// error after the other left out. The truth of each row is the simulated field. Recordings that
/// are too short for an estimate leave its row without an error. `progress` is called with the
/// share done. Throws InputError if the estimate has no noise budget.
std::vector<FlowBiasRow> measure_flow_bias(std::span<const Recording> recordings,
                                           const FlowEstimate& smooth, const BallPhysics& ball,
                                           const FlowOptions& options, std::uint64_t seed,
                                           const std::function<void(double)>& progress = {});

/// Number of the grid's cells whose centres lie in the tank.
int cells_in_tank(const FlowEstimate& estimate);
/// The report as a document, with a warning where less than a fifth of the tank's cells were
/// measured. Provenance is the caller's. Takes one estimate or more.
ReportDocument flow_report(const FlowReport& report);
/// Names of all files that a report of any flow may leave in its directory.
std::vector<std::string> flow_files();
/// Writes into a directory, made if absent: flow_<estimator>.csv (the grid that a run reads),
/// cells_<estimator>.csv, balls_<estimator>.toml (an overlay for scenarios that simulates these
/// balls in that flow), errors_<estimator>.csv where there is a truth, bias.csv, and the
/// document as flow.txt and flow.json. Throws InputError.
void write_flow(const FlowReport& report, const ReportDocument& document, const std::string& dir);

}  // namespace lilytank
