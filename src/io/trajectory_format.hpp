// What the two trajectory formats share.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "lilytank/trajectory.hpp"

namespace lilytank {

/// First bytes of a binary trajectory. All numbers in the file are little-endian.
constexpr std::string_view kTrajectoryMagic = "LTTRAJEC";
constexpr std::uint32_t kTrajectoryVersion = 2;
/// Bytes of the header: magic, version, bodies, modules, and the checksum of these.
constexpr std::size_t kTrajectoryHeader = 8 + 4 * 4;
/// Bytes of a frame's time, of each body (x, y, theta and markings), and of the frame's checksum.
constexpr std::size_t kFrameTime = 8, kFrameBody = 3 * 4 + 6, kFrameChecksum = 4;

/// The first line of a CSV trajectory, with and without markings.
inline const std::string kTrajectoryColumns =
    "frame,time,id,x,y,theta,label,last,latched,bonded,complete";
inline const std::string kPoseColumns = "frame,time,id,x,y,theta";

/// What module `module` of a world shows.
Markings markings_of(const World& world, int module, const std::vector<std::uint8_t>& complete);

/// Readers of either format from a file's content; `file` is for messages. A cut end is dropped.
Trajectory parse_binary_trajectory(std::string_view bytes, const std::string& file);
Trajectory parse_csv_trajectory(std::string_view text, const std::string& file);

/// Writers; see open_trajectory.
std::unique_ptr<TrajectoryWriter> open_binary_trajectory(const std::string& file,
                                                         const Model& model,
                                                         const FileDigest* keep);
std::unique_ptr<TrajectoryWriter> open_csv_trajectory(const std::string& file,
                                                      const FileDigest* keep);

}  // namespace lilytank
