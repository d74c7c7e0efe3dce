#include "recording/columns.hpp"

#include <cmath>

#include "recording/table.hpp"

namespace lilytank {
namespace {

/// Where the columns are; -1: there is none.
struct Columns {
  int frame = -1, time = -1, id = -1, x = -1, y = -1, theta = -1;
};

Columns columns_of(const Table& table) {
  return {table.find("frame"), table.find("time"), table.find("id"),
          table.find("x"),     table.find("y"),    table.find("theta")};
}

}  // namespace

void read_columns(LineSource& lines, const RecordingOptions& options, Sightings& out) {
  Table table(lines);
  const Columns at = columns_of(table);
  const auto file = static_cast<std::int32_t>(out.files.size() - 1);
  out.units = {1, false, false};
  while (table.next()) {
    Sighting row;
    row.line = table.line(), row.file = file;
    if (at.frame >= 0) {
      const auto frame = table.whole(at.frame);
      if (!frame) table.refuse(at.frame, table.quoted(at.frame) + " is not a whole number");
      row.frame = *frame;
    }
    if (at.time >= 0) row.time = table.number(at.time) * options.time_unit;
    const auto id = table.whole(at.id);
    if (!id) table.refuse(at.id, table.quoted(at.id) + " is not a whole number");
    row.id = *id;
    row.x = table.number(at.x), row.y = table.number(at.y);
    if (at.theta >= 0) row.theta = table.number(at.theta);
    if (std::isnan(row.x) || std::isnan(row.y)) continue;
    out.rows.push_back(row);
  }
}

}  // namespace lilytank
