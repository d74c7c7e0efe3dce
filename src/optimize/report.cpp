// The report of an optimisation as a document.
#include <cmath>

#include "lilytank/optimize.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

std::string printed(double value) {
  return significant(value, 4);
}

std::string with_unit(const OptimizationPlan& plan, double value) {
  const std::string unit = fitness_unit(plan.fitness.fitness);
  return printed(value) + (unit == "1" ? "" : " " + unit);
}

ReportCard card_of(const OptimizationPlan& plan, const OptimizationResult& result) {
  ReportCard card;
  const std::string what = name_of(plan.fitness.fitness);
  card.tone = std::isfinite(result.best.mean) ? ReportTone::good : ReportTone::fault;
  card.verdict = std::isfinite(result.best.mean)
                     ? "best " + what + " " + with_unit(plan, result.best.mean)
                     : "no optimum: at every point that was evaluated a simulation diverged";
  card.facts = {
      {"standard error", with_unit(plan, result.best.standard_error) + " of " +
                             std::to_string(result.best.evaluations) + " evaluations"},
      {"target", std::to_string(plan.possible) + (plan.possible == 1 ? " copy" : " copies") +
                     " within " + shortest(plan.horizon) + " s"},
      {"search", plan.method + ", " + std::to_string(plan.budget) + " evaluations"}};
  if (!result.optimum.empty())
    card.facts.emplace_back("next", "simulate with the overlay optimum.toml");
  return card;
}

ReportSection point_section(const OptimizationPlan& plan, const OptimizationResult& result) {
  ReportSection section;
  section.title = "Best point";
  section.table.head = {"parameter", "start", "best", "range from", "to"};
  // The winner of a race has rules of its own, which the optimum's file lists.
  if (result.best.point.size() != plan.space.size() || !result.race.empty()) return section;
  for (std::size_t i = 0; i < plan.space.size(); ++i) {
    const SearchAxis& axis = plan.space[i];
    section.table.rows.push_back({axis.name, printed(plan.start[i]), printed(result.best.point[i]),
                                  printed(axis.low), printed(axis.high)});
  }
  return section;
}

ReportSection race_section(const OptimizationResult& result) {
  ReportSection section;
  section.title = "Race of rulesets";
  section.table.head = {"ruleset",        "last round", "best in that round",
                        "standard error", "kept",       "last comparison"};
  for (const RaceEntry& entry : result.race) {
    section.table.rows.push_back({entry.ruleset, std::to_string(entry.round), printed(entry.best),
                                  printed(entry.standard_error), entry.kept ? "yes" : "no",
                                  entry.last ? printed(*entry.last) : "-"});
  }
  return section;
}

}  // namespace

ReportDocument optimization_report(const OptimizationPlan& plan, const OptimizationResult& result) {
  ReportDocument report;
  report.title = "Optimisation " + plan.name;
  report.subtitle = name_of(plan.fitness.fitness) + " over " + std::to_string(plan.space.size()) +
                    (plan.space.size() == 1 ? " parameter" : " parameters");
  report.card = card_of(plan, result);
  report.sections.push_back(point_section(plan, result));
  if (report.sections.back().table.rows.empty()) report.sections.pop_back();
  if (!result.race.empty()) report.sections.push_back(race_section(result));
  for (const std::string& label : result.left_out) {
    report.warnings.push_back(label + " is the optimum itself and not compared with it");
  }
  return report;
}

}  // namespace lilytank
