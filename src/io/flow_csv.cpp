// The flow grid as a table, one row a cell.
#include <array>
#include <cmath>

#include "io/table.hpp"
#include "lilytank/flow_field.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

enum Column { ix, iy, x, y, mean_vx, mean_vy, std_vx, std_vy, measured };
const std::vector<std::string> kColumns{
    "ix", "iy", "x_m", "y_m", "mean_vx_mps", "mean_vy_mps", "std_vx_mps", "std_vy_mps", "measured"};
constexpr std::int64_t kLargestIndex = 4095;

struct Row {
  int ix = 0, iy = 0, line = 0;
  double x = 0, y = 0;
  FlowSample sample;
  bool measured = false;
};

/// Reads rows; every number is checked by itself.
class GridReader {
 public:
  explicit GridReader(Table& table)
      : table_(table), at_(table.fixed_columns(kColumns, "a flow grid")) {}

  std::vector<Row> read() {
    std::vector<Row> rows;
    while (table_.next()) rows.push_back(row());
    return rows;
  }

 private:
  Row row() {
    Row out{static_cast<int>(whole(ix)),
            static_cast<int>(whole(iy)),
            table_.line(),
            number(x),
            number(y),
            {speed(mean_vx), speed(mean_vy), speed(std_vx), speed(std_vy)},
            whole(measured) != 0};
    const auto cell = static_cast<std::size_t>(out.iy * (kLargestIndex + 1) + out.ix);
    if (seen_[cell]) {
      table_.refuse(at_[ix], "cell (" + std::to_string(out.ix) + ", " + std::to_string(out.iy) +
                                 ") is given twice");
    }
    seen_[cell] = true;
    return out;
  }

  double number(Column column) const { return table_.finite(at_[column]); }

  std::int64_t whole(Column column) const {
    const auto value = table_.whole(at_[column]);
    if (value && *value >= 0 && *value <= kLargestIndex) return *value;
    table_.refuse(at_[column], table_.quoted(at_[column]) + " is not a whole number, 0 .. " +
                                   std::to_string(kLargestIndex));
  }

  // Velocities beyond this are no tank's water, but may be cm/s or mm/s; cells that are not
  // measured do not count.
  double speed(Column column) const {
    constexpr double kFastest = 5;  // m/s
    const double value = number(column);
    const std::string what = kColumns[column] + " = " + shortest(value) + " m/s";
    if ((column == std_vx || column == std_vy) && value < 0) {
      table_.refuse(at_[column], what + ": a standard deviation is not negative");
    }
    if (std::fabs(value) > kFastest && whole(measured) != 0) {
      table_.refuse(at_[column],
                    what + " is faster than 5 m/s: are these velocities in cm/s or mm/s?");
    }
    return value;
  }

  Table& table_;
  std::vector<int> at_;
  std::vector<bool> seen_ = std::vector<bool>((kLargestIndex + 1) * (kLargestIndex + 1));
};

// A grid of a camera's view is somewhat larger or smaller than the tank; ten times is another unit.
void check_extent(double extent, double tank_radius, const std::string& file) {
  constexpr double kMost = 5;
  const double ratio = extent / tank_radius;
  if (ratio <= kMost && ratio >= 1 / kMost) return;
  std::string hint;
  for (const auto& [unit, metres] : {std::pair{"cm", 1e-2}, {"mm", 1e-3}}) {
    const double scaled = ratio * metres;
    if (scaled < 2 && scaled > 0.5) hint = std::string(": are x_m and y_m in ") + unit + "?";
  }
  throw InputError({file}, "the flow grid reaches " + significant(extent, 3) +
                               " m to every side of the centre of a tank of radius " +
                               significant(tank_radius, 3) + " m" + hint);
}

}  // namespace

FlowField read_flow_csv(const std::string& file, Interpolation interpolation, double tank_radius) {
  const std::vector<Row> rows = with_enough_memory(file, [&] {
    LineSource lines(file);
    Table table(lines);
    return GridReader(table).read();
  });
  int cells = 0;
  double extent = 0;
  for (const Row& row : rows) cells = std::max({cells, row.ix + 1, row.iy + 1});
  const auto size = static_cast<std::size_t>(cells) * cells;
  if (cells < 2 || rows.size() != size)
    throw InputError({file}, "the flow grid has " + std::to_string(rows.size()) +
                                 " cells; a square of " + std::to_string(cells) + " x " +
                                 std::to_string(cells) + " is expected");
  for (const Row& row : rows)
    if (row.ix == cells - 1) extent = row.x * cells / (cells - 1);
  std::vector<FlowSample> samples(size);
  std::vector<bool> measured(size, false);
  for (const Row& row : rows) {
    const std::size_t i = static_cast<std::size_t>(row.iy) * cells + row.ix;
    const double h = 2 * extent / cells;
    const double x = (row.ix + 0.5) * h - extent, y = (row.iy + 0.5) * h - extent;
    if (!(extent > 0) || std::fabs(row.x - x) > 0.01 * h || std::fabs(row.y - y) > 0.01 * h)
      throw InputError({file, row.line},
                       "cell (" + std::to_string(row.ix) + ", " + std::to_string(row.iy) +
                           ") is not where a square grid about the tank's centre has it; "
                           "are x_m and y_m in metres?");
    measured[i] = row.measured, samples[i] = row.sample;
  }
  if (tank_radius > 0) check_extent(extent, tank_radius, file);
  return FlowField(cells, extent, std::move(samples), std::move(measured), interpolation);
}

}  // namespace lilytank
