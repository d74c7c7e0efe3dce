// An experiment simulated: what the camera would have recorded if the tank were the model.
//
// Everything that compares a model with recordings needs the same thing: recordings like those of
// the experiment (bodies, frames, rate, noise, begin) at other values of some parameters. Whatever
// is done to the recordings is then done to these as well, so that smoothing, noise and missing
// frames are the same on both sides and need no correction.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "lilytank/model.hpp"
#include "lilytank/model_parameter.hpp"
#include "lilytank/recording.hpp"
#include "lilytank/trajectory.hpp"

namespace lilytank {

/// Two bodies that a recording shows bonded.
struct BondedBodies {
  int a = 0, b = 0;    ///< of the bodies of a frame, a < b
  double seconds = 0;  ///< how long the bond is seen, in the whole recording
  bool parts = false;  ///< the two are seen apart after that
};

/// All bodies at one frame of a recording.
struct BodiesAt {
  /// Frame of the recording.
  int frame = 0;
  /// [bodies] In the tank's frame.
  std::vector<Pose> pose;
  /// [bodies] From local polynomials over the frames around.
  std::vector<Twist> twist;
  /// Bonds that stand at this frame, from the distances of faces; empty where latches are off.
  std::vector<BondedBodies> bonds;
};

/// What of a recording is imitated.
struct RecordingShape {
  /// Name of the recording.
  std::string name;
  /// Kind of the simulated bodies.
  BodyKind body = BodyKind::lily;
  /// Largest number of bodies seen in one frame: that many are simulated.
  int bodies = 0;
  /// Length of the recording, frames.
  int frames = 0;
  /// Frames per second.
  double rate = 30;
  /// Whether the simulated tracks have headings.
  bool headings = true;
  /// Whether the modules' latches are on.
  bool latches = false;
  /// Whether the modules' events are logged.
  bool logged = false;
  /// Share of the frames of a track in which its body was not seen.
  double missing = 0;
  /// Where worlds may begin: frames in which all bodies were seen, poses and twists by local
  /// polynomials. Empty: bodies start at random and settle.
  std::vector<BodiesAt> starts;
};
/// [frames] Number of bodies seen in each frame.
std::vector<int> seen_by_frame(const Recording& recording);
/// The shape of a recording of modules with this side, m (of balls any). It looks for `starts`
/// every `interval` seconds, from the first frame on.
RecordingShape shape_of(const Recording& recording, double side, double interval = 1);

/// Standard deviation of a position, m (Camera::position_noise).
inline const std::string kPositionNoise = "camera.position_noise";
/// Standard deviation of a heading, rad (Camera::heading_noise).
inline const std::string kHeadingNoise = "camera.heading_noise";
/// Radial distortion, 1/m^2 (Camera::lens).
inline const std::string kLens = "camera.lens";
/// rad: the camera leans towards +x and +y, from a height of 1 m; from h m it is h times as much.
inline const std::string kTiltX = "camera.tilt_x", kTiltY = "camera.tilt_y";
/// Whether a path begins with "camera.".
bool of_camera(const std::string& path);
/// A number that an emulator can vary: one of the camera's, or model_parameter(). Throws
/// InputError.
ParameterInfo emulator_parameter(const std::string& path);

/// The camera's numbers of those paths.
struct CameraNumbers {
  double position_noise = 0, heading_noise = 0, lens = 0, tilt_x = 0, tilt_y = 0;
};

/// Moves the bodies of a model in place of a World: poses over `seconds` after `settle` s from
/// initial_state(model, seed); nothing if they diverged.
using OtherEngine = std::function<std::optional<Trajectory>(const Model& model, double settle,
                                                            double seconds, std::uint64_t seed)>;

/// Settings of the simulations, apart from the parameters that vary.
struct EmulatorOptions {
  /// Draw the gusts' wrench on a module from its moments instead of point by point: three times
  /// faster, but the variance of some short displacements is 1 % off, which calibration can see.
  bool moment_matched = true;
  /// Simulated time before the first frame if bodies start at random, s.
  double settle = 20;
  /// Standard deviation of positions, m, unless kPositionNoise is among the parameters.
  double position_noise = 3e-4;
  /// Standard deviation of headings, rad, unless kHeadingNoise is among the parameters.
  double heading_noise = 0.01;
  /// If set, it moves the bodies of shapes without starts.
  OtherEngine engine;
};

class InitialAssemblies;

/// Simulates an experiment at any values of a list of parameters. Constant once made, so it may be
/// used by many threads at once.
class Emulator {
 public:
  /// `paths`: scenario paths (model_parameter.hpp) or the camera's. `model` holds everything else;
  /// the numbers of its bodies are those of each shape. Throws InputError.
  Emulator(Model model, std::vector<std::string> paths, std::vector<RecordingShape> shapes,
           const EmulatorOptions& options = {});

  /// In the order of the values that record() and piece() take.
  const std::vector<std::string>& paths() const { return paths_; }
  /// In the order of the recordings of record().
  const std::vector<RecordingShape>& shapes() const { return shapes_; }
  /// The model before values are set. Per-point gusts are moment-matched if the options say so.
  const Model& model() const { return model_; }

  /// The whole experiment: one recording a shape, begun where the recording began. Nothing if a
  /// world diverged. `field` replaces the model's flow. Throws InputError on values out of bounds.
  std::optional<std::vector<Recording>> record(
      std::span<const double> values, std::uint64_t seed,
      const std::shared_ptr<const FlowField>& field = nullptr) const;

  /// A piece of `seconds` from one of a shape's starts, which `replicate` chooses, and so the
  /// shape: replicates go round all shapes' starts in an order that the seed shuffles.
  std::optional<Recording> piece(std::span<const double> values, std::uint64_t seed,
                                 std::int64_t replicate, double seconds) const;

 private:
  using Parameter = std::variant<ModelParameter, double CameraNumbers::*>;
  static Parameter parameter(const std::string& path);
  struct Scene;  // a model and a camera at some values
  Scene scene(std::span<const double> values, const RecordingShape& shape,
              const std::shared_ptr<const FlowField>& field) const;
  std::optional<Recording> simulate(const Scene& scene, const RecordingShape& shape,
                                    const BodiesAt* start, double seconds,
                                    std::uint64_t seed) const;
  Model model_;
  std::vector<std::string> paths_;
  std::vector<Parameter> parameters_;  // of these paths
  std::vector<RecordingShape> shapes_;
  std::shared_ptr<const InitialAssemblies> assemblies_;  // empty: no recording shows bonds
  EmulatorOptions options_;
};

}  // namespace lilytank
