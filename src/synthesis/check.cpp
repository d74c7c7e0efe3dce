// What can be proved about a ruleset, and the report of it.
#include <algorithm>
#include <set>

#include "lilytank/lattice.hpp"
#include "lilytank/random.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

std::string many(std::int64_t n, const std::string& one, const std::string& more) {
  return std::to_string(n) + " " + (n == 1 ? one : more);
}

void judge_species(const Ruleset& rules, RulesetCheck& check) {
  const ReactionNetwork& network = check.network;
  std::set<int> broken;
  for (const Reaction& reaction : network.reactions)
    if (reaction.kind == RuleKind::unlink && reaction.to.size() > 1)
      broken.insert(reaction.from.front());
  check.target_stable = true;
  for (std::size_t k = 0; k < network.species.size(); ++k) {
    const Species& species = network.species[k];
    if (species.target) {
      check.target_reached = true;
      if (broken.count(static_cast<int>(k)) > 0) check.target_stable = false;
    } else if (species.size >= check.target_size && check.target_size > 0) {
      check.other_finals.push_back(static_cast<int>(k));
    }
  }
  if (rules.target.empty()) {
    check.notes.push_back("the ruleset names no target: nothing is said about copies");
    return;
  }
  if (!network.closed)
    check.faults.push_back("there are more assemblies than were explored: nothing is proved");
  if (!check.target_reached) check.faults.push_back("the rules cannot build the target");
  if (!check.other_finals.empty())
    check.faults.push_back(
        "the rules build " + many(check.other_finals.size(), "other assembly", "other assemblies") +
        " of the target's size or more, as " + network.species[check.other_finals.front()].drawing);
  if (check.target_reached && !check.target_stable)
    check.notes.push_back("finished copies can fall apart again");
}

void judge_rules(const Ruleset& rules, RulesetCheck& check) {
  for (const auto& [rule, why] : check.unrestored) check.faults.push_back(why);
  std::set<int> used;
  for (const Reaction& reaction : check.network.reactions) used.insert(reaction.rule);
  for (std::size_t k = 0; k < rules.rules.size(); ++k) {
    if (rules.rules[k].p > 0 && used.count(static_cast<int>(k)) == 0)
      check.notes.push_back(rules.rules[k].name + " never fires");
  }
  std::set<std::string> lost;
  for (const Reaction& reaction : check.network.blocked)
    lost.insert(rules.rules[reaction.rule].name);
  for (const std::string& name : lost)
    check.notes.push_back("some joins of " + name + " have no straight way in and are left out");
}

void judge_population(const Ruleset& rules, const JobControl& control, RulesetCheck& check) {
  if (check.modules <= 0) return;
  constexpr std::int64_t kStates = 200000;
  check.population = population_graph(rules, check.network, check.modules, kStates, control);
  const PopulationGraph& graph = check.population;
  if (!graph.complete) {
    check.notes.push_back("more than " + std::to_string(graph.states - 1) + " states of " +
                          std::to_string(check.modules) +
                          " modules: deadlocks are not proved or excluded");
    return;
  }
  const auto deadlocks = graph.deadlocks();
  if (!deadlocks.empty())
    check.faults.push_back(counted(deadlocks.size(), "deadlock") +
                           ": states that are never left and miss a copy");
  const bool wavering = std::any_of(graph.ends.begin(), graph.ends.end(), [&](const EndState& end) {
    return end.fewest_copies < graph.possible && end.copies == graph.possible;
  });
  if (wavering) check.notes.push_back("full yield is reached again and again, but not kept");
}

void judge_lattice(const Ruleset& rules, const CheckOptions& options, RulesetCheck& check) {
  NetworkOptions legal;
  legal.sterics = false;
  legal.largest = std::max(options.modules, 1);
  const ReactionNetwork network = reaction_network(rules, legal);
  for (int run = 0; run < options.lattice_runs; ++run) {
    LatticeOptions one = options.lattice;
    one.modules = options.modules;
    one.seed = derived_seed(options.lattice.seed, static_cast<std::uint64_t>(run));
    one.stop = options.stop;
    check.lattice.push_back(run_lattice(rules, network, one));
    options.report((run + 1.0) / options.lattice_runs, "of the lattice simulations");
  }
  std::int64_t illegal = 0, unrestored = 0;
  for (const LatticeResult& result : check.lattice)
    illegal += result.illegal, unrestored += result.unrestored;
  if (illegal > 0)
    check.faults.push_back(many(illegal, "assembly", "assemblies") +
                           " in the lattice simulations that the rules cannot make one at a time");
  if (unrestored > 0)
    check.faults.push_back(counted(unrestored, "join") +
                           " in the lattice simulations that reverse rules did not undo");
}

std::string contents(const ReactionNetwork& network, const std::vector<int>& counts) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < counts.size(); ++k)
    if (counts[k] > 0)
      out.push_back(std::to_string(counts[k]) + " x " + network.species[k].drawing);
  return joined(out, ", ");
}

std::string species_text(const RulesetCheck& check) {
  std::map<int, int> sizes;
  for (const Species& species : check.network.species) ++sizes[species.size];
  std::string out = many(check.network.species.size(), "kind of assembly", "kinds of assembly");
  const std::string list = joined(sizes, ", ", [](const auto& of) {
    return std::to_string(of.second) + " of " + std::to_string(of.first);
  });
  out += " (" + list + (sizes.size() == 1 && sizes.begin()->first == 1 ? " module)" : " modules)");
  const std::vector<Reaction>& reactions = check.network.reactions;
  const auto joins = std::count_if(reactions.begin(), reactions.end(),
                                   [](const Reaction& r) { return r.kind == RuleKind::link; });
  return out + ", " + std::to_string(joins) + " ways to join, " +
         std::to_string(reactions.size() - joins) + " to change or fall apart";
}

void add_population(const RulesetCheck& check, std::vector<std::string>& lines) {
  const PopulationGraph& graph = check.population;
  if (check.modules <= 0 || !graph.complete) return;
  lines.push_back(std::to_string(check.modules) + " modules have " +
                  counted(graph.states, "state") + " and end in " +
                  counted(graph.ends.size(), "way"));
  constexpr std::size_t kShown = 5;
  for (std::size_t k = 0; k < graph.ends.size() && k < kShown; ++k) {
    const EndState& end = graph.ends[k];
    const std::string range =
        (end.fewest_copies == end.copies ? "" : std::to_string(end.fewest_copies) + " .. ") +
        std::to_string(end.copies);
    lines.push_back(
        "  " + range + " of " + std::to_string(graph.possible) + " copies" +
        (end.copies < graph.possible ? ", a deadlock" : "") + ": " +
        contents(check.network, end.counts) +
        (end.states > 1 ? " and " + std::to_string(end.states - 1) + " other states" : ""));
  }
  if (graph.ends.size() > kShown)
    lines.push_back("  ... and " + std::to_string(graph.ends.size() - kShown) + " more");
}

std::string lattice_text(const RulesetCheck& check) {
  std::int64_t attempts = 0, links = 0, unlinks = 0, illegal = 0, restored = 0, full = 0,
               blocked = 0;
  for (const LatticeResult& r : check.lattice) {
    attempts += r.attempts, links += r.links, unlinks += r.unlinks, illegal += r.illegal;
    restored += r.restored, blocked += r.blocked;
    full += r.possible > 0 && r.copies == r.possible ? 1 : 0;
  }
  return counted(check.lattice.size(), "lattice simulation") + ": " + std::to_string(attempts) +
         " meetings, " + std::to_string(links) + " joins, " + std::to_string(unlinks) +
         " undone, " + std::to_string(blocked) + " without a way in; " + std::to_string(illegal) +
         " illegal assemblies; " + std::to_string(restored) +
         " joins undone on a copy and found as before; full yield in " + std::to_string(full);
}

}  // namespace

RulesetCheck check_ruleset(const Ruleset& rules, const CheckOptions& options) {
  check_probabilities(rules);
  RulesetCheck check;
  check.modules = options.modules;
  check.target_size = static_cast<int>(rules.target.size());
  NetworkOptions network;
  network.largest = std::max(options.modules, 1);
  check.network = reaction_network(rules, network);
  network.never = true;
  check.unrestored = reaction_network(rules, network).unrestored;
  check.irreversible_size = first_irreversible_size(rules, check.network);
  judge_species(rules, check);
  judge_rules(rules, check);
  try {
    judge_population(rules, options, check);
    judge_lattice(rules, options, check);
  } catch (const Stopped&) {
    throw Stopped("stopped; lattice simulations are not kept, so the same command starts again");
  }
  return check;
}

ReportDocument check_report(const Ruleset& rules, const RulesetCheck& check) {
  ReportDocument report;
  report.title = "Check of ruleset " + rules.name;
  report.subtitle = counted(rules.rules.size(), "rule");
  const bool sound = check.faults.empty();
  report.card.tone = sound ? ReportTone::good : ReportTone::fault;
  report.card.verdict = sound ? "no fault found" : counted(check.faults.size(), "fault") + " found";
  ReportSection proofs{"Proofs", {species_text(check)}};
  add_population(check, proofs.above);
  if (check.unrestored.empty()) {
    proofs.above.push_back("every reverse rule gives back the states that its join found");
  }
  if (check.irreversible_size > 0 && check.modules > 0 && check.target_size > 0) {
    const int s = check.irreversible_size, n = check.target_size, m = check.modules;
    proofs.above.push_back("assemblies from " + counted(s, "module") +
                           " on may last: floor(M/s) = " + std::to_string(m / s) +
                           (deadlock_risk(m, s, n) ? " > " : " <= ") + std::to_string(m / n) +
                           " = floor(M/n)" +
                           (deadlock_risk(m, s, n) ? ", deadlocks are possible" : ""));
  }
  for (const std::string& note : check.notes) proofs.above.push_back("note: " + note);
  for (const std::string& fault : check.faults) proofs.above.push_back("fault: " + fault);
  report.sections.push_back(std::move(proofs));
  if (!check.lattice.empty()) {
    report.sections.push_back({"Lattice simulations", {lattice_text(check)}});
  }
  return report;
}

}  // namespace lilytank
