#include "study/study_axis.hpp"

#include <algorithm>
#include <filesystem>

#include "io/scenario_keys.hpp"
#include "io/scenario_values.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr int kMostValues = 100000;

}  // namespace

KeyFacts facts_of(const Assignment& path) {
  if (path.keys.front() == "rules") return {"1", false};  // known once the ruleset is read
  ScenarioDraft draft;
  const std::vector<ScenarioKey> keys = scenario_keys(draft);
  const std::string name = path.path();
  const auto found = std::find_if(keys.begin(), keys.end(),
                                  [&](const ScenarioKey& key) { return key.path == name; });
  if (found == keys.end()) throw unknown_key(path, keys);
  if (std::holds_alternative<double*>(found->target)) return {found->unit, found->whole};
  const bool whole = std::holds_alternative<int*>(found->target) ||
                     std::holds_alternative<std::uint64_t*>(found->target);
  if (whole) return {found->unit, true};
  throw InputError(path.place, "'" + name + "' is not a number: list its values");
}

Assignment path_of(const TomlFields& fields) {
  Assignment out;
  out.place = fields.place("path");
  const std::string path = fields.text("path");
  for (std::size_t at = 0; at <= path.size();) {
    const auto dot = std::min(path.find('.', at), path.size());
    out.keys.push_back(path.substr(at, dot - at));
    out.key_places.push_back(out.place);
    if (out.keys.back().empty()) {
      fields.refuse("path", "'" + path + "' is not a path such as tank.radius");
    }
    at = dot + 1;
  }
  if (path == "run.seed") {
    fields.refuse("path",
                  "'run.seed' is no axis: replicates have seeds of their own, see "
                  "study.seed and study.replicates");
  }
  if (out.keys.front() == "base" || out.keys.front() == "command") {
    fields.refuse("path", "'" + path + "' can be given in scenario files only");
  }
  return out;
}

TomlKey scale_key() {
  return toml_key::word("scale", {"linear", "log"}, "equal steps or equal ratios (linear)");
}

bool log_scale(const TomlFields& fields) {
  return fields.has("scale") && fields.word("scale") == 1;
}

TomlKeys axis_keys() {
  using namespace toml_key;
  const TomlKey from = quantity("from", "where the values begin");
  const TomlKey to = quantity("to", "where the values end");
  return {
      text("name", "names a column (default: the path)"),
      text("path", "what is varied, as module.count"),
      list("values", "the values"),
      from,
      to,
      whole("count", 2, kMostValues, "how many values"),
      scale_key(),
      table("latin", {from, to, scale_key()}, "one random value in each of study.samples parts"),
      texts("overlays", "files that override the scenario"),
      texts("labels", "one for each value or overlay")};
}

namespace {

AxisRange ends(const TomlFields& fields, const KeyFacts& facts) {
  fields.need("from", "where the values begin");
  fields.need("to", "where the values end");
  AxisRange range;
  range.from = fields.number("from", facts.unit);
  range.to = fields.number("to", facts.unit);
  range.log = log_scale(fields);
  range.whole = facts.whole;
  if (range.from == range.to) fields.refuse("to", fields.path("to") + " equals from");
  if (range.log && (range.from <= 0 || range.to <= 0)) {
    fields.refuse(range.from <= 0 ? "from" : "to", "scale = \"log\" needs ends above 0");
  }
  return range;
}

std::vector<Assignment> listed(const TomlFields& fields, const Assignment& path,
                               const std::string& directory) {
  const toml::array* list = fields.node("values")->as_array();
  if (list == nullptr || list->empty()) {
    fields.refuse("values", "axis.values is a list with at least one value");
  }
  std::vector<Assignment> out;
  for (const toml::node& node : *list) {
    Assignment value = path;
    value.value = value_of(node);
    value.place = place_of(node.source(), path.place.file);
    value.directory = directory;
    out.push_back(std::move(value));
  }
  return out;
}

AxisRange computed(const TomlFields& fields, const KeyFacts& facts) {
  if (fields.has("latin")) {
    if (!fields.node("latin")->is_table()) {
      fields.refuse("latin", "axis.latin is {from = ..., to = ...}");
    }
    AxisRange range = ends(fields.fields("latin"), facts);
    range.latin = true;
    return range;
  }
  AxisRange range = ends(fields, facts);
  fields.need("count", "how many values");
  range.count = static_cast<int>(fields.whole("count"));
  return range;
}

std::vector<std::string> labels(const TomlFields& fields, const StudyAxis& axis) {
  std::vector<std::string> out;
  for (const auto& [text, place] : fields.texts("labels")) out.push_back(text);
  const std::size_t n = axis.values.size() + axis.overlays.size();
  if (n == 0) fields.refuse("labels", "axis.labels goes with values or overlays");
  if (out.size() == n) return out;
  fields.refuse("labels", "axis.labels has " + std::to_string(out.size()) + " texts for " +
                              std::to_string(n) +
                              (axis.overlays.empty() ? " values" : " overlays"));
}

/// The one way in which the axis is given: "values", "from", "latin" or "overlays".
std::string way_of(const TomlFields& fields) {
  std::string way;
  for (const char* name : {"values", "from", "latin", "overlays"}) {
    if (!fields.has(name)) continue;
    if (!way.empty()) {
      fields.refuse(name, std::string("axis.") + name + " goes not with axis." + way);
    }
    way = name;
  }
  if (way.empty()) {
    throw InputError(fields.place(),
                     "an axis needs values, from and to and count, latin, or overlays");
  }
  for (const char* name : {"to", "count", "scale"}) {
    if (fields.has(name) && way != "from") {
      fields.refuse(name, std::string("axis.") + name + " goes with axis.from only");
    }
  }
  return way;
}

}  // namespace

void check_name(const std::string& name, const std::string& what, const SourcePlace& place) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  if (!name.empty() && name.front() != '.' && std::all_of(name.begin(), name.end(), plain)) return;
  throw InputError(place, what + " = \"" + name +
                              "\" is not of letters, digits, '_', '-' and '.': it names files and "
                              "columns");
}

namespace {

/// Whether a study's tables have a column of this name besides the axes' own.
bool is_column(const std::string& name) {
  static const std::vector<std::string> columns{
      "setting",    "replicate", "id",       "seed",    "status", "duration_s",
      "possible",   "copies",    "illegal",  "note",    "label",  "metric",
      "full_yield", "k",         "unit",     "value",   "low",    "high",
      "runs",       "time_s",    "survival", "at_risk", "events", "censored"};
  const bool time = name.size() > 7 && name.starts_with("time_") && name.ends_with("_s");
  const std::string k = time ? name.substr(5, name.size() - 7) : "";
  return std::find(columns.begin(), columns.end(), name) != columns.end() ||
         (time && k.find_first_not_of("0123456789") == std::string::npos);
}

}  // namespace

StudyAxis read_axis(const TomlFields& fields, const std::string& directory) {
  StudyAxis axis;
  axis.place = fields.place();
  const std::string way = way_of(fields);
  if (way == "overlays") {
    if (fields.has("path")) fields.refuse("path", "axis.path goes not with axis.overlays");
    fields.need("name", "what the overlays differ in, for tables");
    for (const auto& [name, place] : fields.texts("overlays")) {
      axis.overlays.push_back((std::filesystem::path(directory) / name).string());
    }
  } else {
    fields.need("path", "what is varied, as module.count");
    axis.path = path_of(fields);
    if (way == "values") {
      axis.values = listed(fields, axis.path, directory);
    } else {
      axis.range = computed(fields, facts_of(axis.path));
    }
  }
  if (fields.has("labels")) axis.labels = labels(fields, axis);
  axis.name = fields.has("name") ? fields.text("name") : axis.path.path();
  check_name(axis.name, fields.has("name") ? "axis.name" : "axis.path",
             fields.place(fields.has("name") ? "name" : "path"));
  if (is_column(axis.name)) {
    fields.refuse(fields.has("name") ? "name" : "path",
                  "axis.name = \"" + axis.name +
                      "\" is that of another column of the study's tables: give another one");
  }
  return axis;
}

}  // namespace lilytank
