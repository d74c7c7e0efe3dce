#include "study/kept_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>

#include "io/file_digest.hpp"
#include "lilytank/state.hpp"
#include "lilytank/study.hpp"
#include "study/row_log.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

using Rows = std::vector<std::optional<std::vector<double>>>;

std::string head_of(const KeptRows& kept) {
  return "lilytank rows 2 " + hex(kept.identity) + "\n";
}

// What has no value (a lag that no track is long enough for) has none in the file either.
std::optional<double> number_of(std::string_view cell) {
  if (cell == "nan") return std::numeric_limits<double>::quiet_NaN();
  return parse_number(cell);
}

std::string line_of(int index, const std::vector<double>& row) {
  std::string line = std::to_string(index);
  for (const double v : row) line += "," + (std::isfinite(v) ? shortest(v) : "nan");
  return line;
}

// A line without its end; false if it is not a row.
bool take_line(std::string_view line, Rows& rows) {
  if (line.empty() || line.back() != ';') return false;
  const std::size_t sum = line.rfind(',');
  if (sum == std::string_view::npos ||
      line.substr(sum + 1) != checksum(line.substr(0, sum)) + ";") {
    return false;
  }
  line = line.substr(0, sum);
  std::vector<double> row;
  std::optional<std::int64_t> index;
  for (bool first = true;; first = false) {
    const auto comma = line.find(',');
    const std::string_view cell = line.substr(0, comma);
    if (first) {
      index = parse_whole(cell);
      if (!index || *index < 0) return false;
    } else {
      const auto value = number_of(cell);
      if (!value) return false;
      row.push_back(*value);
    }
    if (comma == std::string_view::npos) break;
    line.remove_prefix(comma + 1);
  }
  // More rows than are wanted now may be there: from a call for more rows.
  if (*index < static_cast<std::int64_t>(rows.size())) rows[static_cast<std::size_t>(*index)] = row;
  return true;
}

void read_rows(const std::string& file, const std::string& head, std::string_view text,
               Rows& rows) {
  if (text.empty()) return;
  if (!text.starts_with(head)) {
    throw InputError({file, 1, 1}, "these rows are of another calculation");
  }
  std::size_t at = head.size();
  for (int line = 2; at < text.size(); ++line) {
    const auto end = text.find('\n', at);
    if (!take_line(text.substr(at, end - at), rows)) {
      throw InputError({file, line, 1},
                       "the row was changed since it was written (its checksum does not "
                       "fit); remove the file to have its rows computed again");
    }
    at = end + 1;
  }
}

// The rows of a set so far, and the log that further ones are added to.
struct OpenRows {
  Rows rows;
  std::unique_ptr<RowLog> log;
};

OpenRows opened(const KeptRows& kept, const RowSet& set) {
  OpenRows out{Rows(static_cast<std::size_t>(set.count)), nullptr};
  if (set.file.empty()) return out;
  const std::string head = head_of(kept), before = RowLog::rows_in(set.file);
  read_rows(set.file, head, before, out.rows);
  out.log = std::make_unique<RowLog>(set.file, head, before, ";\n");
  return out;
}

// A row of a set, each by its number.
using Place = std::pair<std::size_t, int>;

std::vector<Place> missing_in(const std::vector<OpenRows>& sets) {
  std::vector<Place> out;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    for (std::size_t i = 0; i < sets[s].rows.size(); ++i) {
      if (!sets[s].rows[i]) out.emplace_back(s, static_cast<int>(i));
    }
  }
  return out;
}

}  // namespace

std::vector<std::vector<double>> kept_rows(const KeptRows& kept, int count,
                                           const std::function<std::vector<double>(int)>& work) {
  return std::move(kept_row_sets(kept, {{kept.file, count, work}}).front());
}

std::vector<std::vector<std::vector<double>>> kept_row_sets(const KeptRows& kept,
                                                            const std::vector<RowSet>& sets) {
  std::vector<OpenRows> open;
  int count = 0;
  for (const RowSet& set : sets) open.push_back(opened(kept, set)), count += set.count;
  const std::vector<Place> missing = missing_in(open);
  int done = count - static_cast<int>(missing.size());
  const auto report = [&] {
    kept.report(static_cast<double>(done) / std::max(1, count),
                std::to_string(done) + " of " + std::to_string(count));
  };
  report();
  std::mutex one_at_a_time;
  const auto one = [&](int k) {
    const auto& [set, index] = missing[static_cast<std::size_t>(k)];
    std::vector<double> row = sets[set].work(index);
    for (double& v : row) v = std::isfinite(v) ? v : std::numeric_limits<double>::quiet_NaN();
    if (open[set].log) open[set].log->append(line_of(index, row));
    const std::lock_guard lock(one_at_a_time);
    open[set].rows[static_cast<std::size_t>(index)] = std::move(row);
    ++done;
    report();
  };
  for_each_world(static_cast<int>(missing.size()), kept.threads, one, kept);
  for (const OpenRows& of : open) {
    if (of.log) of.log->flush();
  }
  kept.check_stop();  // also where all rows were kept: what is made of them may take minutes
  std::vector<std::vector<std::vector<double>>> out(sets.size());
  for (std::size_t s = 0; s < sets.size(); ++s) {
    for (auto& row : open[s].rows) out[s].push_back(std::move(*row));
  }
  return out;
}

}  // namespace lilytank
