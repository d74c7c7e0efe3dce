// Counted rates as a table: adding up, text, and stored runs.
#include <algorithm>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "io/file_digest.hpp"
#include "io/json.hpp"
#include "lilytank/kinetics.hpp"
#include "lilytank/run_events.hpp"
#include "lilytank/scenario.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

const std::string kColumns = "kind,rule,a,b,events,exposure_s";

// Keys have commas, which cells may not.
std::string cell_of(std::string key) {
  std::replace(key.begin(), key.end(), ',', ' ');
  return key;
}
std::string key_in(std::string_view cell) {
  std::string key(cell);
  std::replace(key.begin(), key.end(), ' ', ',');
  return key;
}

/// An event between two modules; `place` is that of its row.
Event event_of(const StoredEvent& row, const Ruleset& rules, const SourcePlace& place) {
  Event event;
  event.kind = static_cast<EventKind>(row.kind);
  event.a = row.a, event.face_a = static_cast<std::int8_t>(row.face_a);
  event.b = row.b, event.face_b = static_cast<std::int8_t>(row.face_b);
  event.label_a = row.label_a, event.last_a = static_cast<std::int8_t>(row.last_a);
  event.label_b = row.label_b, event.last_b = static_cast<std::int8_t>(row.last_b);
  if (row.rule.empty()) return event;
  const auto found = std::find_if(rules.rules.begin(), rules.rules.end(),
                                  [&](const Rule& rule) { return rule.name == row.rule; });
  if (found == rules.rules.end()) {
    throw InputError(place, "'" + row.rule + "' is not a rule of " + rules.name);
  }
  event.rule = static_cast<std::int16_t>(found - rules.rules.begin());
  return event;
}

// A number that a run's summary.json holds.
double summary_number(const std::string& text, const std::string& name, const std::string& file) {
  const auto value = json_number_of(text, name);
  if (!value || !(*value >= 0 && *value <= 1e15))
    throw InputError({file}, "it does not say '" + name + "', a number from 0 on");
  return *value;
}

// How far a run came, and its exchanges, once it is over.
struct RunEnd {
  double time = 0;  // s
  std::int64_t exchanges = 0;
};

RunEnd end_of_run(const std::string& dir) {
  const std::string file = (std::filesystem::path(dir) / "summary.json").string();
  if (!std::filesystem::exists(file)) {
    throw InputError("the run in '" + dir +
                     "' is not over: it has no summary.json; lilytank run goes on with it");
  }
  const std::string text = read_whole(file);
  return {summary_number(text, "time_s", file),
          static_cast<std::int64_t>(summary_number(text, "evaluations", file))};
}

}  // namespace

void RateTable::add(const RateTable& other) {
  worlds += other.worlds;
  seconds += other.seconds;
  for (const auto& [pair, meeting] : other.meetings) {
    Meeting& sum = meetings[pair];
    sum.dockings += meeting.dockings;
    sum.exposure += meeting.exposure;
    for (const auto& [rule, links] : meeting.links) sum.links[rule] += links;
  }
  for (const auto& [key, alone] : other.standing) {
    Standing& sum = standing[key];
    sum.exposure += alone.exposure;
    for (const auto& [rule, changes] : alone.changes) sum.changes[rule] += changes;
  }
  evaluations = evaluations < 0 || other.evaluations < 0 ? -1 : evaluations + other.evaluations;
  bond_seconds += other.bond_seconds;
  contacts += other.contacts;
  contact_seconds += other.contact_seconds;
}

std::string to_csv(const RateTable& table) {
  std::string out = kColumns + "\n";
  const auto row = [&](const std::string& kind, const std::string& rule, const std::string& a,
                       const std::string& b, std::int64_t events, double exposure) {
    out += kind + "," + rule + "," + cell_of(a) + "," + cell_of(b) + "," + std::to_string(events) +
           "," + shortest(exposure) + "\n";
  };
  row("worlds", "", "", "", table.worlds, table.seconds);
  row("evaluations", "", "", "", table.evaluations, table.bond_seconds);
  row("contacts", "", "", "", table.contacts, table.contact_seconds);
  for (const auto& [key, standing] : table.standing) {
    row("standing", "", key, "", 0, standing.exposure);
    for (const auto& [rule, n] : standing.changes)
      row("change", rule, key, "", n, standing.exposure);
  }
  for (const auto& [pair, meeting] : table.meetings) {
    row("dockings", "", pair.a, pair.b, meeting.dockings, meeting.exposure);
    for (const auto& [rule, n] : meeting.links)
      row("links", rule, pair.a, pair.b, n, meeting.exposure);
  }
  return out;
}

RateTable rate_table_from(const std::string& text, const std::string& file) {
  CsvReader rows(text, file, {kColumns});
  RateTable table;
  bool headed = false;
  while (rows.next()) {
    const std::string_view kind = rows.text(0);
    const std::string rule(rows.text(1)), a = key_in(rows.text(2)), b = key_in(rows.text(3));
    const std::int64_t events = rows.whole(4, -1, std::int64_t{1} << 60);
    const double exposure = rows.number(5);
    if (exposure < 0) rows.refuse(5, "is less than 0");
    if (kind == "worlds") {
      headed = true;
      table.worlds = static_cast<int>(rows.whole(4, 0, 1000000000)), table.seconds = exposure;
    } else if (kind == "evaluations") {
      table.evaluations = events, table.bond_seconds = exposure;
    } else if (kind == "contacts") {
      table.contacts = events, table.contact_seconds = exposure;
    } else if (kind == "standing") {
      table.standing[a].exposure = exposure;
    } else if (kind == "change") {
      table.standing[a].changes[rule] = events;
    } else if (kind == "dockings") {
      table.meetings[{a, b}].dockings = events, table.meetings[{a, b}].exposure = exposure;
    } else if (kind == "links") {
      table.meetings[{a, b}].links[rule] = events;
    } else if (kind != "copy" && kind != "scenario") {
      rows.refuse(0, "is not a kind of count");
    }
  }
  if (!headed) throw InputError({file, 0, 0}, "the row 'worlds' is missing: the file is cut");
  return table;
}

std::string to_csv(const MeasuredWorld& world, std::uint64_t identity) {
  std::string out = to_csv(world.rates);
  out += "scenario," + hex(identity) + ",,," + (world.diverged ? "1" : "0") + ",0\n";
  for (std::size_t k = 0; k < world.completion.size(); ++k)
    out += "copy,,,," + std::to_string(k + 1) + "," + shortest(world.completion[k]) + "\n";
  return with_checksum_line(out);
}

MeasuredWorld measured_world_from(const std::string& stored, const std::string& file,
                                  std::uint64_t identity) {
  const std::string text(without_checksum_line(stored, file, "remove it to simulate again"));
  MeasuredWorld world;
  world.rates = rate_table_from(text, file);
  CsvReader rows(text, file, {kColumns});
  bool known = false;
  while (rows.next()) {
    if (rows.text(0) == "copy") world.completion.push_back(rows.number(5));
    if (rows.text(0) != "scenario") continue;
    if (rows.text(1) != hex(identity))
      throw InputError({file, 0, 0}, "this simulation is of another scenario: use another --out");
    known = true;
    world.diverged = rows.whole(4, 0, 1) == 1;
  }
  if (!known) throw InputError({file, 0, 0}, "the row 'scenario' is missing: the file is cut");
  return world;
}

RateTable rates_of_run(const std::string& dir) {
  namespace fs = std::filesystem;
  const std::string scenario_file = (fs::path(dir) / "resolved.toml").string();
  const Scenario scenario = load_scenario({scenario_file}, {});
  if (scenario.model.rulesets.size() != 1)
    throw InputError(scenario_file + ": rates are of one ruleset; this run has " +
                     std::to_string(scenario.model.rulesets.size()));
  const Ruleset& rules = scenario.model.rulesets.front();
  const int modules = scenario.model.module.count;
  const RunEnd end = end_of_run(dir);
  RateRecord record(rules, modules);
  const std::string file = (fs::path(dir) / "events.csv").string();
  int line = 1;
  for (const StoredEvent& row : read_events(read_whole(file), file, modules)) {
    ++line;
    if (row.kind >= static_cast<int>(EventKind::report)) continue;  // not between two modules
    record.observe(event_of(row, rules, {file, line, 0}), row.time);
  }
  record.count_evaluations(end.exchanges);
  return record.table(end.time);
}

}  // namespace lilytank
