// The rules as other programs read them: executed here, and by those programs where they are.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "assemblies/pattern.hpp"
#include "lilytank/kinetics.hpp"
#include "support/control_rig.hpp"
#include "support/kappa.hpp"
#include "support/temporary_directory.hpp"

using namespace lilytank;
using lilytank::test::kappa_value;
using lilytank::test::KappaMixture;
using lilytank::test::KappaModel;
using lilytank::test::KappaRule;
using lilytank::test::read_bngl;
using lilytank::test::read_kappa;
using lilytank::test::rules_of;
using lilytank::test::ruleset_file;

namespace {

// Rules whose two labels are equal, with equal and different right sides: joins of single modules
// and of assemblies of different species, an update, unlinks. Trimers could also close to rings.
const char* const kEqualLabels =
    "target\n  ##\nend\n"
    "seed: (0,0) (0,0) -> (1,1)-(1,1)  p=0.75\n"
    "other: (0,0) (0,0) -> (2,1)-(3,1)  p=0.25\n"
    "turn: (1,1)-(1,1) -> (2,1)-(3,1)  p=0.5\n"
    "part: (1,1)-(1,1) -> (0,0) (0,0)  p=0.125\n"
    "leave: (1,1)-(1,1) -> (0,0) (4,1)  p=0.25\n"
    "meet: (4,1) (4,1) -> (1,1)-(1,1)\n"
    "back: (4,1) (0,0) -> (1,1)-(1,1)\n"
    "grow: (3,3) (0,0) -> (7,1)-(8,1)\n"
    "heads: (2,3) (2,3) -> (5,1)-(6,1)\n"
    "tail: (8,3) (2,3) -> (9,1)-(10,1)\n"
    "split: (5,1)-(6,1) -> (2,3) (2,3)  p=0.5\n"
    "cut: (9,1)-(10,1) -> (8,3) (2,3)  p=0.5\n"
    "shrink: (7,1)-(8,1) -> (3,3) (0,0)  p=0.5\n"
    "end: (2,1)-(3,1) -> (0,0) (0,0)  p=0.5\n";

// The species of an agent's assembly: faces count counter-clockwise, so that links lay it out.
std::string species_of_agent(const KappaMixture& mixture, std::size_t agent) {
  const std::vector<std::size_t> members = mixture.assembly_of(agent);
  std::map<std::size_t, int> turn = {{agent, 0}};
  std::map<std::size_t, PatternModule> modules;
  for (const std::size_t member : members) {
    const KappaMixture::Agent& one = mixture.agents[member];
    PatternModule& module = modules[member];
    module.label = std::atoi(one.states.at("a").c_str() + 1);
    const std::string& last = one.states.at("n");
    module.last = last == "x" ? -1 : (std::atoi(last.c_str() + 1) + turn[member]) & 3;
    for (const auto& [site, other] : one.links) {
      const int direction = (site[1] - '0' + turn[member]) & 3;
      module.bonds |= 1u << direction;
      const auto next = static_cast<std::size_t>(other);
      turn[next] = (direction + 2 - (one.sites.at(site)[1] - '0')) & 3;
      modules[next].cell = neighbour(module.cell, direction);
    }
  }
  Pattern pattern;
  for (const auto& [member, module] : modules) pattern.push_back(module);
  return key_of(canonical(pattern));
}

// Assemblies of one or two agents, by species.
std::multiset<std::string> species_of_both(const KappaMixture& mixture, std::size_t a,
                                           std::size_t b) {
  std::multiset<std::string> keys = {species_of_agent(mixture, a)};
  if (!mixture.together(a, b)) keys.insert(species_of_agent(mixture, b));
  return keys;
}

// A kind of reaction: its rule and the species before and after.
struct Channel {
  std::string rule;
  std::multiset<std::string> from, to;
  friend auto operator<=>(const Channel&, const Channel&) = default;
};
using Channels = std::map<Channel, double>;

struct Way {
  const KappaRule* rule;
  std::size_t first, second;
};

// Everything that can happen to the mixture; a case "r1_02" belongs to the rule "r1".
Channels channels_of(const KappaModel& model, const KappaMixture& mixture, std::vector<Way>& ways) {
  Channels out;
  for (const KappaRule& rule : model.rules) {
    for (std::size_t i = 0; i < mixture.agents.size(); ++i) {
      for (std::size_t j = 0; j < mixture.agents.size(); ++j) {
        const double rate = mixture.rate(rule, i, j);
        if (!(rate > 0)) continue;
        KappaMixture after = mixture;
        after.apply(rule, i, j);
        out[{rule.name.substr(0, rule.name.rfind('_')), species_of_both(mixture, i, j),
             species_of_both(after, i, j)}] += rate;
        ways.push_back({&rule, i, j});
      }
    }
  }
  return out;
}

// The same by the well-mixed model.
Channels channels_of(const Ruleset& rules, const Kinetics& kinetics, const KappaMixture& mixture) {
  std::map<std::string, double> count;
  for (std::size_t i = 0; i < mixture.agents.size(); ++i) {
    // Each member of an assembly adds its part.
    count[species_of_agent(mixture, i)] += 1 / static_cast<double>(mixture.assembly_of(i).size());
  }
  Channels out;
  for (std::size_t k = 0; k < kinetics.rate.size(); ++k) {
    const Reaction& r = kinetics.network.reactions[k];
    const auto keys = [&](const std::vector<int>& list) {
      std::multiset<std::string> names;
      for (const int s : list)
        names.insert(kinetics.network.species[static_cast<std::size_t>(s)].key);
      return names;
    };
    const Channel channel{rules.rules[static_cast<std::size_t>(r.rule)].name, keys(r.from),
                          keys(r.to)};
    const double a = std::round(count[*channel.from.begin()]),
                 b = std::round(count[*channel.from.rbegin()]);
    const double sets = r.from.size() == 1 ? a : r.from[0] == r.from[1] ? 0.5 * a * (a - 1) : a * b;
    if (sets * kinetics.rate[k] > 0) out[channel] += sets * kinetics.rate[k];
  }
  return out;
}

// Follows one path of the exported model and compares all rates at every state on it.
void expect_same_chain(const Ruleset& rules, const KappaModel& model, int modules,
                       std::uint32_t moves, bool all_rules) {
  const Kinetics kinetics = kinetics_of(rules, 1e-3, 0.5, modules);
  ASSERT_EQ(model.agents, modules);
  ASSERT_EQ(model.rules.size(), 16 * rules.rules.size());
  KappaMixture mixture(modules);
  std::set<std::string> fired;
  for (std::uint32_t move = 0; move < moves; ++move) {
    std::vector<Way> ways;
    const Channels exported = channels_of(model, mixture, ways);
    const Channels ours = channels_of(rules, kinetics, mixture);
    ASSERT_EQ(exported.size(), ours.size()) << "after " << move;
    for (const auto& [channel, rate] : ours) {
      ASSERT_TRUE(exported.count(channel)) << channel.rule << " after " << move;
      ASSERT_NEAR(exported.at(channel), rate, 1e-12) << channel.rule << " after " << move;
      fired.insert(channel.rule);
    }
    if (ways.empty()) {  // nothing can happen any more: from the start on another path
      mixture = KappaMixture(modules);
      continue;
    }
    // Any rule, then any of its ways: joins have so many that others would hardly come about.
    const std::uint32_t draw = 2654435761u * (move + 1) >> 8;
    const std::string rule = std::next(exported.begin(), draw % exported.size())->first.rule + "_";
    std::erase_if(ways, [&](const Way& way) { return !way.rule->name.starts_with(rule); });
    const Way& way = ways[draw / exported.size() % ways.size()];
    mixture.apply(*way.rule, way.first, way.second);
  }
  if (all_rules) {
    for (const Rule& rule : rules.rules) EXPECT_TRUE(fired.count(rule.name)) << rule.name;
  }
}

// The exported rules are the Markov chain of the well-mixed model: at every state on a path each
// reaction, by rule and species before and after, has the same rate.
TEST(Export, ShippedRulesetsAreTheWellMixedModel) {
  for (const std::string name : {"chain5", "cross5", "s4"}) {
    SCOPED_TRACE(name);
    Ruleset rules = read_ruleset(ruleset_file(name));
    for (Rule& rule : rules.rules)
      if (rule.kind == RuleKind::unlink) rule.p = 0.1;
    const int modules = 2 * static_cast<int>(rules.target.size());
    expect_same_chain(rules, read_kappa(to_kappa(rules, 1e-3, 0.5, modules)), modules, 60, false);
    expect_same_chain(rules, read_bngl(to_bngl(rules, 1e-3, 0.5, modules)), modules, 60, false);
  }
}

TEST(Export, RulesOfEqualLabelsAreTheWellMixedModel) {
  const Ruleset rules = rules_of(kEqualLabels);
  expect_same_chain(rules, read_kappa(to_kappa(rules, 1e-3, 0.5, 6)), 6, 400, true);
  expect_same_chain(rules, read_bngl(to_bngl(rules, 1e-3, 0.5, 6)), 6, 400, true);
}

// Six modules have 15 pairs with 16 pairs of faces each: 0.1848/s at 7.7e-4/s.
TEST(Export, FirstJoinOfSixModulesHasTheRateOfAllPairsOfFaces) {
  const Ruleset rules = read_ruleset(ruleset_file("chain5"));
  const KappaMixture single(6);
  for (const KappaModel& model :
       {read_kappa(to_kappa(rules, 7.7e-4, 0.68, 6)), read_bngl(to_bngl(rules, 7.7e-4, 0.68, 6))}) {
    double sum = 0;
    std::vector<Way> ways;
    for (const auto& [channel, rate] : channels_of(model, single, ways)) sum += rate;
    EXPECT_NEAR(sum, 0.1848, 1e-12);
  }
}

bool has_program(const std::string& name) {
  return std::system(("command -v " + name + " > /dev/null 2>&1").c_str()) == 0;
}

// Sum over BioNetGen's reactions of two single modules, of their constants: n (n - 1) times it is
// the rate of the first join.
double first_join_of_net(const std::string& net) {
  KappaModel model;
  std::string block;
  std::istringstream lines(net);
  double sum = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string number, name, text;
    words >> number >> name >> text;
    if (number == "begin" || number == "end") {
      block = number == "begin" ? name : "";
    } else if (block == "parameters") {
      model.variables[name] = kappa_value(model, text);
    } else if (block == "reactions" && name == "1,1") {
      words >> text;
      sum += kappa_value(model, text);
    }
  }
  return sum;
}

TEST(Export, BioNetGenBuildsTheSameFirstJoin) {
  if (!has_program("BNG2.pl")) GTEST_SKIP() << "BNG2.pl is not on the PATH";
  const TemporaryDirectory here;
  for (const Ruleset& rules : {read_ruleset(ruleset_file("chain5")), rules_of(kEqualLabels)}) {
    std::ofstream(here.path("m.bngl"))
        << to_bngl(rules, 7.7e-4, 0.68, 6) << "generate_network({overwrite=>1,max_iter=>1})\n";
    ASSERT_EQ(std::system(("cd '" + here.path("") + "' && BNG2.pl m.bngl > log 2>&1").c_str()), 0);
    std::stringstream net;
    net << std::ifstream(here.path("m.net")).rdbuf();
    EXPECT_NEAR(30 * first_join_of_net(net.str()), 0.1848, 1e-9);
  }
}

TEST(Export, KaSimReadsTheRules) {
  if (!has_program("KaSim")) GTEST_SKIP() << "KaSim is not on the PATH";
  const TemporaryDirectory here;
  for (const Ruleset& rules : {read_ruleset(ruleset_file("chain5")), rules_of(kEqualLabels)}) {
    std::ofstream(here.path("m.ka")) << to_kappa(rules, 7.7e-4, 0.68, 6);
    const std::string run = "cd '" + here.path("") + "' && KaSim m.ka -l 10 -d out > log 2>&1";
    ASSERT_EQ(std::system(run.c_str()), 0);
  }
}

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; ++at) ++n;
  return n;
}

TEST(Export, KappaHasACaseForEveryTurn) {
  const std::string text = to_kappa(read_ruleset(ruleset_file("cross5")), 1e-5, 0.68, 15);
  EXPECT_EQ(count_of(text, " -> "), 8u * 16u);
  EXPECT_EQ(count_of(text, "%agent:"), 1u);
  EXPECT_EQ(count_of(text, "%init: 15 M(a{s0}, n{x}, f0[.], f1[.], f2[.], f3[.])"), 1u);
  // r2 of the cross at hop 2: a module whose l_n is face 0 engages face 1.
  EXPECT_NE(text.find("'r2_10' M(a{s1}, n{n0}, f1[.]), M(a{s0}, n{x}, f0[.]) -> "
                      "M(a{s3}, n{n1}, f1[1]), M(a{s4}, n{n0}, f0[1]) @ 'k_r2'\n"),
            std::string::npos);
  // Undone at face 1, with hop 4 back: face 0 is l_n again.
  EXPECT_NE(text.find("'r2_reverse_10' M(a{s3}, n{n1}, f1[1]), M(a{s4}, n{n0}, f0[1]) -> "
                      "M(a{s1}, n{n0}, f1[.]), M(a{s0}, n{x}, f0[.]) @ 'k_r2_reverse'\n"),
            std::string::npos);
  EXPECT_EQ(count_of(text, "@ 'k_r1' / 2"), 16u);
}

TEST(Export, BnglHasTheSameCases) {
  const std::string text = to_bngl(read_ruleset(ruleset_file("cross5")), 1e-5, 0.68, 15);
  EXPECT_EQ(count_of(text, " -> "), 8u * 16u);
  EXPECT_EQ(count_of(text, "begin "), count_of(text, "end "));
  EXPECT_NE(
      text.find("  r2_10: M(a~1,n~0,f1) + M(a~0,n~x,f0) -> M(a~3,n~1,f1!1).M(a~4,n~0,f0!1) k_r2\n"),
      std::string::npos);
  EXPECT_NE(text.find("  r1_reverse_00: M(a~1,n~0,f0!1).M(a~2,n~0,f0!1) -> M(a~0,n~x,f0) + "
                      "M(a~0,n~x,f0) k_r1_reverse\n"),
            std::string::npos);
  // (1,1)-(2,1) is not symmetric: BioNetGen halves none of the sixteen.
  EXPECT_EQ(count_of(text, " k_r1/2\n"), 16u);
}

}  // namespace
