#include <algorithm>
#include <cmath>

#include "recording/column_cells.hpp"
#include "recording/formats.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

/// A body's columns.
struct WideBody {
  std::int64_t id;
  int x, y;
};

/// The number of a name such as "x12".
std::optional<std::int64_t> numbered(const std::string& name, char axis) {
  return name.size() > 1 && name.front() == axis && name[1] >= '0' && name[1] <= '9'
             ? parse_whole(name.substr(1))
             : std::nullopt;
}

std::vector<WideBody> wide_bodies(const Table& table) {
  std::vector<WideBody> bodies;
  for (const std::string& name : table.names()) {
    for (const auto& [axis, other] : {std::pair{'x', 'y'}, {'y', 'x'}}) {
      const auto id = numbered(name, axis);
      if (!id) continue;
      const std::string partner = other + name.substr(1);
      if (table.find(partner) < 0) {
        throw InputError({table.file(), table.header_line(), 1},
                         "there is a column '" + name + "' but no '" + partner + "'");
      }
      if (axis == 'x') bodies.push_back({*id, table.find(name), table.find(partner)});
    }
  }
  if (bodies.empty()) refuse_missing(table, {"x1"});
  return bodies;
}

/// Bodies are columns, so a body's column cannot be named; a column of identities beside them is a
/// contradiction, unless the user excludes it.
void refuse_other_layouts(const Table& table, const ColumnNames& own) {
  for (const auto& [role, name] :
       {std::pair{"id", &own.id}, {"x", &own.x}, {"y", &own.y}, {"theta", &own.theta}}) {
    if (name->empty() || *name == "-") continue;
    throw InputError({table.file(), table.header_line(), 1},
                     "columns." + std::string(role) + " = \"" + *name +
                         "\": of a table of x1, y1, x2, y2, ... only "
                         "columns.frame and columns.time can be named");
  }
  const auto identities = names_of_role(table.names(), ColumnRole::identity);
  if (identities.empty() || own.id == "-") return;
  throw InputError(
      {table.file(), table.header_line(), 1},
      quoted_names(identities) +
          (identities.size() == 1 ? " looks like a column of identities"
                                  : " look like columns of identities") +
          ", but the rows of a table of x1, y1, x2, y2, ... are frames: format = \"boxes\" reads "
          "x1, y1, x2, y2 as corners of bounding boxes, columns.id = \"-\" ignores the identities; "
          "there are " +
          short_list(table.names()));
}

/// Two bodies of which the second is always right of and below the first, at a distance that
/// changes less than both move: the corners of a box.
class BoxSuspicion {
 public:
  void add(double x1, double y1, double x2, double y2) {
    if (std::isnan(x1 + y1 + x2 + y2)) return;
    ++seen_;
    ordered_ = ordered_ && x2 > x1 && y2 > y1;
    width_.add(x2 - x1), height_.add(y2 - y1), x_.add(x1), y_.add(y1);
  }
  bool corners() const {
    constexpr int kFewest = 10;
    return seen_ >= kFewest && ordered_ && 4 * width_.span() < x_.span() + y_.span() &&
           4 * height_.span() < x_.span() + y_.span();
  }

 private:
  struct Range {
    double low = HUGE_VAL, high = -HUGE_VAL;
    void add(double v) { low = std::min(low, v), high = std::max(high, v); }
    double span() const { return high - low; }
  };
  int seen_ = 0;
  bool ordered_ = true;
  Range width_, height_, x_, y_;
};

class WideReader {
 public:
  WideReader(Table& table, const RecordingOptions& options, Sightings& out)
      : table_(&table), options_(&options), out_(&out) {
    refuse_other_layouts(table, options.columns);
    bodies_ = wide_bodies(table);
    const FormatColumns names = columns_of(RecordingFormat::idtracker_wide);
    frame_ = find_frame(table, options.columns.frame, RecordingFormat::idtracker_wide);
    time_ = find_column(table, options.columns.time, names.time);
    std::vector<int> used{frame_, time_};
    for (const WideBody& body : bodies_) used.push_back(body.x), used.push_back(body.y);
    list_unused(table, used, out);
  }

  void read() {
    const auto file = static_cast<std::int32_t>(out_->files.size() - 1);
    BoxSuspicion box;
    for (std::int64_t frame = 0; table_->next(); ++frame) {
      ++out_->counts.read;
      frame += table_->empty_rows_before();
      Sighting s;
      s.line = table_->line(), s.file = file;
      s.frame = frame_ >= 0 ? whole_cell(*table_, frame_) : frame;
      if (time_ >= 0) s.time = time_of(*table_, time_, out_->times, options_->time_unit);
      for (const WideBody& body : bodies_) add(s, body);
      if (bodies_.size() == 2) {
        box.add(table_->number(bodies_[0].x), table_->number(bodies_[0].y),
                table_->number(bodies_[1].x), table_->number(bodies_[1].y));
      }
    }
    if (options_->format == RecordingFormat::automatic && box.corners()) refuse_box();
  }

 private:
  void add(Sighting& s, const WideBody& body) {
    s.id = body.id, s.x = bounded(*table_, body.x), s.y = bounded(*table_, body.y);
    s.zero = s.x == 0 && s.y == 0;
    if (std::isnan(s.x) || std::isnan(s.y)) {
      ++out_->counts.not_seen;
    } else {
      out_->add(s);
    }
  }

  [[noreturn]] void refuse_box() const {
    throw InputError({table_->file(), table_->header_line(), 1},
                     "the second body is always at larger x and y than the first, at nearly the "
                     "same distance: they look like the corners of a bounding box, which format = "
                     "\"boxes\" reads; format = \"idtracker-wide\" reads two bodies");
  }

  Table* table_;
  const RecordingOptions* options_;
  Sightings* out_;
  std::vector<WideBody> bodies_;
  int frame_ = -1, time_ = -1;
};

}  // namespace

void read_wide(Table& table, const RecordingOptions& options, Sightings& out) {
  WideReader(table, options, out).read();
}

}  // namespace lilytank
