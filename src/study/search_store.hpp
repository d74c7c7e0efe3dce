// Output directory of a search: ownership, a checkpoint, and every value.
//
// A value is logged as soon as it is there; the checkpoint only spares replaying the search from
// its start. It is never ahead of the log, so whatever is lost in a kill is evaluated again.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "jobs/job_directory.hpp"
#include "jobs/stop_watch.hpp"
#include "lilytank/search_run.hpp"
#include "study/row_log.hpp"

namespace lilytank {

namespace search_file {
inline constexpr const char* state = "search.state";
inline constexpr const char* evaluations = "evaluations.csv";
inline constexpr const char* history = "history.csv";
}  // namespace search_file

/// Whether the text of a checkpoint is of the search that begins as `fresh`. `what`: names it
/// beside its own options.
bool is_search_of(const std::string& state, const std::string& what, const Search& fresh);

class SearchStore {
 public:
  /// Locks the directory unless `options.locked`. Throws InputError if the directory is in use, or,
  /// unless `options.force`, holds another search or damaged files.
  SearchStore(const SearchRunOptions& options, const Search& fresh);

  /// The stored search, if there is one.
  std::unique_ptr<Search> stored() { return std::move(stored_); }
  /// The values of a batch that are there. Throws InputError if the log tells of other trials.
  std::vector<std::optional<double>> known(const std::vector<Trial>& trials) const;
  /// Logs a value of the batch, from any thread.
  void keep(std::size_t index, const Trial& trial, double value);
  /// Records a complete batch that the search has received; writes a checkpoint from time to time.
  void completed(const Search& search);
  /// Checkpoint and history now.
  void checkpoint(const Search& search);
  /// Checkpoint and history after the last batch, and the log in the order of the trials.
  void finish(const Search& search);

 private:
  using Key = std::pair<std::int64_t, std::int64_t>;  ///< batch and trial, from 1

  std::string path(const char* name) const;
  void open(const Search& fresh);
  void resume(const std::string& state);
  void open_log();
  void read_rows_from(const std::string& text, const std::string& file);
  void clear() const;
  [[noreturn]] void refuse_changed(const std::string& how) const;

  std::string dir_;
  std::uint64_t identity_;
  std::vector<std::string> axes_;
  DirectoryLock lock_;
  std::unique_ptr<Search> stored_;
  std::int64_t batch_ = 0;  ///< complete ones
  bool finished_ = false;   ///< as stored
  std::map<Key, std::string> rows_;
  std::mutex rows_lock_;
  std::optional<RowLog> log_;
  StopWatch since_saved_;
};

}  // namespace lilytank
