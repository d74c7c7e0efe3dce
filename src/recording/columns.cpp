#include "recording/columns.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "io/table.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

/// Where the columns are; -1: there is none.
struct Columns {
  int frame = -1, time = -1, id = -1, x = -1, y = -1, theta = -1, missing = -1;
};

/// The names that a format gives its columns, most wanted first.
struct Naming {
  std::vector<std::string> frame, time, id, x, y, theta, missing;
};

Naming naming_of(RecordingFormat format) {
  using enum RecordingFormat;
  switch (format) {
    case trackpy:
      return {{"frame"}, {}, {"particle"}, {"x"}, {"y"}, {}, {}};
    case idtracker:
      return {{"frame"}, {"time", "seconds"}, {"individual"}, {"x"}, {"y"}, {}, {}};
    case fasttrack:
      return {{"imageNumber"}, {}, {"id"}, {"xBody"}, {"yBody"}, {"tBody"}, {}};
    case swistrack_tracks:
      return {{"Frame number"}, {}, {}, {"x"}, {"y"}, {}, {}};
    case swistrack_particles:
      return {{"Frame number"}, {"Time"}, {}, {"X (world)"}, {"Y (world)"}, {}, {}};
    case trex:
      return {
          {"frame"},
          {"time", "time (s)"},
          {},
          {"X#wcentroid (cm)", "X#wcentroid", "X (cm)", "X", "X#pcentroid (cm)", "X#centroid (cm)"},
          {"Y#wcentroid (cm)", "Y#wcentroid", "Y (cm)", "Y", "Y#pcentroid (cm)", "Y#centroid (cm)"},
          {"ANGLE", "ANGLE (rad)", "ANGLE#wcentroid"},
          {"missing"}};
    default:
      return {{"frame"}, {"time"}, {"id"}, {"x"}, {"y"}, {"theta"}, {}};
  }
}

/// Numbers beyond this are no lengths, times or angles, and would overflow later.
constexpr double kLargest = 1e12;

double bounded(const Table& table, int column) {
  const double value = table.number(column);
  if (std::fabs(value) > kLargest) table.refuse(column, table.quoted(column) + " is too large");
  return value;
}

std::string names_text(const std::vector<std::string>& names) {
  const std::string list = joined(names, ", ");
  return list.size() > 200 ? list.substr(0, 200) + ", ..." : list;
}

/// The column that differs by large and small letters alone, or the nearest word.
std::string nearest(const std::string& wanted, const Table& table) {
  for (const std::string& name : table.names()) {
    if (in_small_letters(name) != in_small_letters(wanted)) continue;
    return " - did you mean '" + name + "'?";
  }
  return did_you_mean(wanted, table.names());
}

/// `called`: what the column may be called; the user's one name, or all of the format's.
[[noreturn]] void refuse_missing(const Table& table, const std::vector<std::string>& called) {
  std::string near;
  for (const std::string& name : called) {
    if (near.empty()) near = nearest(name, table);
  }
  std::string wanted = "'" + called.front() + "'";
  for (std::size_t i = 1; i < called.size(); ++i) wanted += " or '" + called[i] + "'";
  throw InputError({table.file(), 1, 1}, "there is no column " + wanted + near + "; there are " +
                                             names_text(table.names()));
}

/// Reads the rows of one table.
class ColumnReader {
 public:
  ColumnReader(Table& table, const RecordingOptions& options, Sightings& out)
      : table_(&table), time_unit_(options.time_unit), out_(&out) {
    const Naming names = naming_of(out.format);
    const ColumnNames& own = options.columns;
    at_.frame = find(own.frame, names.frame), at_.time = find(own.time, names.time);
    at_.id = find(own.id, names.id), at_.theta = find(own.theta, names.theta);
    at_.x = needed(own.x, names.x), at_.y = needed(own.y, names.y);
    at_.missing = find("", names.missing);
    if (options.body != BodyKind::lily) at_.theta = -1;  // balls do not turn
    if (at_.frame < 0 && at_.time < 0) {
      throw InputError({table.file(), 1, 1}, "there is neither a column of frames nor of times");
    }
    out.headings = at_.theta >= 0;
    list_unused();
  }

  /// `id`: of all rows, if the file is one track.
  void read(std::optional<std::int64_t> id) {
    file_ = static_cast<std::int32_t>(out_->files.size() - 1);
    if (!id && at_.id < 0) out_->identities = false;
    while (table_->next()) row(id);
  }

 private:
  /// "-": the user wants none.
  int find(const std::string& own, const std::vector<std::string>& names) const {
    if (own == "-") return -1;
    if (!own.empty()) {
      const int found = table_->find(own);
      if (found < 0) refuse_missing(*table_, {own});
      return found;
    }
    for (const std::string& name : names) {
      if (const int found = table_->find(name); found >= 0) return found;
    }
    return -1;
  }

  int needed(const std::string& own, const std::vector<std::string>& names) const {
    const int found = find(own, names);
    if (found < 0) refuse_missing(*table_, own.empty() ? names : std::vector{own});
    return found;
  }

  void list_unused() {
    out_->unused.clear();
    const auto& names = table_->names();
    for (int c = 0; c < static_cast<int>(names.size()); ++c) {
      const auto used = {at_.frame, at_.time, at_.id, at_.x, at_.y, at_.theta, at_.missing};
      const std::string& name = names[static_cast<std::size_t>(c)];
      if (std::find(used.begin(), used.end(), c) == used.end() && !name.empty()) {
        out_->unused.push_back(name);
      }
    }
  }

  void row(std::optional<std::int64_t> id) {
    Sighting s;
    s.line = table_->line(), s.file = file_;
    if (at_.frame >= 0) s.frame = whole(at_.frame);
    if (at_.time >= 0) s.time = time_of(*table_, at_.time, out_->times, time_unit_);
    if (id) s.id = *id;
    s.x = bounded(*table_, at_.x), s.y = bounded(*table_, at_.y);
    if (at_.theta >= 0) s.theta = bounded(*table_, at_.theta);
    const bool missing = at_.missing >= 0 && table_->number(at_.missing) != 0;
    const bool nowhere = std::isnan(s.x) || std::isnan(s.y);
    if (missing || nowhere) return;  // a gap, which is looked for later
    if (!id && at_.id >= 0) s.id = identity();
    out_->add(s);
  }

  std::int64_t whole(int column) const {
    const auto value = table_->whole(column);
    if (!value) table_->refuse(column, table_->quoted(column) + " is not a whole number");
    return *value;
  }

  // Ids are whole numbers, or words that are numbered as they come.
  std::int64_t identity() {
    const auto number = table_->whole(at_.id);
    const bool first = out_->rows.empty() && out_->names.empty();
    if (number && (first || out_->names.empty())) return *number;
    const std::string word(table_->cell(at_.id));
    if (word.empty() || (!first && out_->names.empty())) {
      table_->refuse(at_.id, table_->quoted(at_.id) + " is not a whole number as the others are");
    }
    const auto [found, added] =
        out_->words.emplace(word, static_cast<std::int64_t>(out_->names.size()));
    if (added) out_->names.push_back(word);
    return found->second;
  }

  Table* table_;
  std::optional<double> time_unit_;
  Sightings* out_;
  Columns at_;
  std::int32_t file_ = 0;
};

/// The last number in a file's name: "video_id12.csv" is track 12.
std::int64_t track_of(const std::string& file) {
  const std::string name = file.substr(file.find_last_of('/') + 1);
  const auto last = name.find_last_of("0123456789", name.rfind(".csv"));
  if (last == std::string::npos) {
    throw InputError({file, 0, 0}, "the file's name has no number that tells the track");
  }
  const auto before = name.find_last_not_of("0123456789", last);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  const auto id = parse_whole(name.substr(begin, last + 1 - begin));
  if (!id) throw InputError({file, 0, 0}, "the number in the file's name is too large");
  return *id;
}

FormatUnits units_of(RecordingFormat format) {
  using enum RecordingFormat;
  switch (format) {
    case trackpy:
    case idtracker:
    case idtracker_wide:
      return {0, true, true};
    case fasttrack:
      return {0, true, false};  // angles are counter-clockwise as seen
    case trex:
      return {0.01, true, true};
    default:
      return {};
  }
}

/// A body's columns in a wide table.
struct WideBody {
  std::int64_t id;
  int x, y;
};

std::vector<WideBody> wide_bodies(const Table& table) {
  std::vector<WideBody> bodies;
  for (const std::string& name : table.names()) {
    const auto id = name.starts_with('x') ? parse_whole(name.substr(1)) : std::nullopt;
    if (!id) continue;
    bodies.push_back({*id, table.find(name), table.find("y" + name.substr(1))});
    if (bodies.back().y < 0) {
      throw InputError({table.file(), 1, 1},
                       "there is a column '" + name + "' but no 'y" + name.substr(1) + "'");
    }
  }
  return bodies;
}

/// The column of times of a wide table, -1 if there is none. Rows are frames and columns bodies, so
/// no other column can be named.
int wide_time(const Table& table, const ColumnNames& own) {
  for (const auto& [role, name] : {std::pair{"frame", &own.frame},
                                   {"id", &own.id},
                                   {"x", &own.x},
                                   {"y", &own.y},
                                   {"theta", &own.theta}}) {
    if (name->empty() || *name == "-") continue;
    throw InputError({table.file(), 1, 1},
                     "columns." + std::string(role) + " = \"" + *name +
                         "\": a table of x1, y1, x2, y2, ... has a column of times alone "
                         "(columns.time)");
  }
  if (own.time == "-") return -1;
  const int named = table.find(own.time.empty() ? "time" : own.time);
  if (named < 0 && !own.time.empty()) refuse_missing(table, {own.time});
  return named >= 0 ? named : table.find("seconds");
}

/// time,x1,y1,x2,y2,...: one row a frame; the numbers are the bodies.
void read_wide(Table& table, const RecordingOptions& options, Sightings& out) {
  const std::vector<WideBody> bodies = wide_bodies(table);
  const int time = wide_time(table, options.columns);
  const auto file = static_cast<std::int32_t>(out.files.size() - 1);
  for (std::int64_t frame = 0; table.next(); ++frame) {
    frame += table.empty_rows_before();
    Sighting s;
    s.frame = frame, s.line = table.line(), s.file = file;
    if (time >= 0) s.time = time_of(table, time, out.times, options.time_unit);
    for (const WideBody& body : bodies) {
      s.id = body.id, s.x = bounded(table, body.x), s.y = bounded(table, body.y);
      if (!std::isnan(s.x) && !std::isnan(s.y)) out.add(s);
    }
  }
}

}  // namespace

void read_columns(Table& table, const RecordingOptions& options, Sightings& out) {
  out.units = units_of(out.format);
  if (out.format == RecordingFormat::swistrack_tracks) table.rename({"Frame number", "x", "y"});
  if (out.format == RecordingFormat::idtracker_wide) return read_wide(table, options, out);
  ColumnReader reader(table, options, out);
  std::optional<std::int64_t> id;
  if (one_file_a_track(out.format)) id = track_of(table.file());
  reader.read(id);
}

}  // namespace lilytank
