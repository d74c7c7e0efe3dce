// Poses over time, simulated or recorded: the same type, the same files, the same analysis.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lilytank/error.hpp"
#include "lilytank/file_digest.hpp"
#include "lilytank/world.hpp"

namespace lilytank {

/// State of a module beside its pose, as a frame stores it.
struct Markings {
  std::int16_t label = 0;     ///< control state l_a
  std::int8_t last = -1;      ///< connector engaged last, l_n; -1: isolated
  std::uint8_t latched = 0;   ///< Bit f: face f holds a neighbour
  std::uint8_t bonded = 0;    ///< Bit f: face f holds a neighbour by a rule
  std::uint8_t complete = 0;  ///< 1: the module is part of a standing copy of the target
};

/// Poses of `bodies` bodies at `time.size()` instants, frame by frame: pose of body b in frame f is
/// at f * bodies + b. Lengths in m, angles in rad, times in s, rising.
struct Trajectory {
  int bodies = 0;                  ///< bodies in every frame
  int modules = 0;                 ///< bodies [0, modules) are squares, the rest balls
  std::vector<double> time;        ///< [frames] s, ascending
  std::vector<float> x, y, theta;  ///< [frames * bodies] m, m and rad
  /// [frames * bodies] Default for balls; empty for poses without states.
  std::vector<Markings> markings;
  /// Number of frames.
  int frames() const { return static_cast<int>(time.size()); }
};

/// Appends a world's present poses and time to a trajectory in memory (no markings); `trajectory`
/// takes its numbers of bodies from the first world.
void append_poses(const World& world, Trajectory& trajectory);

/// none: poses are not stored.
enum class TrajectoryFormat { none, csv, binary };

/// Appends frames to a file as they come; what was written survives a kill.
class TrajectoryWriter {
 public:
  virtual ~TrajectoryWriter() = default;
  /// Appends the bodies' present poses. `complete`: one flag a module.
  virtual void write(const World& world, const std::vector<std::uint8_t>& complete) = 0;
  /// Hands everything to the disk; returns what the file now holds.
  virtual FileDigest flush() = 0;
};

/// CSV: `frame,time,id,x,y,theta,label,last,latched,bonded,complete`, SI, angle in (-pi, pi]; cells
/// from `label` on are empty for balls, and a table of poses alone may leave those columns out.
/// Binary: a header (magic, version, bodies, modules, checksum) and fixed-size frames (time as
/// float64, poses as float32, markings, checksum), about a third of the CSV; a cut last frame is
/// dropped on reading. `keep` goes on in an existing file that begins with these bytes. Throws
/// InputError if it does not.
std::unique_ptr<TrajectoryWriter> open_trajectory(const std::string& file, TrajectoryFormat format,
                                                  const Model& model,
                                                  const FileDigest* keep = nullptr);
/// Reads either format, recognised by its first bytes. Throws InputError with file and line, or
/// with the byte at which a frame begins that was changed.
Trajectory read_trajectory(const std::string& file);

}  // namespace lilytank
