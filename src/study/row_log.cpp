#include "study/row_log.hpp"

#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "io/file_digest.hpp"
#include "jobs/job_directory.hpp"

namespace lilytank {
namespace {
constexpr double kBetweenSyncs = 0.5;  // s
}  // namespace

std::string RowLog::rows_in(const std::string& file) {
  return exists(file) ? std::string(whole_lines(read_whole(file))) : "";
}

RowLog::RowLog(const std::string& file, const std::string& head, std::string_view before,
               std::string row_end)
    : file_(file, before.empty() ? -1 : static_cast<std::int64_t>(before.size())),
      row_end_(std::move(row_end)) {
  if (before.empty()) file_.append(head);
}

void RowLog::append(const std::string& row) {
  const std::lock_guard hold(lock_);
  file_.append(with_checksum(row) + row_end_);
  watch_.due(kBetweenSyncs) ? static_cast<void>(file_.flush()) : file_.hand_over();
}

void RowLog::flush() {
  const std::lock_guard hold(lock_);
  file_.flush();
}

}  // namespace lilytank
