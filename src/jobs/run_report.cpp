// The report of a finished run as a document, from the files in its directory.
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/json.hpp"
#include "jobs/bonds.hpp"
#include "jobs/run_directory.hpp"
#include "lilytank/run.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

/// The first `columns` cells of each row of a table that the run wrote; later ones may hold commas.
ReportTable table_of(const std::string& file, std::vector<std::string> head) {
  ReportTable table;
  table.head = std::move(head);
  const std::string text = read_whole(file);
  for (std::size_t at = text.find('\n') + 1; at < text.size();) {
    const std::string row = text.substr(at, text.find('\n', at) - at);
    at += row.size() + 1;
    if (row.starts_with('#')) continue;
    std::vector<std::string> cells;
    for (std::size_t begin = 0; cells.size() < table.head.size();) {
      const std::size_t end = row.find(',', begin);
      cells.push_back(row.substr(begin, end - begin));
      begin = end == std::string::npos ? row.size() : end + 1;
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

std::string seconds_list(const Json& times) {
  std::vector<double> values = times.get<std::vector<double>>();
  return joined(values, ", ", without_rounding) + " s";
}

ReportCard card_of(const Json& summary, const Model& model) {
  ReportCard card;
  const int copies = summary["copies"], possible = summary["possible_copies"];
  const std::string simulated =
      without_rounding(summary["time_s"]) + " s of " + std::to_string(model.module.count) +
      " modules" +
      (model.ball.count > 0 ? " and " + std::to_string(model.ball.count) + " balls" : "");
  if (summary["status"] != "complete") {
    card.tone = ReportTone::fault;
    card.verdict = "the simulation diverged at step " + json_line(summary["diverged_step"]);
  } else if (possible > 0) {
    card.tone = copies == possible ? ReportTone::good : ReportTone::neutral;
    card.verdict = std::to_string(copies) + " of " + std::to_string(possible) +
                   " possible copies are complete";
  } else {
    card.verdict = "simulated " + simulated;
  }
  card.facts = {
      {"simulated", simulated},
      {"seed", json_line(summary["seed"])},
      {"illegal assemblies", json_line(summary["illegal"])},
      {"deepest overlap", significant(1000 * double(summary["deepest_overlap_m"]), 2) + " mm"},
      {"fingerprint", summary["fingerprint"]}};
  if (summary.contains("ended")) {
    card.facts.insert(card.facts.begin(), {"ended", std::string(summary["ended"])});
  }
  if (!summary["completion_times_s"].empty()) {
    card.facts.insert(card.facts.begin(),
                      {"completed at", seconds_list(summary["completion_times_s"])});
  }
  return card;
}

}  // namespace

ReportDocument run_report(const StoredRun& run, const std::string& dir) {
  const auto path = [&](const char* name) { return (std::filesystem::path(dir) / name).string(); };
  const Json summary = json_of(read_whole(path(run_file::summary_json)));
  ReportDocument report;
  report.title = "Run of " + (run.scenario.title.empty() ? "a scenario" : run.scenario.title);
  report.subtitle = "identity of the scenario " + std::string(summary["scenario"]);
  report.card = card_of(summary, run.scenario.model);
  const std::string events = path(run_file::events);
  ReportSection species, rules,
      bonds = bonds_section(
          bonds_of(read_events(read_whole(events), events, run.scenario.model.module.count),
                   run.scenario.model),
          summary["time_s"]);
  species.title = "Assemblies";
  species.table = table_of(path(run_file::species),
                           {"shape", "modules", "legal", "target", "present at the end"});
  rules.title = "Rules", rules.detail = true;
  rules.table = table_of(path(run_file::rules), {"ruleset", "rule", "kind", "p", "times applied"});
  for (ReportSection* section : {&species, &bonds, &rules}) {
    if (!section->table.rows.empty()) report.sections.push_back(std::move(*section));
  }
  return report;
}

}  // namespace lilytank
