#include "jobs/report.hpp"

#include "io/json.hpp"
#include "jobs/early_end.hpp"
#include "lilytank/start.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

std::string word_of(RuleKind kind) {
  constexpr const char* words[] = {"link", "unlink", "update"};
  return words[static_cast<int>(kind)];
}

/// "5 singles, 1 of 2, 2 of 5 modules".
std::string sizes_text(const std::vector<int>& by_size) {
  std::string out;
  for (std::size_t n = 1; n < by_size.size(); ++n) {
    if (by_size[n] == 0) continue;
    out += (out.empty() ? "" : ", ") + std::to_string(by_size[n]);
    out += n == 1 ? " single" : " of " + std::to_string(n);
  }
  return out.empty() ? "none" : out;
}

/// Seconds as they are printed, without the rounding of a product.
double printed(double seconds) {
  return json_of(without_rounding(seconds)).get<double>();
}

std::string line(std::string name, const std::string& value) {
  name.resize(16, ' ');
  return name + value + "\n";
}

std::string bodies_text(const Model& model) {
  std::string out = std::to_string(model.module.count) + " modules";
  if (model.ball.count > 0) out += ", " + std::to_string(model.ball.count) + " balls";
  return out;
}

}  // namespace

std::string rules_table(const Model& model, const AssemblyRecord& record) {
  std::string out = "ruleset,rule,kind,p,firings\n";
  for (std::size_t r = 0; r < model.rulesets.size(); ++r) {
    const Ruleset& rules = model.rulesets[r];
    for (std::size_t k = 0; k < rules.rules.size(); ++k) {
      const Rule& rule = rules.rules[k];
      out += rules.name + "," + rule.name + "," + word_of(rule.kind) + "," + shortest(rule.p) +
             "," + std::to_string(record.firings()[r][k]) + "\n";
    }
  }
  return out;
}

std::string species_table(const AssemblyRecord& record) {
  std::string out = "drawing,size,legal,target,standing,species\n";
  for (const auto& [key, species] : record.seen()) {
    const auto found = record.standing().find(key);
    const int standing = found == record.standing().end() ? 0 : found->second;
    out += species.drawing + "," + std::to_string(species.size) + "," +
           (species.legal ? "1," : "0,") + (species.target ? "1," : "0,") +
           std::to_string(standing) + ",\"" + key + "\"\n";
  }
  return out;
}

std::string divergence_text(const Divergence& d, const Model& model) {
  const std::string when = " at " + without_rounding(static_cast<double>(d.step) * model.dt) +
                           " s (step " + std::to_string(d.step) + "): " + body_name(model, d.body);
  if (d.force == kStalled) {
    return "stalled" + when + " and what it touches take more than " + shortest(d.size) +
           " visits of contacts in one step";
  }
  return "diverged" + when + ", largest force " + std::string(d.force) + ", " + shortest(d.size) +
         " N";
}

std::string summary_text(const Scenario& scenario, const World& world, const AssemblyRecord& record,
                         const Outcome& outcome) {
  const Model& model = scenario.model;
  const bool diverged = outcome.status == RunStatus::diverged;
  std::string out = line("scenario", scenario.title.empty() ? "(no title)" : scenario.title);
  out += line("seed", std::to_string(scenario.seed));
  out += line("status", diverged ? divergence_text(outcome.divergence, model) : "complete");
  if (scenario.end.early() && !diverged) out += line("ended", end_text(scenario, world, record));
  out += line("simulated", without_rounding(world.time()) + " s of " + bodies_text(model));
  if (record.possible_copies() > 0) {
    out += line("copies", std::to_string(record.copies()) + " of " +
                              std::to_string(record.possible_copies()) + " possible, most " +
                              std::to_string(record.most_copies()));
    if (!record.completion_times().empty()) {
      out += line("completed at", joined(record.completion_times(), ", ", without_rounding) + " s");
    }
  }
  if (model.module.count > 0) out += line("assemblies", sizes_text(record.by_size()));
  if (!model.rulesets.empty()) out += line("illegal", std::to_string(record.illegal()));
  return out + line("fingerprint", hex(fingerprint(world.state())));
}

std::string summary_json(const Scenario& scenario, const World& world, const AssemblyRecord& record,
                         const Outcome& outcome) {
  const bool diverged = outcome.status == RunStatus::diverged;
  Json json;
  json["program"] = "lilytank " LILYTANK_VERSION;
  json["title"] = scenario.title;
  json["scenario"] = hex(scenario.identity);
  json["seed"] = scenario.seed;
  json["status"] = diverged ? "diverged" : "complete";
  if (scenario.end.early() && !diverged) json["ended"] = end_text(scenario, world, record);
  json["time_s"] = printed(world.time());
  json["steps"] = world.steps();
  json["modules"] = scenario.model.module.count;
  json["balls"] = scenario.model.ball.count;
  json["copies"] = record.copies();
  json["most_copies"] = record.most_copies();
  json["possible_copies"] = record.possible_copies();
  json["completion_times_s"] = Json::array();
  for (const double time : record.completion_times()) {
    json["completion_times_s"].push_back(printed(time));
  }
  json["assemblies_by_size"] = Json::array();
  for (std::size_t n = 1; n < record.by_size().size(); ++n) {
    json["assemblies_by_size"].push_back(record.by_size()[n]);
  }
  json["illegal"] = record.illegal();
  json["evaluations"] = outcome.tallies.evaluations;
  json["snaps_refused"] = outcome.tallies.snaps_refused;
  json["moves_undone"] = outcome.tallies.moves_undone;
  json["deepest_overlap_m"] = outcome.tallies.deepest_overlap;
  if (diverged) {
    json["diverged_step"] = outcome.divergence.step;
    json["diverged_body"] = outcome.divergence.body;
    json["diverged_force"] = std::string(outcome.divergence.force);
    const bool stalled = outcome.divergence.force == kStalled;
    json[stalled ? "visits_allowed" : "diverged_force_N"] = outcome.divergence.size;
  }
  json["fingerprint"] = hex(fingerprint(world.state()));
  return json_text(json);
}

}  // namespace lilytank
