// A point of a search as files that `lilytank run` and `lilytank study` read.
#include "io/scenario_text.hpp"
#include "optimize/source.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

std::string toml_of(const TomlValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  return shortest(std::get<double>(value));
}

}  // namespace

void Optimization::Source::add_commands(const DecodedPoint& point, const std::string& after_file,
                                        ScenarioText& out) const {
  for (std::size_t i = 1; i < point.powers.size(); ++i) {
    out.table("[command]");
    if (plan.agitation == Agitation::feedback) {
      out.line("copies", std::to_string(i));
    } else {
      out.number("at", point.changes[i - 1], "s");
    }
    out.quoted("do", "pump_power"), out.number("power", point.powers[i], "%");
  }
  if (point.after_copies == 0) return;
  out.table("[command]");
  out.line("copies", std::to_string(point.after_copies));
  out.quoted("do", "ruleset"), out.quoted("file", after_file);
}

std::vector<Scenario::Attachment> Optimization::Source::overlay(const std::vector<double>& point,
                                                                const std::string& stem,
                                                                const std::string& comment) const {
  const DecodedPoint what = decoded(point);
  const Layer says = layer(what);
  ScenarioText out;
  out.comment(comment);
  std::vector<Scenario::Attachment> files;
  const std::string rules_file = stem + ".rules", after_file = stem + "-after.rules";
  if (ruleset) {
    out.quoted("ruleset.file", rules_file);
    files.push_back({rules_file, to_text(*ruleset)});
    // Of all its rules: a scenario below may speak of rules with the same names.
    const Scenario all = scenario(point);
    for (const Rule& rule : all.model.rulesets.front().rules) {
      out.number("rules." + rule.name + ".p", rule.p);
    }
  }
  for (const Assignment& value : says.values) {
    if (!ruleset || value.keys.front() != "rules") out.line(value.path(), toml_of(value.value));
  }
  if (what.after_copies > 0) {
    const Ruleset first = built(says).model.rulesets.front();
    files.push_back({after_file, to_text(second_set(what, first))});
  }
  add_commands(what, after_file, out);
  files.insert(files.begin(), {stem + ".toml", out.text()});
  return files;
}

}  // namespace lilytank
