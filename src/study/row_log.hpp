// Rows of finished work in a file that only grows: of studies, searches, calibrations, diagnoses
// and benchmarks.
#pragma once
#include <mutex>
#include <string>
#include <string_view>

#include "io/append_file.hpp"
#include "jobs/stop_watch.hpp"

namespace lilytank {

class RowLog {
 public:
  /// What `file` holds up to its last whole row: whatever a kill has cut off is computed again.
  /// Empty if there is no file. Throws InputError.
  static std::string rows_in(const std::string& file);

  /// Begins a file with `head`, its first line, or goes on behind `before`, which rows_in()
  /// returned and which may be empty. `row_end` follows each row's checksum. Throws InputError.
  RowLog(const std::string& file, const std::string& head, std::string_view before,
         std::string row_end = "\n");

  /// Adds a row and its checksum, from any thread. A kill of the program does not lose it: it is
  /// the system's on return, and on the disk if half a second has passed since that was last so.
  /// Throws InputError if it cannot be written.
  void append(const std::string& row);
  /// All rows are on the disk on return. Throws InputError.
  void flush();

 private:
  AppendFile file_;
  std::string row_end_;
  StopWatch watch_;
  std::mutex lock_;
};

}  // namespace lilytank
