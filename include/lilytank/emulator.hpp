// An experiment simulated: what the camera would have recorded if the tank were the model.
//
// Everything that compares a model with recordings needs the same thing: recordings like those of
// the experiment (bodies, frames, rate, noise, begin) at other values of some parameters. Whatever
// is done to the recordings is then done to these as well, so that smoothing, noise and missing
// frames are the same on both sides and need no correction.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lilytank/model.hpp"
#include "lilytank/model_parameter.hpp"
#include "lilytank/recording.hpp"

namespace lilytank {

/// All bodies at one frame of a recording.
struct BodiesAt {
  int frame = 0;
  std::vector<Pose> pose;
  std::vector<Twist> twist;
};

/// What of a recording is imitated.
struct RecordingShape {
  std::string name;
  BodyKind body = BodyKind::lily;
  int bodies = 0;  ///< most that were seen in one frame
  int frames = 0;
  double rate = 30;  ///< frames per second
  bool headings = true;
  bool latches = false;
  double missing = 0;  ///< share of the frames of a track in which its body was not seen
  /// Where worlds may begin: frames in which all bodies were seen, poses and twists by local
  /// polynomials. Empty: bodies start at random and settle.
  std::vector<BodiesAt> starts;
};
/// Bodies seen in each frame.
std::vector<int> seen_by_frame(const Recording& recording);
/// `starts` are looked for every `interval` seconds, the first frame first.
RecordingShape shape_of(const Recording& recording, double interval = 1);

/// Paths of the camera, which may be varied beside those of the model.
inline const std::string kPositionNoise = "camera.position_noise";  ///< m
inline const std::string kHeadingNoise = "camera.heading_noise";    ///< rad
inline const std::string kLens = "camera.lens";                     ///< 1/m^2, Camera::lens
/// rad: the camera leans towards +x and +y, from a height of 1 m; from h m it is h times as much.
inline const std::string kTiltX = "camera.tilt_x", kTiltY = "camera.tilt_y";
/// Whether a path is the camera's.
bool of_camera(const std::string& path);
/// A number that an emulator can vary: one of the camera's, or model_parameter(). Throws
/// InputError.
ModelParameter emulator_parameter(const std::string& path);

struct EmulatorOptions {
  /// Draw the gusts' wrench on a module from its moments instead of point by point: three times
  /// faster, but the variance of some short displacements is 1 % off, which calibration can see.
  bool moment_matched = true;
  double settle = 20;            ///< s before the first frame, where bodies start at random
  double position_noise = 3e-4;  ///< m, unless it is a parameter
  double heading_noise = 0.01;   ///< rad, likewise
};

/// Simulates an experiment at any values of a list of parameters. Constant once made, so it may be
/// used by many threads at once.
class Emulator {
 public:
  /// `paths`: scenario paths (model_parameter.hpp) or the camera's. `model` holds everything else;
  /// the numbers of its bodies are those of each shape. Throws InputError.
  Emulator(Model model, std::vector<std::string> paths, std::vector<RecordingShape> shapes,
           const EmulatorOptions& options = {});

  const std::vector<std::string>& paths() const { return paths_; }
  const std::vector<RecordingShape>& shapes() const { return shapes_; }
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
  struct Scene;  // a model and a camera at some values
  Scene scene(std::span<const double> values, const RecordingShape& shape,
              const std::shared_ptr<const FlowField>& field) const;
  std::optional<Recording> simulate(const Scene& scene, const RecordingShape& shape,
                                    const BodiesAt* start, double seconds,
                                    std::uint64_t seed) const;
  Model model_;
  std::vector<std::string> paths_;
  std::vector<RecordingShape> shapes_;
  EmulatorOptions options_;
};

}  // namespace lilytank
