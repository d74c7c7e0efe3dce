// events.csv of a run: its columns, and its rows read back.
#pragma once
#include <string>
#include <vector>

#include "lilytank/error.hpp"

namespace lilytank {

/// First line of events.csv.
inline const std::string kEventColumns =
    "time,step,kind,module_a,face_a,module_b,face_b,rule,label_a,last_a,label_b,last_b,copies";

/// Words of the kinds in events.csv: those of EventKind in its order, then "copy".
const std::vector<std::string>& event_words();
/// Index of "copy": the number of completed copies changed.
inline constexpr int kCopyEvent = 7;

/// A row of events.csv (docs/run.md). Fields that do not apply to its kind are -1 or empty.
struct StoredEvent {
  double time = 0;                 ///< s, end of the step
  int kind = 0;                    ///< index into event_words()
  int a = -1, b = -1;              ///< modules
  int face_a = -1, face_b = -1;    ///< their connectors
  std::string rule;                ///< rule or command
  int label_a = -1, label_b = -1;  ///< control states after the event
  int last_a = -1, last_b = -1;    ///< connectors engaged last, after the event
  int copies = -1;                 ///< completed copies, of the kind "copy"
};

/// Reads the rows of a run of `modules` modules from the file's content; row i is line i + 2. A cut
/// last row is dropped. Throws InputError with file, line and column.
std::vector<StoredEvent> read_events(const std::string& text, const std::string& file, int modules);

}  // namespace lilytank
