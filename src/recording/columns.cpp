#include <algorithm>
#include <cmath>

#include "recording/column_cells.hpp"
#include "recording/formats.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

/// Where the columns are; -1: there is none.
struct Columns {
  int frame = -1, time = -1, id = -1, x = -1, y = -1, theta = -1, missing = -1;
  std::optional<BoxColumns> box;
};

/// Whether the table is one of lilytank's own trajectories, of which "label" is a module's state.
bool is_own_trajectory(const Table& table) {
  return table.find("bonded") >= 0 && table.find("latched") >= 0 && table.find("label") >= 0;
}

/// MOT challenge files have no names: frame, id, left, top, width, height, ...
bool has_numbers_for_names(const Table& table) {
  return table.names().size() >= 6 && table.names().front() == "1";
}

/// Finds the columns of a table of one row a sighting.
class ColumnFinder {
 public:
  ColumnFinder(const Table& table, const RecordingOptions& options, RecordingFormat format)
      : table_(&table), own_(&options.columns), format_(format), names_(columns_of(format)) {}

  Columns find() {
    if (format_ == RecordingFormat::boxes) find_box_columns();
    at_.frame = find_column(*table_, own_->frame, names_.frame);
    if (at_.frame < 0 && own_->frame.empty()) {
      at_.frame = find_role(table_->names(), ColumnRole::frame);
    }
    at_.time = find_column(*table_, own_->time, names_.time);
    at_.theta = find_column(*table_, own_->theta, names_.theta);
    at_.missing = find_column(*table_, "", names_.missing);
    if (!at_.box) {
      at_.x = needed(own_->x, names_.x), at_.y = needed(own_->y, names_.y);
    }
    find_identity();
    if (at_.frame < 0 && at_.time < 0) {
      throw InputError({table_->file(), table_->header_line(), 1},
                       "there is neither a column of frames nor of times; there are " +
                           short_list(table_->names()) + suggested_keys(table_->names()));
    }
    return at_;
  }

 private:
  int needed(const std::string& own, const std::vector<std::string>& names) const {
    const int found = find_column(*table_, own, names);
    if (found < 0) refuse_missing(*table_, own.empty() ? names : std::vector{own});
    return found;
  }

  // The user may name x and y of the middle instead.
  void find_box_columns() {
    if (has_numbers_for_names(*table_)) {
      names_.frame = {"1"}, names_.id = {"2"};
      at_.box = BoxColumns{BoxColumns::Kind::corner_and_size, 2, 3, 4, 5};
    } else {
      at_.box = find_box(table_->names());
    }
    if (!own_->x.empty() || !own_->y.empty()) at_.box.reset(), names_.x = {"x"}, names_.y = {"y"};
    if (at_.box || !own_->x.empty()) return;
    throw InputError({table_->file(), table_->header_line(), 1},
                     "there are no columns of a bounding box: x1, y1, x2, y2, or xmin, ymin, xmax, "
                     "ymax, or left, top, width, height, or x_center, y_center, width, height; "
                     "there are " +
                         short_list(table_->names()));
  }

  void find_identity() {
    at_.id = find_column(*table_, own_->id, names_.id);
    if (!own_->id.empty() || one_file_a_track(format_)) return;
    if (at_.id >= 0 || is_own_trajectory(*table_)) return;
    const int likely = find_role(table_->names(), ColumnRole::identity);
    if (likely < 0) return;
    if (format_ == RecordingFormat::boxes) {
      at_.id = likely;
      return;
    }
    const std::string& name = table_->names()[likely];
    throw InputError({table_->file(), table_->header_line(), 1},
                     "no column 'id', but '" + name + "' looks like identities: columns.id = \"" +
                         name +
                         "\" reads it, columns.id = \"-\" links rows by their positions; there "
                         "are " +
                         short_list(table_->names()));
  }

  const Table* table_;
  const ColumnNames* own_;
  RecordingFormat format_;
  FormatColumns names_;
  Columns at_;
};

/// Reads the rows of one table.
class ColumnReader {
 public:
  ColumnReader(Table& table, const RecordingOptions& options, Sightings& out)
      : table_(&table),
        options_(&options),
        out_(&out),
        at_(ColumnFinder(table, options, out.format).find()) {
    if (options.body != BodyKind::lily) at_.theta = -1;  // balls do not turn
    out.headings = at_.theta >= 0;
    std::vector<int> used{at_.frame, at_.time, at_.id, at_.x, at_.y, at_.theta, at_.missing};
    if (at_.box) used.insert(used.end(), {at_.box->x1, at_.box->y1, at_.box->x2, at_.box->y2});
    list_unused(table, used, out);
    hint_at_identities();
  }

  /// `id`: of all rows, if the file is one track.
  void read(std::optional<std::int64_t> id) {
    file_ = static_cast<std::int32_t>(out_->files.size() - 1);
    if (!id && at_.id < 0) out_->identities = false;
    const std::int64_t before = out_->counts.without_identity;
    const std::size_t rows = out_->rows.size();
    while (table_->next()) row(id);
    const std::int64_t nobody = out_->counts.without_identity - before;
    if (nobody == 0 || out_->rows.size() > rows) return;
    throw InputError({table_->file(), 0, 0},
                     "no row has an identity in column '" + table_->names()[at_.id] +
                         "': columns.id = \"-\" links rows by their positions");
  }

 private:
  void hint_at_identities() const {
    if (!options_->columns.id.empty() || at_.id < 0 || is_own_trajectory(*table_)) return;
    const auto others = names_of_role(out_->unused, ColumnRole::identity);
    if (others.empty()) return;
    const std::string& used = table_->names()[at_.id];
    add_hint("identities are read from '" + used + "'; " + quoted_names(others) +
                 " may be identities, too: columns.id says which to read",
             *out_);
  }

  void row(std::optional<std::int64_t> id) {
    ++out_->counts.read;
    Sighting s;
    s.line = table_->line(), s.file = file_;
    if (at_.frame >= 0) s.frame = whole_cell(*table_, at_.frame);
    if (at_.time >= 0) s.time = time_of(*table_, at_.time, out_->times, options_->time_unit);
    place(s);
    const bool missing = at_.missing >= 0 && table_->number(at_.missing) != 0;
    const bool nowhere = std::isnan(s.x) || std::isnan(s.y);
    if (missing || nowhere) {  // a gap, which check_gaps() reports
      ++out_->counts.not_seen;
      return;
    }
    if (id) s.id = *id;
    if (!id && at_.id >= 0) {
      const auto known = identity();
      if (!known) {
        ++out_->counts.without_identity;
        return;
      }
      s.id = *known;
    }
    if (at_.theta >= 0) s.theta = bounded(*table_, at_.theta);
    out_->add(s);
  }

  void place(Sighting& s) const {
    if (at_.box) {
      place_box(s);
    } else {
      s.x = bounded(*table_, at_.x), s.y = bounded(*table_, at_.y);
    }
    s.zero = s.x == 0 && s.y == 0;
  }

  /// The middle of a box.
  void place_box(Sighting& s) const {
    const BoxColumns& box = *at_.box;
    const double x1 = bounded(*table_, box.x1), y1 = bounded(*table_, box.y1);
    const double x2 = bounded(*table_, box.x2), y2 = bounded(*table_, box.y2);
    using Kind = BoxColumns::Kind;
    if (box.kind != Kind::corners && (x2 < 0 || y2 < 0)) {
      const int column = x2 < 0 ? box.x2 : box.y2;
      table_->refuse(column, table_->quoted(column) + " is no width or height of a box");
    }
    if (box.kind == Kind::corners && (x2 < x1 || y2 < y1)) {
      const int column = x2 < x1 ? box.x2 : box.y2;
      table_->refuse(column, table_->quoted(column) + " is before the box's other corner, " +
                                 table_->quoted(x2 < x1 ? box.x1 : box.y1) +
                                 ": are these corners of a bounding box?");
    }
    // A box of no size is how some trackers write what they did not see.
    s.x = s.y = kUnknown;
    if (box.kind == Kind::corners) {
      if (x2 > x1 || y2 > y1) s.x = 0.5 * (x1 + x2), s.y = 0.5 * (y1 + y2);
    } else if (x2 > 0 || y2 > 0) {
      const double part = box.kind == Kind::corner_and_size ? 0.5 : 0.0;
      s.x = x1 + part * x2, s.y = y1 + part * y2;
    }
  }

  // Ids are whole numbers; if one is a word, all are words, which are numbered as they come.
  // Nothing: the row belongs to nobody.
  std::optional<std::int64_t> identity() {
    if (table_->not_seen(at_.id)) return std::nullopt;
    const auto number = table_->whole(at_.id);
    if (out_->names.empty()) {
      if (number) return *number;
      for (Sighting& row : out_->rows) row.id = number_of(std::to_string(row.id));
    }
    return number_of(number ? std::to_string(*number) : std::string(table_->cell(at_.id)));
  }

  std::int64_t number_of(const std::string& word) const {
    const auto [found, added] =
        out_->words.emplace(word, static_cast<std::int64_t>(out_->names.size()));
    if (added) out_->names.push_back(word);
    return found->second;
  }

  Table* table_;
  const RecordingOptions* options_;
  Sightings* out_;
  Columns at_;
  std::int32_t file_ = 0;
};

/// The last number in a file's name: "video_id12.csv" is track 12.
std::int64_t track_of(const std::string& file) {
  const std::string name = file.substr(file.find_last_of('/') + 1);
  const auto last = name.find_last_of("0123456789", name.rfind(".csv"));
  if (last == std::string::npos) {
    throw InputError({file, 0, 0}, "the file's name has no number that identifies the track");
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
    case boxes:
      return {0, true, true};
    case fasttrack:
      return {0, true, false};  // angles are counter-clockwise as seen
    case trex:
      return {0.01, true, true};
    default:
      return {};
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
