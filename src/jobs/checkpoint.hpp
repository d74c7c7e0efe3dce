// All that an interrupted run needs to go on: state, counters, and how far its files count.
#pragma once
#include <cstdint>
#include <string>

#include "lilytank/world.hpp"

namespace lilytank {

/// Lengths in bytes of the files that only grow.
struct FileLengths {
  std::int64_t trajectory = 0, events = 0, metrics = 0;
};

struct Checkpoint {
  bool finished = false;  ///< the run is over; nothing is left but to report
  RunStatus status = RunStatus::ok;
  Divergence divergence;  ///< of a diverged run
  FileLengths lengths;
  Tallies tallies;     ///< since the start of the run
  std::string record;  ///< AssemblyRecord::to_text
  State state;
};

/// The checkpoint as bytes: readable lines, the record, the state's snapshot, a hash of it all.
std::string to_bytes(const Checkpoint& checkpoint, std::uint64_t identity);
/// Throws InputError if the bytes are damaged, of another version, or of another scenario.
Checkpoint checkpoint_from(const std::string& bytes, std::uint64_t identity,
                           const std::string& file);

}  // namespace lilytank
