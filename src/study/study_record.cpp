#include "study/study_record.hpp"

#include <charconv>
#include <limits>

#include "io/atomic_file.hpp"
#include "io/file_digest.hpp"
#include "io/scenario_values.hpp"
#include "io/toml_fields.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();
const std::vector<std::string> kHeadNames{"name",       "scenarios", "sets",    "seed",
                                          "replicates", "axes",      "identity"};

const std::string kFirstWords = kStudyMark;

std::string quoted_list(const std::vector<std::string>& texts) {
  return "[" + joined(texts, ", ", toml_quoted) + "]";
}

std::string setting_text(const Setting& setting) {
  return "\n[[setting]]\nlabel = " + toml_quoted(setting.label) +
         "\ntexts = " + quoted_list(setting.texts) + "\nvalues = [" +
         joined(setting.values, ", ", [](double x) { return shortest(x); }) +
         "]\nduration = " + shortest(setting.duration) + "  # s\nidentity = \"" +
         hex(setting.identity) + "\"\n";
}

std::uint64_t identity_of(const TomlFields& fields) {
  const std::string text = fields.text("identity");
  std::uint64_t value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (problem != std::errc() || end != text.data() + text.size() || text.size() != 16) {
    fields.refuse("identity", "'" + text + "' is not of 16 hex digits");
  }
  return value;
}

/// A list of texts that may be empty.
std::vector<std::string> texts_of(const TomlFields& fields, const std::string& name) {
  std::vector<std::string> out;
  const toml::array* list = fields.node(name)->as_array();
  if (list == nullptr) fields.refuse(name, fields.path(name) + " is a list");
  for (const toml::node& item : *list) {
    if (!item.is_string()) fields.refuse(name, fields.path(name) + " is a list of texts");
    out.push_back(item.as_string()->get());
  }
  return out;
}

std::vector<double> numbers_of(const TomlFields& fields, const std::string& name) {
  std::vector<double> out;
  const toml::array* list = fields.node(name)->as_array();
  if (list == nullptr) fields.refuse(name, fields.path(name) + " is a list");
  for (const toml::node& item : *list) {
    const auto value = item.value<double>();
    if (!value) fields.refuse(name, fields.path(name) + " is a list of numbers");
    out.push_back(*value);
  }
  return out;
}

void need_all(const TomlFields& fields, const std::vector<std::string>& names) {
  for (const std::string& name : names) fields.need(name, "the file is damaged");
}

void read_head(const toml::table& table, const std::string& file, StudyPlan& plan) {
  const TomlFields fields(table, "study", file, kHeadNames);
  need_all(fields, kHeadNames);
  plan.name = fields.text("name");
  plan.scenarios = texts_of(fields, "scenarios");
  plan.sets = texts_of(fields, "sets");
  plan.seed = static_cast<std::uint64_t>(fields.whole("seed", 0, kLargest));
  plan.replicates = static_cast<int>(fields.whole("replicates", 1, 1'000'000'000));
  plan.axes = texts_of(fields, "axes");
}

void read_stop(const toml::table& table, const std::string& file, StudyPlan& plan) {
  const std::vector<std::string> names{"metric", "half_width", "min", "max", "round"};
  const TomlFields fields(table, "stop", file, names);
  need_all(fields, names);
  StoppingRule rule;
  rule.metric = fields.text("metric");
  if (!is_metric(rule.metric)) fields.refuse("metric", "unknown metric '" + rule.metric + "'");
  rule.half_width = fields.number("half_width", metric_unit(rule.metric));
  rule.max = static_cast<int>(fields.whole("max", 1, 1'000'000'000));
  rule.min = static_cast<int>(fields.whole("min", 1, rule.max));
  rule.round = static_cast<int>(fields.whole("round", 1, 1'000'000'000));
  plan.stop = rule;
}

Setting read_setting(const toml::table& table, const std::string& file, std::size_t axes) {
  const std::vector<std::string> names{"label", "texts", "values", "duration", "identity"};
  const TomlFields fields(table, "setting", file, names);
  need_all(fields, names);
  Setting setting;
  setting.label = fields.text("label");
  setting.texts = texts_of(fields, "texts");
  setting.values = numbers_of(fields, "values");
  setting.duration = fields.number("duration", "s");
  setting.identity = identity_of(fields);
  if (setting.texts.size() != axes || setting.values.size() != axes) {
    throw InputError(fields.place(), "setting does not have one value for each axis");
  }
  return setting;
}

}  // namespace

bool is_plan(const std::string& text) {
  return text.starts_with(kFirstWords);
}

std::string plan_text(const StudyPlan& plan) {
  std::string out = kFirstWords +
                    " " LILYTANK_VERSION
                    ". Every value of a setting's scenario\n# decides its identity.\n[study]\n";
  out += "name = " + toml_quoted(plan.name) + "\nscenarios = " + quoted_list(plan.scenarios) +
         "\nsets = " + quoted_list(plan.sets) + "\nseed = " + std::to_string(plan.seed) +
         "\nreplicates = " + std::to_string(plan.replicates) +
         "\naxes = " + quoted_list(plan.axes) + "\nidentity = \"" + hex(plan.identity()) + "\"\n";
  if (plan.stop) {
    const StoppingRule& stop = *plan.stop;
    out += "\n[stop]\nmetric = " + toml_quoted(stop.metric) +
           "\nhalf_width = " + shortest(stop.half_width) + "\nmin = " + std::to_string(stop.min) +
           "\nmax = " + std::to_string(stop.max) + "\nround = " + std::to_string(stop.round) + "\n";
  }
  for (const Setting& setting : plan.settings) out += setting_text(setting);
  return with_checksum_line(out);
}

StudyPlan read_plan(const std::string& file) {
  const std::string text = read_whole(file);
  if (!is_plan(text)) {
    throw InputError("'" + file + "' was not written by a study's run: is it a study file?");
  }
  without_checksum_line(text, file, "--force begins the study again");
  const toml::table root = parse_toml(text, file);
  const TomlFields top(root, "", file, {"study", "stop", "setting"});
  const auto table = [&](const std::string& name) -> const toml::table& {
    const toml::table* found = top.node(name)->as_table();
    if (found == nullptr) top.refuse(name, name + " is a table");
    return *found;
  };
  need_all(top, {"study", "setting"});
  StudyPlan plan;
  read_head(table("study"), file, plan);
  if (top.has("stop")) read_stop(table("stop"), file, plan);
  for (const toml::table* setting : top.tables("setting")) {
    plan.settings.push_back(read_setting(*setting, file, plan.axes.size()));
  }
  const TomlFields head(table("study"), "study", file, kHeadNames);
  if (identity_of(head) != plan.identity()) {
    head.refuse("identity", "the file was changed: study.identity does not fit the settings");
  }
  return plan;
}

}  // namespace lilytank
