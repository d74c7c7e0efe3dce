#include "study/search_store.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>

#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "io/file_digest.hpp"
#include "lilytank/state.hpp"
#include "text/fnv.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMagic = "lilytank search run 2";
constexpr double kBetweenCheckpoints = 2;  // s

std::string header_of(const std::vector<std::string>& axes) {
  std::string out = "batch,trial,replicate";
  for (const std::string& axis : axes) out += "," + axis;
  return out + ",value" + std::string(kChecksumColumn) + "\n";
}

/// A row up to its value.
std::string beginning(std::int64_t batch, std::int64_t number, const Trial& trial) {
  std::string out = std::to_string(batch) + "," + std::to_string(number) + "," +
                    std::to_string(trial.replicate) + ",";
  for (const double x : trial.point) out += shortest(x) + ",";
  return out;
}

/// The first two lines of a checkpoint.
std::string first_lines(std::uint64_t identity) {
  return std::string(kMagic) + "\nidentity " + hex(identity) + "\n";
}

/// The first three.
std::string head_of(std::uint64_t identity, std::int64_t batches, bool finished) {
  return first_lines(identity) + "batches " + std::to_string(batches) +
         (finished ? " finished\n" : " started\n");
}

std::uint64_t identity_of(const std::string& what, const Search& fresh) {
  Fnv hash;
  hash.add(what), hash.add(fresh.save());
  return hash.value();
}

}  // namespace

bool is_search_of(const std::string& state, const std::string& what, const Search& fresh) {
  return state.starts_with(first_lines(identity_of(what, fresh)));
}

SearchStore::SearchStore(const SearchRunOptions& options, const Search& fresh)
    : dir_(options.dir), identity_(identity_of(options.identity, fresh)) {
  for (const SearchAxis& axis : fresh.space()) axes_.push_back(axis.name);
  if (!options.locked) lock_.take(dir_);
  const bool begun = exists(path(search_file::state));
  const std::string state = begun ? read_whole(path(search_file::state)) : "";
  if (state.starts_with(first_lines(identity_))) {
    resume(state);
    return;
  }
  if (begun && !options.force) {
    throw InputError("'" + dir_ + "' holds another search" + kChooseAnother);
  }
  if (!begun && !options.force) {
    refuse_foreign(dir_, existing_in(dir_, {search_file::evaluations, search_file::history}),
                   "search");
  }
  clear();
  open(fresh);
}

std::string SearchStore::path(const char* name) const {
  return (fs::path(dir_) / name).string();
}

void SearchStore::clear() const {
  std::error_code ignored;
  // The checkpoint first: without it the others are nobody's.
  for (const char* name : {search_file::state, search_file::evaluations, search_file::history}) {
    fs::remove(path(name), ignored);
  }
}

/// The checkpoint comes first: it says which search the files belong to.
void SearchStore::open(const Search& fresh) {
  write_atomically(path(search_file::state),
                   with_checksum_line(head_of(identity_, 0, false) + fresh.save()));
  log_.emplace(path(search_file::evaluations), header_of(axes_), "");
  log_->flush();
}

void SearchStore::resume(const std::string& stored) {
  const std::string file = path(search_file::state);
  const std::string state(without_checksum_line(stored, file, "--force begins the search again"));
  std::istringstream in(state);
  std::string line, word, end;
  std::getline(in, line), std::getline(in, line);
  if (!(in >> word >> batch_ >> end) || word != "batches" || batch_ < 0 || in.get() != '\n') {
    throw InputError(SourcePlace{file, 3, 1}, "the checkpoint of the search is damaged");
  }
  finished_ = end == "finished";
  stored_ =
      restore_search(std::string_view(state).substr(static_cast<std::size_t>(in.tellg())), file);
  open_log();
  std::int64_t before = 0;
  for (const auto& [key, row] : rows_) before += key.first <= batch_ ? 1 : 0;
  if (before != stored_->evaluations()) refuse_changed("lacks values that the checkpoint knows");
}

void SearchStore::refuse_changed(const std::string& how) const {
  throw InputError("'" + path(search_file::evaluations) + "' " + how + ": it was changed");
}

void SearchStore::open_log() {
  const std::string file = path(search_file::evaluations);
  if (batch_ > 0 && !exists(file)) refuse_changed("is missing");
  const std::string text = RowLog::rows_in(file);
  // A kill may come before there is a row, but not after a batch.
  if (!text.empty() || batch_ > 0) read_rows_from(text, file);
  log_.emplace(file, header_of(axes_), text);
}

void SearchStore::read_rows_from(const std::string& text, const std::string& file) {
  const std::string header = header_of(axes_);
  CsvReader csv(text, file, {header.substr(0, header.size() - 1)});
  const auto most = std::numeric_limits<std::int64_t>::max();
  while (csv.next()) {
    const Key key{csv.whole(0, 1, most), csv.whole(1, 1, most)};
    std::string row;
    for (std::size_t c = 0; c < axes_.size() + 4; ++c) row.append(csv.text(c)).append(",");
    row.pop_back();
    if (csv.text(axes_.size() + 3) != "inf") static_cast<void>(csv.number(axes_.size() + 3));
    if (!rows_.emplace(key, row).second) csv.refuse(1, "this trial is there twice");
  }
}

std::vector<std::optional<double>> SearchStore::known(const std::vector<Trial>& trials) const {
  std::vector<std::optional<double>> out(trials.size());
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto number = static_cast<std::int64_t>(i) + 1;
    const auto found = rows_.find({batch_ + 1, number});
    if (found == rows_.end()) continue;
    const std::string start = beginning(batch_ + 1, number, trials[i]);
    if (!found->second.starts_with(start)) refuse_changed("holds trials of another search");
    const std::string value = found->second.substr(start.size());
    out[i] = parse_number(value).value_or(std::numeric_limits<double>::infinity());
  }
  return out;
}

void SearchStore::keep(std::size_t index, const Trial& trial, double value) {
  const auto number = static_cast<std::int64_t>(index) + 1;
  const std::string row = beginning(batch_ + 1, number, trial) +
                          (std::isfinite(value) ? shortest(value) : std::string("inf"));
  log_->append(row);
  const std::lock_guard hold(rows_lock_);
  rows_.emplace(Key{batch_ + 1, number}, row);
}

void SearchStore::completed(const Search& search) {
  ++batch_;
  if (since_saved_.due(kBetweenCheckpoints)) checkpoint(search);
}

void SearchStore::checkpoint(const Search& search) {
  if (finished_) return;
  log_->flush();
  write_atomically(path(search_file::history), history_text(search));
  write_atomically(path(search_file::state),
                   with_checksum_line(head_of(identity_, batch_, false) + search.save()));
}

void SearchStore::finish(const Search& search) {
  if (finished_) {  // what is missing or was changed is written again
    const std::string history = history_text(search);
    const std::string file = path(search_file::history);
    if (!exists(file) || read_whole(file) != history) write_atomically(file, history);
    return;
  }
  log_->flush();
  std::string text = header_of(axes_);
  for (const auto& [key, row] : rows_) text += with_checksum(row) + "\n";
  write_atomically(path(search_file::evaluations), text);
  write_atomically(path(search_file::history), history_text(search));
  write_atomically(path(search_file::state),
                   with_checksum_line(head_of(identity_, batch_, true) + search.save()));
  finished_ = true;
}

}  // namespace lilytank
