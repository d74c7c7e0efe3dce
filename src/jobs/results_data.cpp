// Tables and poses of a directory of results, as arrays.
#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>

#include "io/atomic_file.hpp"
#include "io/table.hpp"
#include "jobs/run_directory.hpp"
#include "lilytank/data_file.hpp"
#include "lilytank/run.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

struct Column {
  std::string name;
  std::vector<std::string> cells;
  bool numbers = true, whole = true, gaps = false;
};

std::string unit_of(const std::string& column) {
  static const std::map<std::string, std::string> units{
      {"time", "s"},     {"duration", "s"}, {"latched", "s"}, {"joined", "s"},
      {"released", "s"}, {"x", "m"},        {"y", "m"},       {"theta", "rad"}};
  const auto found = units.find(column);
  return found == units.end() ? "" : found->second;
}

void note_cell(const std::string& cell, Column& column) {
  column.cells.push_back(cell);
  if (cell.empty()) {
    column.gaps = true;
    return;
  }
  column.numbers = column.numbers && parse_number(cell);
  column.whole = column.whole && parse_whole(cell);
}

DataVariable variable_of(Column column) {
  DataVariable out{column.name, {"row"}, {}};
  if (const std::string unit = unit_of(column.name); !unit.empty())
    out.attributes.emplace_back("units", unit);
  const bool quantity = !out.attributes.empty();  // of whatever values
  if (!column.numbers) {
    out.values = std::move(column.cells);
  } else if (column.whole && !column.gaps && !quantity) {
    std::vector<std::int64_t> values;
    for (const std::string& cell : column.cells) values.push_back(*parse_whole(cell));
    out.values = std::move(values);
  } else {
    std::vector<double> values;
    for (const std::string& cell : column.cells)
      values.push_back(parse_number(cell).value_or(std::numeric_limits<double>::quiet_NaN()));
    out.values = std::move(values);
  }
  return out;
}

DataGroup table_group(const fs::path& file) {
  LineSource lines(file.string());
  Table table(lines, {.header_line = 1, .first_row = {}, .decimal_comma = false});
  std::vector<Column> columns;
  for (const std::string& name : table.names()) columns.push_back({name, {}});
  std::size_t rows = 0;
  for (; table.next(); ++rows) {
    for (std::size_t c = 0; c < columns.size(); ++c)
      note_cell(std::string(table.cell(static_cast<int>(c))), columns[c]);
  }
  DataGroup out{file.stem().string(), {{"row", rows}}, {}};
  for (Column& column : columns) {
    if (!column.name.empty()) out.variables.push_back(variable_of(std::move(column)));
  }
  return out;
}

template <class T, class Get>
DataVariable marking(const std::string& name, const std::string& meaning,
                     const std::vector<Markings>& markings, Get&& get) {
  std::vector<T> values;
  values.reserve(markings.size());
  for (const Markings& m : markings) values.push_back(static_cast<T>(get(m)));
  return {name, {"frame", "body"}, std::move(values), {{"long_name", meaning}}};
}

DataGroup trajectory_group(Trajectory t) {
  const auto frames = static_cast<std::size_t>(t.frames()),
             bodies = static_cast<std::size_t>(t.bodies);
  DataGroup out{"trajectory", {{"frame", frames}, {"body", bodies}}, {}};
  const auto add = [&](const char* name, std::vector<std::string> along, auto values,
                       DataAttributes attributes) {
    out.variables.push_back({name, std::move(along), std::move(values), std::move(attributes)});
  };
  std::vector<std::string> kinds;
  for (int b = 0; b < t.bodies; ++b) kinds.emplace_back(b < t.modules ? "module" : "ball");
  add("time", {"frame"}, std::move(t.time),
      {{"units", "s"}, {"long_name", "time since the start"}});
  add("kind", {"body"}, std::move(kinds), {});
  const std::vector<std::string> both{"frame", "body"};
  add("x", both, std::move(t.x), {{"units", "m"}, {"long_name", "position of the centre"}});
  add("y", both, std::move(t.y), {{"units", "m"}, {"long_name", "position of the centre"}});
  add("theta", both, std::move(t.theta), {{"units", "rad"}, {"long_name", "heading"}});
  if (t.markings.empty()) return out;
  out.variables.push_back(marking<std::int16_t>("label", "control state l_a", t.markings,
                                                [](const Markings& m) { return m.label; }));
  out.variables.push_back(marking<std::int8_t>("last", "connector engaged last; -1: isolated",
                                               t.markings,
                                               [](const Markings& m) { return m.last; }));
  out.variables.push_back(marking<std::int8_t>("latched", "bit f: face f holds a neighbour",
                                               t.markings,
                                               [](const Markings& m) { return m.latched; }));
  out.variables.push_back(
      marking<std::int8_t>("bonded", "bit f: face f holds a neighbour by a rule", t.markings,
                           [](const Markings& m) { return m.bonded; }));
  out.variables.push_back(marking<std::int8_t>("complete", "1: in a complete copy of the target",
                                               t.markings,
                                               [](const Markings& m) { return m.complete; }));
  return out;
}

}  // namespace

DataFile data_of_results(const std::string& dir) {
  DataFile out;
  out.attributes = {{"source", std::string("lilytank ") + LILYTANK_VERSION}};
  std::vector<fs::path> tables;
  const bool run = exists((fs::path(dir) / run_file::resolved).string());
  require_path(dir);
  if (!fs::is_directory(dir)) throw InputError("'" + dir + "' is not a directory of results");
  for (const auto& entry : fs::directory_iterator(dir)) {
    const std::string name = entry.path().filename().string();
    // A study's rows of one process are in its table; a run's poses have their own group.
    const bool apart = name.starts_with("rows-") || name == run_file::trajectory_csv ||
                       (run && name == "flow.csv");
    if (entry.path().extension() == ".csv" && !apart) tables.push_back(entry.path());
  }
  std::sort(tables.begin(), tables.end());
  if (run) {
    StoredRun stored = load_run(dir);
    out.attributes.emplace_back("title", stored.scenario.title);
    out.attributes.emplace_back("scenario", stored.scenario.resolved);
    if (stored.trajectory.frames() > 0)
      out.groups.push_back(trajectory_group(std::move(stored.trajectory)));
  }
  for (const fs::path& table : tables) out.groups.push_back(table_group(table));
  if (out.groups.empty()) throw InputError("'" + dir + "' holds no tables (*.csv)");
  return out;
}

}  // namespace lilytank
