// The well-mixed model: rates from counts, and Gillespie's direct method.
#include <algorithm>
#include <cmath>

#include "lilytank/kinetics.hpp"
#include "lilytank/math.hpp"
#include "lilytank/random.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

double share_of(const Ruleset& rules, const Reaction& reaction) {
  return docking_share(rules, rules.rules[reaction.rule]);
}

const RateTable::Meeting* meeting_of(const RateTable& table, const ReactionNetwork& network,
                                     const Reaction& reaction) {
  if (reaction.from.size() < 2) return nullptr;
  std::string a = network.species[reaction.from[0]].key;
  std::string b = network.species[reaction.from[1]].key;
  if (b < a) std::swap(a, b);
  const auto found = table.meetings.find({a, b});
  return found == table.meetings.end() ? nullptr : &found->second;
}

std::int64_t links_of(const RateTable::Meeting* meeting, const std::string& rule) {
  if (meeting == nullptr) return 0;
  const auto found = meeting->links.find(rule);
  return found == meeting->links.end() ? 0 : found->second;
}

ReactionNetwork network_for(const Ruleset& rules, int modules) {
  NetworkOptions options;
  options.largest = std::max(1, modules);
  ReactionNetwork network = reaction_network(rules, options);
  if (!network.closed)
    throw InputError("ruleset " + rules.name + " makes more assemblies than the model can hold");
  return network;
}

// Evaluations of standing bonds per second. How often rules fired would determine them only with
// the p of the worlds in which they did.
double evaluation_rate_of(const RateTable& table) {
  const bool counted = table.evaluations > 0 && table.bond_seconds > 0;
  return counted ? static_cast<double>(table.evaluations) / table.bond_seconds
                 : kStandardEvaluationRate;
}

}  // namespace

std::string kinetics_text(const Ruleset& rules, const Kinetics& kinetics) {
  std::string out = "a pair of faces that fit docks " + significant(kinetics.face_rate, 3) +
                    " times a second; a bond is evaluated " +
                    significant(kinetics.evaluation_rate, 3) + " times a second\n";
  for (std::size_t k = 0; k < kinetics.rate.size(); ++k) {
    const Reaction& reaction = kinetics.network.reactions[k];
    const auto side = [&](const std::vector<int>& list) {
      std::string text;
      for (const int species : list)
        text += (text.empty() ? "" : " + ") + kinetics.network.species[species].drawing;
      return text;
    };
    out += "  " + rules.rules[reaction.rule].name + ": " + side(reaction.from) + " -> " +
           side(reaction.to) + "  " + significant(kinetics.rate[k], 3) + "/s";
    if (reaction.kind == RuleKind::link)
      out += ", " + significant(kinetics.rate[k] / reaction.places, 3) + "/s for each of " +
             shortest(reaction.places) + " pairs of faces, seen " +
             std::to_string(kinetics.seen[k]) + " times";
    out += "\n";
  }
  return out;
}

Kinetics kinetics_of(const Ruleset& rules, const RateTable& table, int modules) {
  Kinetics kinetics;
  kinetics.network = network_for(rules, modules);
  const ReactionNetwork& network = kinetics.network;
  kinetics.evaluation_rate = evaluation_rate_of(table);
  double links = 0, chances = 0;
  for (const Reaction& reaction : network.reactions) {
    const RateTable::Meeting* meeting = meeting_of(table, network, reaction);
    const Rule& rule = rules.rules[reaction.rule];
    const std::int64_t seen = links_of(meeting, rule.name);
    kinetics.seen.push_back(seen);
    if (meeting == nullptr || reaction.kind != RuleKind::link) continue;
    links += static_cast<double>(seen);
    chances += meeting->exposure * reaction.places * share_of(rules, reaction);
  }
  if (!(links > 0) || !(chances > 0))
    throw InputError("the counted rates have no joins of ruleset " + rules.name +
                     ": they are of another ruleset, or of too short a time");
  kinetics.face_rate = links / chances;
  for (std::size_t k = 0; k < network.reactions.size(); ++k) {
    const Reaction& reaction = network.reactions[k];
    const Rule& rule = rules.rules[reaction.rule];
    if (reaction.kind != RuleKind::link || reaction.from.size() < 2) {
      // A contact inside an assembly is evaluated at once: let it be as fast as a bond's
      // evaluation.
      kinetics.rate.push_back(rule.p * kinetics.evaluation_rate * reaction.places);
      continue;
    }
    const double usual = kinetics.face_rate * reaction.places * share_of(rules, reaction);
    const RateTable::Meeting* meeting = meeting_of(table, network, reaction);
    const double exposure = meeting == nullptr ? 0 : meeting->exposure;
    kinetics.rate.push_back((static_cast<double>(kinetics.seen[k]) + 1) / (exposure + 1 / usual));
  }
  return kinetics;
}

Kinetics kinetics_of(const Ruleset& rules, double face_rate, double evaluation_rate, int modules) {
  Kinetics kinetics;
  kinetics.network = network_for(rules, modules);
  kinetics.face_rate = face_rate;
  kinetics.evaluation_rate = evaluation_rate;
  for (const Reaction& reaction : kinetics.network.reactions) {
    const bool meets = reaction.kind == RuleKind::link && reaction.from.size() == 2;
    const Rule& rule = rules.rules[reaction.rule];
    kinetics.rate.push_back(reaction.places * (meets ? face_rate * share_of(rules, reaction)
                                                     : evaluation_rate * rule.p));
    kinetics.seen.push_back(0);
  }
  return kinetics;
}

GillespieResult run_gillespie(const Kinetics& kinetics, const GillespieOptions& options) {
  const ReactionNetwork& network = kinetics.network;
  GillespieResult result;
  result.counts.assign(network.species.size(), 0);
  result.counts[0] = options.modules;
  const auto count = [&](int species) { return static_cast<double>(result.counts[species]); };
  std::vector<double> propensity(network.reactions.size(), 0);
  for (double time = 0;;) {
    double total = 0;
    for (std::size_t k = 0; k < propensity.size(); ++k) {
      const std::vector<int>& from = network.reactions[k].from;
      const double ways = from.size() == 1     ? count(from[0])
                          : from[0] == from[1] ? count(from[0]) * (count(from[0]) - 1) / 2
                                               : count(from[0]) * count(from[1]);
      total += propensity[k] = kinetics.rate[k] * ways;
    }
    if (!(total > 0)) break;
    const auto draw = [&](std::uint32_t index) {
      return uniform({options.seed, Stream::gillespie, result.reactions, 0, index});
    };
    time -= log_portable(draw(0)) / total;
    if (!(time < options.duration)) break;
    double left = draw(1) * total;
    std::size_t chosen = 0;
    while (chosen + 1 < propensity.size() && left >= propensity[chosen])
      left -= propensity[chosen++];
    while (propensity[chosen] == 0) --chosen;  // rounding at the end of the sum
    const Reaction& reaction = network.reactions[chosen];
    for (const int species : reaction.from) --result.counts[species];
    for (const int species : reaction.to) ++result.counts[species];
    ++result.reactions;
    result.copies = 0;
    for (std::size_t s = 0; s < network.species.size(); ++s)
      if (network.species[s].target) result.copies += result.counts[s];
    while (static_cast<int>(result.completion.size()) < result.copies)
      result.completion.push_back(time);
  }
  return result;
}

}  // namespace lilytank
