// The flow grid as a table, one row a cell.
#include <array>
#include <cmath>
#include <fstream>

#include "lilytank/flow_field.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr std::array<std::string_view, 9> kColumns = {
    "ix", "iy", "x_m", "y_m", "mean_vx_mps", "mean_vy_mps", "std_vx_mps", "std_vy_mps", "measured"};

struct Row {
  int ix = 0, iy = 0;
  double x = 0, y = 0;
  FlowSample sample;
  bool measured = false;
};

void check_header(std::string_view line, const std::string& file) {
  std::string want;
  for (const auto column : kColumns) want += (want.empty() ? "" : ",") + std::string(column);
  if (line != want)
    throw InputError({file, 1, 1}, "the header is '" + std::string(line.substr(0, 80)) +
                                       "', a flow grid begins with '" + want + "'");
}

// Velocities beyond this are no tank's water, but may be cm/s or mm/s.
constexpr double kFastest = 5;  // m/s

// Columns of velocities, of cells that count.
void check_speeds(const std::array<double, 9>& value, const std::array<int, 9>& column,
                  const std::string& file, int number) {
  if (value[8] == 0) return;
  for (std::size_t i = 4; i < 8; ++i) {
    if (std::fabs(value[i]) <= kFastest) continue;
    throw InputError({file, number, column[i]}, std::string(kColumns[i]) + " = " +
                                                    shortest(value[i]) +
                                                    " m/s is faster than 5 m/s: are these "
                                                    "velocities in cm/s or mm/s?");
  }
}

// Splits a row and reads its nine numbers; every one is checked by itself.
Row read_row(std::string_view line, const std::string& file, int number) {
  std::array<double, 9> value{};
  std::array<int, 9> column{};
  std::size_t at = 0;
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    column[i] = static_cast<int>(at) + 1;
    const SourcePlace place{file, number, column[i]};
    if (at > line.size())
      throw InputError(place, "the row has " + std::to_string(i) + " of 9 values");
    const std::size_t comma = std::min(line.find(',', at), line.size());
    const std::string_view word = trimmed(line.substr(at, comma - at));
    const auto parsed = parse_number(word);
    if (!parsed)
      throw InputError(place, std::string(kColumns[i]) + " = '" + std::string(word) +
                                  "' is not a finite number");
    const bool index = i < 2 || i == 8;
    if (index && (*parsed != std::floor(*parsed) || *parsed < 0 || *parsed > 4095))
      throw InputError(place, std::string(kColumns[i]) + " = " + std::string(word) +
                                  " is not a whole number from 0");
    if ((i == 6 || i == 7) && *parsed < 0)
      throw InputError(place, std::string(kColumns[i]) + " = " + std::string(word) +
                                  " m/s: a deviation is not negative");
    value[i] = *parsed;
    at = comma + 1;
  }
  if (at <= line.size())
    throw InputError({file, number, static_cast<int>(at) + 1}, "the row has more than 9 values");
  check_speeds(value, column, file, number);
  return {static_cast<int>(value[0]),
          static_cast<int>(value[1]),
          value[2],
          value[3],
          {value[4], value[5], value[6], value[7]},
          value[8] != 0};
}

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

std::vector<Row> read_rows(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError({file}, "the flow grid cannot be read");
  std::vector<Row> rows;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (number == 1)
      check_header(line, file);
    else if (!line.empty())
      rows.push_back(read_row(line, file, number));
  }
  return rows;
}

}  // namespace

FlowField read_flow_csv(const std::string& file, Interpolation interpolation, double tank_radius) {
  const std::vector<Row> rows = read_rows(file);
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
  std::vector<bool> measured(size, false), seen(size, false);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Row& row = rows[k];
    const std::size_t i = static_cast<std::size_t>(row.iy) * cells + row.ix;
    const SourcePlace place{file, static_cast<int>(k) + 2};
    const std::string cell =
        "cell (" + std::to_string(row.ix) + ", " + std::to_string(row.iy) + ")";
    if (seen[i]) throw InputError(place, cell + " is given twice");
    const double h = 2 * extent / cells;
    const double x = (row.ix + 0.5) * h - extent, y = (row.iy + 0.5) * h - extent;
    if (!(extent > 0) || std::fabs(row.x - x) > 0.01 * h || std::fabs(row.y - y) > 0.01 * h)
      throw InputError(place, cell +
                                  " is not where a square grid about the tank's centre has it; "
                                  "are x_m and y_m in metres?");
    seen[i] = true, measured[i] = row.measured, samples[i] = row.sample;
  }
  if (tank_radius > 0) check_extent(extent, tank_radius, file);
  return FlowField(cells, extent, std::move(samples), std::move(measured), interpolation);
}

}  // namespace lilytank
