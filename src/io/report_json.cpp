#include "io/json.hpp"
#include "lilytank/report.hpp"

namespace lilytank {
namespace {

Json section_json(const ReportSection& section) {
  Json out{{"title", section.title}};
  out["above"] = section.above;
  out["table"] = {{"head", section.table.head}, {"rows", section.table.rows}};
  out["below"] = section.below;
  return out;
}

Json pairs_json(const std::vector<std::pair<std::string, std::string>>& pairs) {
  Json out = Json::object();
  for (const auto& [name, value] : pairs) out[name] = value;
  return out;
}

}  // namespace

std::string report_json(const ReportDocument& report) {
  Json out{{"title", report.title}, {"subtitle", report.subtitle}};
  out["verdict"] = report.card.verdict;
  out["facts"] = pairs_json(report.card.facts);
  out["sections"] = Json::array();
  for (const ReportSection& section : report.sections) {
    out["sections"].push_back(section_json(section));
  }
  out["warnings"] = report.warnings;
  const ReportProvenance& p = report.provenance;
  out["provenance"] = {{"command", p.command}, {"version", p.version}, {"seed", p.seed}};
  out["provenance"]["inputs"] = pairs_json(p.inputs);
  return json_text(out);
}

}  // namespace lilytank
