// All that an interrupted run needs to go on: state, counters, and how far its files count.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "lilytank/file_digest.hpp"
#include "lilytank/world.hpp"

namespace lilytank {

/// What the files that only grow hold.
struct RunFileDigests {
  FileDigest trajectory, events, metrics;
};

struct Checkpoint {
  bool finished = false;  ///< the run is over; nothing is left but to report
  RunStatus status = RunStatus::ok;
  Divergence divergence;  ///< of a diverged run
  RunFileDigests files;
  Tallies tallies;              ///< since the start of the run
  std::int64_t last_event = 0;  ///< step; kept where run.quiet_time is set, else 0
  std::string record;           ///< AssemblyRecord::to_text
  State state;
};

/// The checkpoint as bytes: readable lines, the record, the state's snapshot, a hash of it all.
std::string to_bytes(const Checkpoint& checkpoint, std::uint64_t identity);
/// Throws InputError if the bytes are damaged, of another version, or of another scenario.
Checkpoint checkpoint_from(const std::string& bytes, std::uint64_t identity,
                           const std::string& file);
/// The identity of the scenario that a whole checkpoint of this version is of; nothing for other
/// bytes.
std::optional<std::uint64_t> identity_in(const std::string& bytes);

}  // namespace lilytank
