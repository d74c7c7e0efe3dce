// The modules' radio log beside a recording: when which pair latched, linked and parted.
#pragma once
#include <string>
#include <vector>

#include "lilytank/recording.hpp"

namespace lilytank {

/// Columns of a log that holds no more than is needed; events.csv of a run is read as well.
inline const std::string kLogColumns = "time,kind,module_a,module_b";

/// Reads the events of two modules from a log; rows of other kinds are passed over. Times are those
/// of the recording's clock. Throws InputError with file, line and column: malformed, a module with
/// itself, times that go back.
std::vector<LoggedEvent> read_event_log(const std::string& file);

}  // namespace lilytank
