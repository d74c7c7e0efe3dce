// Runs the Kappa and the BNGL that lilytank writes: agents with sites, rules between two of them,
// rates per embedding. An implementation of its own, as neither KaSim nor BioNetGen is in Debian.
#pragma once
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace lilytank::test {

/// "M(a{s1}, n{n0}, f1[.])" or "M(a~1,n~0,f1)" as the sites it names: states in braces, links in
/// brackets.
struct KappaPattern {
  std::map<std::string, std::string> states, links;
  friend bool operator==(const KappaPattern&, const KappaPattern&) = default;
};

struct KappaRule {
  std::string name;
  KappaPattern left[2], right[2];
  double rate = 0;         ///< 1/s, of each embedding
  double within = 0;       ///< 1/s, of each embedding in one assembly
  bool must_part = false;  ///< does not fire where other bonds hold the two together (BNGL's "+")
};

struct KappaModel {
  std::vector<KappaRule> rules;
  std::map<std::string, double> variables;
  int agents = 0;
};

/// A product of numbers and variables, quoted or not, with divisions: "0.5 * 'face_rate' / 2".
inline double kappa_value(const KappaModel& model, const std::string& text) {
  double value = 1;
  char operation = '*';
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == ' ') {
      ++at;
      continue;
    }
    if (text[at] == '*' || text[at] == '/') {
      operation = text[at++];
      continue;
    }
    double factor = 0;
    if (text[at] == '\'') {
      const std::size_t end = text.find('\'', at + 1);
      factor = model.variables.at(text.substr(at + 1, end - at - 1));
      at = end + 1;
    } else if (std::isalpha(static_cast<unsigned char>(text[at])) || text[at] == '_') {
      const std::size_t end = std::min(text.size(), text.find_first_of(" */", at));
      factor = model.variables.at(text.substr(at, end - at));
      at = end;
    } else {
      char* end = nullptr;
      factor = std::strtod(text.c_str() + at, &end);
      if (end == text.c_str() + at) throw std::runtime_error("not a number: " + text);
      at = static_cast<std::size_t>(end - text.c_str());
    }
    value = operation == '*' ? value * factor : value / factor;
  }
  return value;
}

/// Takes one "M(...)" off the front of `text`, and the comma after it.
inline KappaPattern take_pattern(std::string& text) {
  KappaPattern pattern;
  const std::size_t open = text.find("M("), close = text.find(')');
  if (open == std::string::npos || close == std::string::npos)
    throw std::runtime_error("no agent in: " + text);
  std::string sites = text.substr(open + 2, close - open - 2) + ",";
  text = text.substr(close + 1);
  for (std::size_t at = 0, end; (end = sites.find(',', at)) != std::string::npos; at = end + 1) {
    std::string site = sites.substr(at, end - at);
    while (!site.empty() && site[0] == ' ') site.erase(0, 1);
    const std::size_t bracket = site.find_first_of("{[");
    const std::string name = site.substr(0, bracket);
    const std::string value = site.substr(bracket + 1, site.size() - bracket - 2);
    (site[bracket] == '{' ? pattern.states : pattern.links)[name] = value;
  }
  return pattern;
}

inline KappaModel read_kappa(const std::string& text) {
  KappaModel model;
  for (std::size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    const std::string line = text.substr(at, end - at);
    const auto quoted = [&] {
      const std::size_t first = line.find('\'');
      return line.substr(first + 1, line.find('\'', first + 1) - first - 1);
    };
    if (line.rfind("%var:", 0) == 0) {
      const std::string name = quoted();
      model.variables[name] = kappa_value(model, line.substr(line.find(name) + name.size() + 1));
    } else if (line.rfind("%init:", 0) == 0) {
      model.agents = std::atoi(line.c_str() + 6);
    } else if (line[0] == '\'') {
      KappaRule rule;
      rule.name = quoted();
      std::string rest = line.substr(rule.name.size() + 2);
      for (KappaPattern& pattern : rule.left) pattern = take_pattern(rest);
      if (rest.rfind(" -> ", 0) != 0) throw std::runtime_error("no arrow in: " + line);
      for (KappaPattern& pattern : rule.right) pattern = take_pattern(rest);
      rest = rest.substr(rest.find('@') + 1);
      const std::size_t brace =
          rest.find('{');  // before it the rate of two assemblies, if it is there
      rule.rate = rule.within = kappa_value(model, rest.substr(0, brace));
      if (brace != std::string::npos) {
        rule.within = kappa_value(model, rest.substr(brace + 1, rest.find('}') - brace - 1));
      }
      model.rules.push_back(rule);
    } else if (line[0] != '#' && line[0] != '%') {
      throw std::runtime_error("not understood: " + line);
    }
  }
  return model;
}

/// Takes one "M(a~1,n~x,f0!1)" off the front of `text`, with the same words as in Kappa.
inline KappaPattern take_bngl_pattern(std::string& text) {
  KappaPattern pattern;
  const std::size_t open = text.find("M("), close = text.find(')');
  if (open == std::string::npos || close == std::string::npos)
    throw std::runtime_error("no molecule in: " + text);
  std::istringstream sites(text.substr(open + 2, close - open - 2));
  text = text.substr(close + 1);
  for (std::string site; std::getline(sites, site, ',');) {
    const std::size_t mark = site.find_first_of("~!");
    const std::string name = site.substr(0, mark);
    const std::string value = mark == std::string::npos ? "." : site.substr(mark + 1);
    if (name == "a")
      pattern.states[name] = "s" + value;
    else if (name == "n")
      pattern.states[name] = value == "x" ? "x" : "n" + value;
    else
      pattern.links[name] = value;
  }
  return pattern;
}

/// BNGL with BioNetGen's convention, so that rates are of embeddings: a rule is divided by the
/// number of the reactants' automorphisms that are automorphisms of the products, too (RxnRule.pm,
/// MultScale, as no swap of ours leaves the reaction centre in place); reactants joined by "+" are
/// of two species, and products joined by "+" must come apart.
inline KappaModel read_bngl(const std::string& text) {
  KappaModel model;
  std::string block;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    if (first == "begin" || first == "end") {
      block = first == "begin" ? line.substr(6) : "";
    } else if (block == "parameters") {
      model.variables[first] = kappa_value(model, line.substr(line.find(first) + first.size()));
    } else if (block == "seed species") {
      model.agents = std::atoi(line.c_str() + line.rfind(' '));
    } else if (block == "reaction rules") {
      KappaRule rule;
      rule.name = first.substr(0, first.size() - 1);
      std::string rest = line.substr(line.find(':') + 1);
      rule.left[0] = take_bngl_pattern(rest);
      const bool apart = rest.rfind(" + ", 0) == 0;
      rule.left[1] = take_bngl_pattern(rest);
      if (rest.rfind(" -> ", 0) != 0) throw std::runtime_error("no arrow in: " + line);
      rule.right[0] = take_bngl_pattern(rest);
      rule.must_part = rest.rfind(" + ", 0) == 0;
      rule.right[1] = take_bngl_pattern(rest);
      const bool swaps = rule.left[0] == rule.left[1] && rule.right[0] == rule.right[1];
      rule.rate = kappa_value(model, rest) / (swaps ? 2 : 1);
      rule.within = apart ? 0 : rule.rate;
      model.rules.push_back(rule);
    }
  }
  return model;
}

/// Agents and their links, [agent][site].
struct KappaMixture {
  struct Agent {
    std::map<std::string, std::string> states;
    std::map<std::string, int> links;          ///< the agent at the other end; none: free
    std::map<std::string, std::string> sites;  ///< and its site
  };
  std::vector<Agent> agents;

  explicit KappaMixture(int count) : agents(static_cast<std::size_t>(count)) {
    for (Agent& agent : agents) agent.states = {{"a", "s0"}, {"n", "x"}};
  }
  bool matches(const KappaPattern& pattern, std::size_t agent) const {
    for (const auto& [site, state] : pattern.states)
      if (agents[agent].states.at(site) != state) return false;
    for (const auto& [site, link] : pattern.links)
      if ((link == ".") != (agents[agent].links.count(site) == 0)) return false;
    return true;
  }
  /// Whether the rule can be applied with these agents as its first and second one.
  bool embeds(const KappaRule& rule, std::size_t first, std::size_t second) const {
    if (first == second || !matches(rule.left[0], first) || !matches(rule.left[1], second))
      return false;
    const auto& [site, link] = *rule.left[0].links.begin();
    if (link == ".") return true;
    return agents[first].links.at(site) == static_cast<int>(second) &&
           agents[first].sites.at(site) == rule.left[1].links.begin()->first;
  }
  /// The agents that links connect with this one, itself first.
  std::vector<std::size_t> assembly_of(std::size_t agent) const {
    std::vector<std::size_t> members = {agent};
    for (std::size_t k = 0; k < members.size(); ++k) {
      for (const auto& [site, other] : agents[members[k]].links) {
        const auto next = static_cast<std::size_t>(other);
        if (std::find(members.begin(), members.end(), next) == members.end())
          members.push_back(next);
      }
    }
    return members;
  }
  bool together(std::size_t a, std::size_t b) const {
    const std::vector<std::size_t> members = assembly_of(a);
    return std::find(members.begin(), members.end(), b) != members.end();
  }
  /// Rate (1/s) at which the rule fires with these agents as its first and second one.
  double rate(const KappaRule& rule, std::size_t first, std::size_t second) const {
    if (!embeds(rule, first, second)) return 0;
    if (rule.must_part) {
      KappaMixture after = *this;
      after.apply(rule, first, second);
      if (after.together(first, second)) return 0;
    }
    return together(first, second) ? rule.within : rule.rate;
  }
  void apply(const KappaRule& rule, std::size_t first, std::size_t second) {
    const std::size_t both[2] = {first, second};
    for (int k = 0; k < 2; ++k) {
      Agent& agent = agents[both[k]];
      for (const auto& [site, state] : rule.right[k].states) agent.states[site] = state;
      const auto& [site, link] = *rule.right[k].links.begin();
      agent.links.erase(site), agent.sites.erase(site);
      if (link == ".") continue;
      agent.links[site] = static_cast<int>(both[1 - k]);
      agent.sites[site] = rule.right[1 - k].links.begin()->first;
    }
  }
};

}  // namespace lilytank::test
