// The files of a diagnosis.
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "lilytank/diagnosis.hpp"

namespace lilytank {
namespace {

std::string number(double value) {
  if (!std::isfinite(value)) return "null";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n') {
      out += "\\n";
    } else if (static_cast<unsigned char>(c) >= 0x20) {
      out += c;
    }
  }
  return out + "\"";
}

template <class List, class Text>
std::string joined(const List& list, const std::string& between, Text&& text) {
  std::string out;
  for (const auto& one : list) out += (out.empty() ? "" : between) + text(one);
  return out;
}

std::string finding_json(const DiagnosisFinding& f) {
  std::string out =
      "\n    {\"effect\": " + quoted(f.effect) + ", \"alternatives\": [" +
      joined(f.alternatives, ", ", quoted) + "], \"confidence\": " + number(f.confidence) +
      ",\n     \"where\": {\"variable\": " + quoted(f.variable) + ", \"from\": " + number(f.from) +
      ", \"to\": " + number(f.to) + ", \"unit\": " + quoted(f.unit) +
      ", \"text\": " + quoted(f.text) + "},\n     \"equation\": " + quoted(f.equation) +
      ", \"split\": " + quoted(f.split) + ",\n     \"parameters\": [";
  out += joined(f.parameters, ", ", [](const FoundParameter& p) {
    return "{\"name\": " + quoted(p.name) + ", \"value\": " + number(p.value) +
           ", \"low\": " + number(p.low) + ", \"high\": " + number(p.high) +
           ", \"unit\": " + quoted(p.unit) + "}";
  });
  return out + "],\n     \"held_out\": {\"log_likelihood_gain\": " + number(f.gain) +
         ", \"low\": " + number(f.gain_low) + ", \"high\": " + number(f.gain_high) +
         ", \"unit\": \"nat\"}}";
}

std::string maps_csv(const Diagnosis& d) {
  std::string out = "variable,direction,at,unit,value,deviation,value_unit,curve_z\n";
  for (const FoundCurve& c : d.maps) {
    for (std::size_t k = 0; k < c.at.size(); ++k) {
      out += c.variable + "," + c.direction + "," + number(c.at[k]) + "," + c.unit + "," +
             number(c.value[k]) + "," + number(c.deviation[k]) + "," + c.value_unit + "," +
             number(c.z) + "\n";
    }
  }
  return out;
}

std::string ranking_csv(const Diagnosis& d) {
  std::string out = "effect,z\n";
  for (const auto& [name, z] : d.ranking) out += name + "," + number(z) + "\n";
  return out;
}

std::string fit_csv(const Diagnosis& d) {
  std::string out = "numbers,before,after,share_removed\n";
  for (const GroupFit& g : d.held_out) {
    out +=
        g.group + "," + number(g.before) + "," + number(g.after) + "," + number(g.removed()) + "\n";
  }
  return out;
}

}  // namespace

std::string diagnosis_json(const Diagnosis& d) {
  std::string out = "{\"schema\": \"diagnosis/1\", \"name\": " + quoted(d.name) +
                    ", \"verdict\": " + quoted(name_of(d.verdict)) + ",\n  \"findings\": [";
  out += joined(d.findings, ",", finding_json);
  out += "],\n  \"fit\": {\"msd\": {\"before\": " + number(d.msd_before) +
         ", \"after\": " + number(d.msd_after) + ", \"share_removed\": " + number(d.msd_removed) +
         ", \"low\": " + number(d.msd_low) + ", \"high\": " + number(d.msd_high) + "}},\n";
  out += "  \"parameters\": [" +
         joined(d.parameters, ",",
                [](const MovedParameter& p) {
                  return "\n    {\"path\": " + quoted(p.path) +
                         ", \"alone\": " + number(p.baseline) +
                         ", \"value\": " + number(p.with_effects) + ", \"low\": " + number(p.low) +
                         ", \"high\": " + number(p.high) + ", \"unit\": " + quoted(p.unit) + "}";
                }) +
         "],\n";
  out += "  \"detectable\": [" + joined(d.detectable, ",", [](const Detectable& one) {
           return "\n    {\"effect\": " + quoted(one.effect) +
                  ", \"smallest\": " + number(one.smallest) + ", \"unit\": " + quoted(one.unit) +
                  "}";
         });
  return out + "]}\n";
}

std::vector<std::string> write_diagnosis(const Diagnosis& d, const std::string& dir) {
  const std::filesystem::path path(dir);
  std::error_code problem;
  std::filesystem::create_directories(path, problem);
  if (problem) throw InputError(system_problem("cannot make", dir, problem.value()));
  std::vector<std::pair<std::string, std::string>> files{{"diagnosis.json", diagnosis_json(d)},
                                                         {"diagnosis.txt", diagnosis_text(d)}};
  if (!d.overlay.empty()) files.emplace_back("missing.toml", d.overlay);
  if (!d.flow_csv.empty()) files.emplace_back("flow.csv", d.flow_csv);
  if (!d.maps.empty()) files.emplace_back("maps.csv", maps_csv(d));
  if (!d.ranking.empty()) files.emplace_back("ranking.csv", ranking_csv(d));
  if (!d.held_out.empty()) files.emplace_back("fit.csv", fit_csv(d));
  std::vector<std::string> names;
  for (const auto& [name, content] : files) {
    write_atomically((path / name).string(), content);
    names.push_back(name);
  }
  return names;
}

}  // namespace lilytank
