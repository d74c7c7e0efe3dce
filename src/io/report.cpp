#include <algorithm>
#include <string_view>

#include "io/json.hpp"
#include "lilytank/report.hpp"
#include "statistics/text_table.hpp"
#include "text/words.hpp"

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

constexpr std::string_view kStyle = R"(
:root{--ink:#1d2630;--dim:#5b6875;--paper:#fff;--panel:#f4f6f8;--line:#d8dee4;--tone:#5b6875}
@media (prefers-color-scheme:dark){:root{--ink:#e6ebf0;--dim:#9fb0c0;--paper:#14191f;--panel:#1e252d;
--line:#36414c;--tone:#9fb0c0}}
.good{--tone:#1d7f4e}.finding{--tone:#0b5c9e}.fault{--tone:#b4540a}
@media (prefers-color-scheme:dark){.good{--tone:#5cc48d}.finding{--tone:#69b2f0}.fault{--tone:#f0a35e}}
*{box-sizing:border-box}
body{font:16px/1.5 system-ui,sans-serif;max-width:66em;margin:0 auto;padding:1.5em 1em 4em;color:var(--ink);
background:var(--paper);overflow-wrap:anywhere}
h1{font-size:1.5em;margin:0 0 .6em}h2{font-size:1.15em;margin:2em 0 .5em}
.sub{color:var(--dim);margin:-.6em 0 1.2em}
.card{background:var(--panel);border-left:6px solid var(--tone);border-radius:6px;padding:1em 1.2em}
.card p{font-size:1.25em;font-weight:600;margin:0;color:var(--tone)}
.card p::first-letter{text-transform:uppercase}
.card dl{display:grid;grid-template-columns:max-content 1fr;gap:.3em 1.2em;margin:.8em 0 0}
.card dt{color:var(--dim)}.card dd{margin:0}
@media (max-width:34em){.card dl{grid-template-columns:1fr;gap:0}.card dd{margin-bottom:.5em}}
.scroll{overflow-x:auto;overflow-wrap:normal}
table{border-collapse:collapse;font-variant-numeric:tabular-nums}
th,td{padding:.25em .8em;border-bottom:1px solid var(--line);text-align:left;white-space:nowrap}
th{color:var(--dim);font-weight:600}th.n,td.n{text-align:right}
figure{margin:1.5em 0}figure svg{display:block;max-width:100%;height:auto;background:#fff;border-radius:6px}
figcaption{color:var(--dim);font-size:.92em;margin-top:.4em}
.warnings{border-left:6px solid #b4540a;padding:.8em 1.2em .8em 2.2em;margin:0;background:var(--panel);border-radius:6px}
details{margin:2em 0 0}summary{cursor:pointer;font-weight:600;font-size:1.15em}
code{overflow-wrap:anywhere}
.provenance{color:var(--dim);font-size:.85em}
@media print{body{max-width:none;padding:0;background:#fff;color:#000}details>*{display:block}
figure,table,.card{break-inside:avoid}}
)";

std::string element(const std::string& name, const std::string& text) {
  return "<" + name + ">" + escaped(text) + "</" + name + ">";
}

bool is_number(const std::string& cell) {
  return cell.find_first_of("0123456789") != std::string::npos &&
         cell.find_first_not_of("+-.0123456789einf% ><[],") == std::string::npos;
}

std::string table_html(const ReportTable& table) {
  if (table.rows.empty()) return "";
  std::string out = "<div class=\"scroll\"><table><thead><tr>";
  for (std::size_t c = 0; c < table.head.size(); ++c) {
    const bool numbers = std::all_of(table.rows.begin(), table.rows.end(),
                                     [&](const auto& row) { return is_number(row[c]); });
    out += (numbers ? "<th class=\"n\">" : "<th>") + escaped(table.head[c]) + "</th>";
  }
  out += "</tr></thead>\n<tbody>";
  for (const auto& row : table.rows) {
    out += "<tr>";
    for (const std::string& cell : row) {
      out += (is_number(cell) ? "<td class=\"n\">" : "<td>") + escaped(cell) + "</td>";
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string section_html(const ReportSection& section) {
  std::string body;
  for (const std::string& line : section.above) body += element("p", line) + "\n";
  body += table_html(section.table);
  for (const std::string& line : section.below) body += element("p", line) + "\n";
  if (section.detail) {
    return "<details>" + element("summary", section.title) + "\n" + body + "</details>\n";
  }
  return element("h2", section.title) + "\n" + body;
}

std::string card_html(const ReportCard& card) {
  constexpr const char* kTones[] = {"neutral", "good", "finding", "fault"};
  std::string out = "<div class=\"card " + std::string(kTones[static_cast<int>(card.tone)]) +
                    "\">" + element("p", card.verdict);
  if (!card.facts.empty()) out += "<dl>";
  for (const auto& [name, value] : card.facts) out += element("dt", name) + element("dd", value);
  if (!card.facts.empty()) out += "</dl>";
  return out + "</div>\n";
}

/// A picture as text inside the page: ids of one picture must not be those of another.
std::string picture_html(const ReportPicture& picture) {
  std::string svg = picture.svg;
  const auto begin = svg.find("<svg");
  if (begin == std::string::npos) return "";
  svg.erase(0, begin);
  const std::string prefix = picture.name + "-";
  for (const std::string mark : {"id=\"", "href=\"#", "url(#"}) {
    for (std::size_t at = svg.find(mark); at != std::string::npos;
         at = svg.find(mark, at + mark.size())) {
      const bool in_tag = svg[svg.find_last_of("<>", at)] == '<';  // not in a name from input
      if (in_tag) svg.insert(at + mark.size(), prefix);
    }
  }
  svg.insert(std::string_view("<svg").size(),
             " role=\"img\" aria-label=\"" + escaped(picture.caption) + "\"");
  return "<figure>" + svg + element("figcaption", picture.caption) + "</figure>\n";
}

std::string warnings_html(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return "";
  std::string out = "<h2>Warnings</h2>\n<ul class=\"warnings\">";
  for (const std::string& warning : warnings) out += element("li", warning) + "\n";
  return out + "</ul>\n";
}

std::string provenance_html(const ReportProvenance& p) {
  if (p.command.empty()) return "";
  std::string out = "<h2>Provenance</h2>\n<div class=\"provenance\"><p>" +
                    element("code", p.command) + "<br>lilytank " + escaped(p.version) +
                    (p.seed.empty() ? "" : ", seed " + escaped(p.seed)) + "</p>\n";
  if (!p.inputs.empty()) out += "<p>SHA-256 of the inputs:";
  for (const auto& [file, hash] : p.inputs) {
    out += "<br>" + element("code", hash) + " " + escaped(file);
  }
  return out + (p.inputs.empty() ? "" : "</p>") + "</div>\n";
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

std::string report_html(const ReportDocument& report, const std::vector<ReportPicture>& pictures) {
  std::string out =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">"
      "<meta name=\"color-scheme\" content=\"light dark\">" +
      element("title", report.title) + "\n<style>" + std::string(kStyle) +
      "</style></head>\n<body>\n" + element("h1", report.title) + "\n";
  if (!report.subtitle.empty()) {
    out += "<p class=\"sub\">" + escaped(report.subtitle) + "</p>\n";
  }
  out += card_html(report.card);
  if (!pictures.empty()) out += picture_html(pictures.front());
  out += warnings_html(report.warnings);
  for (const ReportSection& section : report.sections) {
    if (!section.detail) out += section_html(section);
  }
  for (std::size_t i = 1; i < pictures.size(); ++i) out += picture_html(pictures[i]);
  for (const ReportSection& section : report.sections) {
    if (section.detail) out += section_html(section);
  }
  return out + provenance_html(report.provenance) + "</body></html>\n";
}

}  // namespace lilytank
