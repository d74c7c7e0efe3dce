// The files of a diagnosis.

#include "io/atomic_file.hpp"
#include "lilytank/diagnosis.hpp"
#include "study/claimed_directory.hpp"
#include "text/json.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

std::string finding_json(const DiagnosisFinding& f) {
  std::string out = "\n    {\"effect\": " + json_quoted(f.effect) + ", \"alternatives\": [" +
                    joined(f.alternatives, ", ", json_quoted) +
                    "], \"confidence\": " + json_number(f.confidence) +
                    ",\n     \"where\": {\"variable\": " + json_quoted(f.variable) +
                    ", \"from\": " + json_number(f.from) + ", \"to\": " + json_number(f.to) +
                    ", \"unit\": " + json_quoted(f.unit) + ", \"text\": " + json_quoted(f.text) +
                    "},\n     \"equation\": " + json_quoted(f.equation) +
                    ", \"split\": " + json_quoted(f.split) + ",\n     \"parameters\": [";
  out += joined(f.parameters, ", ", [](const FoundParameter& p) {
    return "{\"name\": " + json_quoted(p.name) + ", \"value\": " + json_number(p.value) +
           ", \"low\": " + json_number(p.low) + ", \"high\": " + json_number(p.high) +
           ", \"unit\": " + json_quoted(p.unit) + "}";
  });
  return out + "],\n     \"held_out\": {\"log_likelihood_gain\": " + json_number(f.gain) +
         ", \"low\": " + json_number(f.gain_low) + ", \"high\": " + json_number(f.gain_high) +
         ", \"unit\": \"nat\"}}";
}

std::string number(double value) {
  return significant(value, 6);
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
  std::string out = "effect,variant,z\n";
  for (const RankedEffect& r : d.ranking) {
    out += r.effect + ",\"" + r.variant + "\"," + number(r.z) + "\n";
  }
  return out;
}

std::string fit_csv(const Diagnosis& d) {
  std::string out = "numbers,before,after,chance,deviation_of_chance,share_removed\n";
  for (const GroupFit& g : d.held_out) {
    out += g.group + "," + number(g.before) + "," + number(g.after) + "," + number(g.chance) + "," +
           number(g.deviation) + "," + number(g.removed()) + "\n";
  }
  return out;
}

}  // namespace

std::string diagnosis_json(const Diagnosis& d) {
  std::string out = "{\"schema\": \"diagnosis/1\", \"name\": " + json_quoted(d.name) +
                    ", \"verdict\": " + json_quoted(name_of(d.verdict)) + ",\n  \"findings\": [";
  out += joined(d.findings, ",", finding_json);
  out += "],\n  \"fit\": {\"msd\": {\"before\": " + json_number(d.msd_before) +
         ", \"after\": " + json_number(d.msd_after) +
         ", \"share_removed\": " + json_number(d.msd_removed) +
         ", \"low\": " + json_number(d.msd_low) + ", \"high\": " + json_number(d.msd_high) +
         "}},\n";
  out += "  \"parameters\": [" +
         joined(d.parameters, ",",
                [](const MovedParameter& p) {
                  return "\n    {\"path\": " + json_quoted(p.path) +
                         ", \"alone\": " + json_number(p.baseline) +
                         ", \"value\": " + json_number(p.with_effects) +
                         ", \"low\": " + json_number(p.low) + ", \"high\": " + json_number(p.high) +
                         ", \"unit\": " + json_quoted(p.unit) + "}";
                }) +
         "],\n";
  out += "  \"detectable\": [" + joined(d.detectable, ",", [](const Detectable& one) {
           return "\n    {\"effect\": " + json_quoted(one.effect) +
                  ", \"parameter\": " + json_quoted(one.parameter()) +
                  ", \"smallest\": " + json_number(one.smallest) +
                  ", \"tried\": " + json_number(one.tried) +
                  ", \"unit\": " + json_quoted(one.unit) + "}";
         });
  return out + "]}\n";
}

std::vector<std::string> diagnosis_files() {
  return with_figures({"diagnosis.json", "diagnosis.txt", "missing.toml", "flow.csv", "maps.csv",
                       "ranking.csv", "fit.csv", "report.html"},
                      {"laws", "fit", "maps"});
}

std::vector<std::string> write_diagnosis(const Diagnosis& d, const ReportDocument& report,
                                         const std::string& dir) {
  std::vector<std::pair<std::string, std::string>> files{{"diagnosis.json", diagnosis_json(d)},
                                                         {"diagnosis.txt", report_text(report)}};
  if (!d.overlay.empty()) files.emplace_back("missing.toml", d.overlay);
  if (!d.flow_csv.empty()) files.emplace_back("flow.csv", d.flow_csv);
  if (!d.maps.empty()) files.emplace_back("maps.csv", maps_csv(d));
  if (!d.ranking.empty()) files.emplace_back("ranking.csv", ranking_csv(d));
  if (!d.held_out.empty()) files.emplace_back("fit.csv", fit_csv(d));
  return write_files(dir, files);
}

}  // namespace lilytank
