// Rules for KaSim (Kappa 4) and BioNetGen.
//
// Both tools know sites by name but not their order, so l_n and the engaged face are spelled out:
// a module whose l_n is face n is engaged at hop h by face n + h - 1, and so every rule of ours has
// a case for each n of either module (for an isolated one, each face).
#include <map>
#include <set>

#include "lilytank/kinetics.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

// One module of a case: its state and face before, and its state after.
struct Case {
  int label = 0, last = -1, face = 0;
  int label_after = 0, last_after = -1;
};

std::vector<Case> cases_of(const Label& before, const Label& after) {
  std::vector<Case> cases;
  for (int k = 0; k < 4; ++k) {
    Case c;
    c.label = before.state;
    c.last = before.hop == 0 ? -1 : k;
    c.face = before.hop == 0 ? k : last_after(k, before.hop);
    c.label_after = after.state;
    c.last_after = last_after(c.face, after.hop);
    cases.push_back(c);
  }
  return cases;
}

std::string connector(int last) {
  return last < 0 ? "x" : std::to_string(last);
}

std::set<int> states_of(const Ruleset& rules) {
  std::set<int> states = {0};
  for (const Rule& rule : rules.rules) {
    for (const Label& label : rule.before) states.insert(label.state);
    for (const Label& label : rule.after) states.insert(label.state);
  }
  return states;
}

std::string opening(const Ruleset& rules, const std::string& tool) {
  return "# Ruleset " + rules.name + " for " + tool +
         ", written by lilytank.\n# M is a module: a its control state, n the connector engaged "
         "last (x: none), f0 .. f3\n# its faces counter-clockwise. Rates are 1/s; no space, no "
         "shapes: a bond is all that is known.\n";
}

bool equal_labels(const Rule& rule) {
  return rule.before[0] == rule.before[1];
}

// Whether the case is unchanged when its two modules are swapped, left and right.
bool symmetric(const Case& a, const Case& b) {
  return a.label == b.label && a.last == b.last && a.face == b.face &&
         a.label_after == b.label_after && a.last_after == b.last_after;
}

// Whether two modules of one assembly may have a rule's two labels. Isolated modules are alone.
bool may_share_an_assembly(const Rule& rule) {
  return rule.before[0] != Label{} && rule.before[1] != Label{};
}

// Calls visit(case of the first module, case of the second, name) for each case of a rule.
template <class Visit>
void for_each_case(const Rule& rule, const Visit& visit) {
  for (const Case& a : cases_of(rule.before[0], rule.after[0]))
    for (const Case& b : cases_of(rule.before[1], rule.after[1]))
      visit(a, b, rule.name + "_" + std::to_string(a.face) + std::to_string(b.face));
}

}  // namespace

std::string to_kappa(const Ruleset& rules, double face_rate, double evaluation_rate, int modules) {
  std::string out = opening(rules, "KaSim 4") + "%agent: M(a{";
  for (const int state : states_of(rules)) out += (state == 0 ? "s" : " s") + std::to_string(state);
  out += "}, n{x n0 n1 n2 n3}, f0, f1, f2, f3)\n";
  out += "%var: 'face_rate' " + shortest(face_rate) + "\n%var: 'evaluation_rate' " +
         shortest(evaluation_rate) + "\n";
  const auto agent = [](int label, int last, int face, const std::string& link) {
    const std::string n = last < 0 ? "x" : "n" + connector(last);
    return "M(a{s" + std::to_string(label) + "}, n{" + n + "}, f" + std::to_string(face) + "[" +
           link + "])";
  };
  for (const Rule& rule : rules.rules) {
    const bool link = rule.kind == RuleKind::link;
    const std::string before = link ? "." : "1", after = rule.kind == RuleKind::unlink ? "." : "1";
    out += "%var: 'k_" + rule.name + "' " +
           (link ? shortest(docking_share(rules, rule)) + " * 'face_rate'"
                 : shortest(rule.p) + " * 'evaluation_rate'") +
           "\n";
    for_each_case(rule, [&](const Case& a, const Case& b, const std::string& name) {
      out += "'" + name + "' " + agent(a.label, a.last, a.face, before) + ", " +
             agent(b.label, b.last, b.face, before) + " -> " +
             agent(a.label_after, a.last_after, a.face, after) + ", " +
             agent(b.label_after, b.last_after, b.face, after) + " @ 'k_" + rule.name + "'" +
             // KaSim counts embeddings: two equal labels have two for every pair of faces.
             (equal_labels(rule) ? " / 2" : "") +
             // In braces the rate within one assembly, where faces do not meet by chance.
             (link && may_share_an_assembly(rule) ? " {0}" : "") + "\n";
    });
  }
  for (const int state : states_of(rules))
    out += "%obs: 'state_" + std::to_string(state) + "' |M(a{s" + std::to_string(state) + "})|\n";
  return out + "%init: " + std::to_string(modules) +
         " M(a{s0}, n{x}, f0[.], f1[.], f2[.], f3[.])\n";
}

std::string to_bngl(const Ruleset& rules, double face_rate, double evaluation_rate, int modules) {
  std::string out = opening(rules, "BioNetGen") + "begin model\nbegin parameters\n  face_rate " +
                    shortest(face_rate) + "\n  evaluation_rate " + shortest(evaluation_rate) + "\n";
  for (const Rule& rule : rules.rules)
    out += "  k_" + rule.name + " " +
           (rule.kind == RuleKind::link ? shortest(docking_share(rules, rule)) + "*face_rate"
                                        : shortest(rule.p) + "*evaluation_rate") +
           "\n";
  out += "end parameters\nbegin molecule types\n  M(a";
  for (const int state : states_of(rules)) out += "~" + std::to_string(state);
  out +=
      ",n~x~0~1~2~3,f0,f1,f2,f3)\nend molecule types\nbegin seed species\n  "
      "M(a~0,n~x,f0,f1,f2,f3) " +
      std::to_string(modules) + "\nend seed species\nbegin observables\n";
  for (const int state : states_of(rules))
    out += "  Molecules state_" + std::to_string(state) + " M(a~" + std::to_string(state) + ")\n";
  out += "end observables\nbegin reaction rules\n";
  const auto agent = [](int label, int last, int face, bool held) {
    return "M(a~" + std::to_string(label) + ",n~" + connector(last) + ",f" + std::to_string(face) +
           (held ? "!1)" : ")");
  };
  for (const Rule& rule : rules.rules) {
    const bool held = rule.kind != RuleKind::link, stays = rule.kind != RuleKind::unlink;
    for_each_case(rule, [&](const Case& a, const Case& b, const std::string& name) {
      // BioNetGen counts embeddings, too, but itself halves a rule that a swap leaves unchanged.
      const bool halve = equal_labels(rule) && !symmetric(a, b);
      out += "  " + name + ": " + agent(a.label, a.last, a.face, held) + (held ? "." : " + ") +
             agent(b.label, b.last, b.face, held) + " -> " +
             agent(a.label_after, a.last_after, a.face, stays) + (stays ? "." : " + ") +
             agent(b.label_after, b.last_after, b.face, stays) + " k_" + rule.name +
             (halve ? "/2" : "") + "\n";
    });
  }
  return out + "end reaction rules\nend model\n";
}

}  // namespace lilytank
