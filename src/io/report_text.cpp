#include "lilytank/report.hpp"
#include "statistics/text_table.hpp"

namespace lilytank {
namespace {

void add_section(const ReportSection& section, std::string& out) {
  out += "\n" + section.title + "\n";
  for (const std::string& line : section.above) out += "  " + line + "\n";
  if (!section.table.rows.empty()) {
    TextTable table(section.table.head);
    for (const auto& row : section.table.rows) table.add(row);
    out += table.text();
  }
  for (const std::string& line : section.below) out += "  " + line + "\n";
}

void add_provenance(const ReportProvenance& p, std::string& out) {
  if (p.command.empty()) return;
  out += "\nProvenance\n  " + p.command + "\n  lilytank " + p.version +
         (p.seed.empty() ? "" : ", seed " + p.seed) + "\n";
  for (const auto& [file, hash] : p.inputs) out += "  " + hash + "  " + file + "\n";
}

}  // namespace

std::string report_text(const ReportDocument& report) {
  std::string out = report.title + ": " + report.card.verdict + "\n";
  if (!report.subtitle.empty()) out += report.subtitle + "\n";
  std::size_t width = 0;
  for (const auto& [name, value] : report.card.facts) width = std::max(width, name.size());
  if (width > 0) out += "\n";
  for (const auto& [name, value] : report.card.facts) {
    out += "  " + name + std::string(width - name.size() + 2, ' ') + value + "\n";
  }
  for (const ReportSection& section : report.sections) add_section(section, out);
  if (!report.warnings.empty()) out += "\n";
  for (const std::string& warning : report.warnings) out += "warning: " + warning + "\n";
  add_provenance(report.provenance, out);
  return out;
}

}  // namespace lilytank
