// A calibration before anything is looked for: data, flow, emulators, what is compared.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lilytank/calibration.hpp"
#include "lilytank/response_surface.hpp"
#include "text/fnv.hpp"

namespace lilytank {

/// What depends on the experiment and the options alone.
struct CalibrationSetup {
  CalibrationOptions options;
  std::string name;
  Model model;  ///< with the flow that was found, at the scenario's values
  BodyKind body = BodyKind::lily;
  std::vector<Recording> training, held_out;
  std::vector<RecordingShape> shapes, held_out_shapes;
  std::vector<FitParameter> parameters;  ///< nuisances at the end
  std::vector<double> start;             ///< their first values
  MotionSummary summary;
  double piece = 60;  ///< s, of Eq. 9 and of the search's simulations
  std::optional<FlowEstimate> flow;
  BallPhysics ball;
  std::vector<Recording> balls;
  std::uint64_t identity = 0;  ///< of data, model and every option that a result depends on

  std::vector<std::string> paths() const;
  std::size_t reported_count() const;  ///< parameters without nuisances
  /// The flow is the balls', with an error that can be drawn.
  bool draws_flow() const;
  /// The objective is CalibrationObjective::prediction.
  bool predicted() const;
  /// Of response surfaces of what the objective compares.
  Slopes slopes() const { return predicted() ? Slopes::straightened : Slopes::found; }
  /// Where parameters are sought, as a prior: with the mean and variance of a uniform one, on the
  /// fitted scale.
  Prior prior() const;
  /// Motion summaries are among what is compared.
  bool summarised() const;
  /// The estimate is the one among those that numbers allow that moves modules most alike.
  bool chosen_by_displacements() const;
  /// Of pieces, which must be fast, or of whole experiments, which must be right: their gusts are
  /// drawn point by point.
  enum class Of { experiments, pieces };
  Emulator emulator(const std::vector<RecordingShape>& shapes_of, Of of = Of::pieces) const;

  /// The model at values of the parameters, of which those of nuisances are not the model's.
  Model model_at(const std::vector<double>& values) const;

  /// What the objective compares, of recordings of the experiment's whole length; its summary if
  /// that is predictions, which a filter makes.
  std::vector<double> numbers(const std::vector<Recording>& recordings) const;
  /// Eq. 9's MSD at coarse lags, m^2: what the displacement objectives compare.
  std::vector<double> displacements(const std::vector<Recording>& recordings) const;
  std::vector<SummaryEntry> entries() const;
  /// A warning for each recording of self-assembly that simulations cannot begin like.
  std::vector<std::string> warnings_of_begin() const;
  /// The extracted flow without its mean error, as a grid that a run reads; empty where the
  /// scenario's flow is used.
  std::string corrected_csv(const FlowField& best) const;
};

/// Estimates the flow; reads no file beside the experiment. Throws InputError.
CalibrationSetup set_up(const Experiment& experiment, const CalibrationOptions& options);

/// The largest number of bodies of a recording.
int most_bodies(const std::vector<RecordingShape>& shapes);

/// Adds the recordings to the hash of an identity.
void add_recordings(const std::vector<Recording>& recordings, Fnv& hash);

/// Recordings cut into pieces of `seconds`, a shorter remainder is dropped; headings and ids kept.
std::vector<Recording> pieces_of(const std::vector<Recording>& recordings, double seconds);

}  // namespace lilytank
