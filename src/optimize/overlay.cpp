// A point of a search as files that `lilytank run` and `lilytank study` read.
#include "io/scenario_values.hpp"
#include "optimize/source.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

std::string commented(const std::string& lines) {
  std::string out;
  for (std::size_t at = 0; at < lines.size();) {
    const auto end = std::min(lines.find('\n', at), lines.size());
    out += "# " + lines.substr(at, end - at) + "\n";
    at = end + 1;
  }
  return out;
}

std::string toml_of(const TomlValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  return shortest(std::get<double>(value));
}

std::string line_of(const Assignment& value) {
  return value.path() + " = " + toml_of(value.value) + "\n";
}

}  // namespace

std::string Optimization::Source::commands_text(const Meaning& meaning,
                                                const std::string& after_file) const {
  std::string out;
  for (std::size_t i = 1; i < meaning.powers.size(); ++i) {
    const bool feedback = plan.agitation == Agitation::feedback;
    out += "\n[[command]]\n" +
           (feedback ? "copies = " + std::to_string(i)
                     : "at = " + shortest(meaning.changes[i - 1]) + "  # s") +
           "\ndo = \"pump_power\"\npower = " + shortest(meaning.powers[i]) + "  # %\n";
  }
  if (meaning.after_copies == 0) return out;
  return out + "\n[[command]]\ncopies = " + std::to_string(meaning.after_copies) +
         "\ndo = \"ruleset\"\nfile = " + toml_quoted(after_file) + "\n";
}

std::vector<Scenario::Attachment> Optimization::Source::overlay(const std::vector<double>& point,
                                                                const std::string& stem,
                                                                const std::string& comment) const {
  const Meaning what = meaning(point);
  const Layer says = layer(what);
  std::string text = commented(comment);
  std::vector<Scenario::Attachment> files;
  const std::string rules_file = stem + ".rules", after_file = stem + "-after.rules";
  if (ruleset) {
    text += "ruleset.file = " + toml_quoted(rules_file) + "\n";
    files.push_back({rules_file, to_text(*ruleset)});
    // Of all its rules: a scenario below may speak of rules with the same names.
    const Scenario all = scenario(point);
    for (const Rule& rule : all.model.rulesets.front().rules) {
      text += "rules." + rule.name + ".p = " + shortest(rule.p) + "\n";
    }
  }
  for (const Assignment& value : says.values) {
    if (!ruleset || value.keys.front() != "rules") text += line_of(value);
  }
  if (what.after_copies > 0) {
    const Ruleset first = built(says).model.rulesets.front();
    files.push_back({after_file, to_text(second_set(what, first))});
  }
  text += commands_text(what, after_file);
  files.insert(files.begin(), {stem + ".toml", text});
  return files;
}

}  // namespace lilytank
