// What a user should know about a plan and its rules, in plain words.
#include <algorithm>

#include "lilytank/lattice.hpp"
#include "lilytank/synthesis.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

std::string rule(int join, const std::string& suffix = "") {
  return "r" + std::to_string(join + 1) + suffix;
}

std::string drawn(const Target& target, const Contact& contact) {
  const auto cell = [&](int k) {
    const Cell c = target.cells[k];
    return "(" + std::to_string(c.x) + "," + std::to_string(c.y) + ")";
  };
  return cell(contact.a) + "-" + cell(contact.b);
}

const Rule* find_rule(const Ruleset& rules, const std::string& name) {
  for (const Rule& rule : rules.rules)
    if (rule.name == name) return &rule;
  return nullptr;
}

void note_joins(const Target& target, const Plan& plan, const Ruleset& rules,
                std::vector<Note>& notes) {
  const std::vector<int> maximal = maximal_joins(target, plan);
  std::vector<std::string> all, loose, stuck;
  for (const int join : maximal) {
    const Rule* reverse = find_rule(rules, rule(join, "_reverse"));
    all.push_back(rule(join));
    if (reverse != nullptr) (reverse->p > 0 ? loose : stuck).push_back(reverse->name);
  }
  if (maximal.size() > 1) {
    std::string text = "the finished shape has " + std::to_string(maximal.size()) +
                       " joins that can be taken back, those of " + listed(all);
    if (!stuck.empty())
      text +=
          "; p is 0 for " + listed(stuck) +
          (loose.empty() ? " so that it lasts, which leaves parts that cannot be taken apart either"
                         : "");
    notes.push_back({NoteKind::maximal, true, text});
  }
  if (!loose.empty())
    notes.push_back({NoteKind::maximal, true,
                     "a finished copy can fall apart: p is not 0 for " + listed(loose)});
  if (!is_caterpillar(static_cast<int>(target.cells.size()), plan.joins) &&
      plan.algorithm == Algorithm::singleton)
    notes.push_back(
        {NoteKind::caterpillar, true,
         "the bonds are not a caterpillar (a path with leaves), so growth by one module "
         "at a time has several last joins; linchpin has one on any tree"});
}

void note_shape(const Target& target, const Plan& plan, const Ruleset& rules,
                std::vector<Note>& notes) {
  const std::vector<Contact> open = open_contacts(target, plan);
  const auto closing = std::count_if(rules.rules.begin(), rules.rules.end(), [](const Rule& r) {
    return r.kind == RuleKind::link && r.name[0] == 'c';
  });
  if (!open.empty()) {
    std::vector<std::string> names;
    for (const Contact& contact : open) names.push_back(drawn(target, contact));
    std::string text = "the shape has loops: of its " + std::to_string(contacts_of(target).size()) +
                       " contacts the tree leaves " + std::to_string(open.size()) +
                       " without a bond, " + listed(names);
    if (closing > 0) text += "; closure rules hold " + std::to_string(closing) + " of them";
    notes.push_back({NoteKind::loops, false, text});
  }
  if (is_chiral(target))
    notes.push_back(
        {NoteKind::chirality, false,
         "the shape is handed: these rules build it as drawn, and never its mirror image "
         "(exchange hops 2 and 4 for that one)"});
}

void note_ways(const Target& target, const Plan& plan, std::vector<Note>& notes) {
  std::vector<std::string> names;
  for (const int join : blocked_joins(target, plan)) names.push_back(rule(join));
  if (!names.empty())
    notes.push_back({NoteKind::sterics, true,
                     "no straight way leads the parts together that " + listed(names) +
                         (names.size() > 1 ? " join" : " joins") +
                         ": other modules are in the way; take another tree or order"});
}

void note_seeds(const Ruleset& rules, std::vector<Note>& notes) {
  std::vector<std::string> names;
  for (const Rule& r : rules.rules)
    if (r.kind == RuleKind::link && r.before[0] == Label{} && r.before[1] == Label{})
      names.push_back(r.name);
  if (names.size() > 1)
    notes.push_back({NoteKind::seeds, true,
                     std::to_string(names.size()) + " rules compete for two single modules, " +
                         listed(names) +
                         ": they share one random number, and a surplus of one kind of part is of "
                         "use only after it has been taken apart"});
}

void note_deadlock(const Target& target, const Plan& plan, const Ruleset& rules, int modules,
                   std::vector<Note>& notes) {
  if (modules <= 0) return;
  NetworkOptions options;
  options.sterics = false;
  options.largest = static_cast<int>(target.cells.size());
  const ReactionNetwork network = reaction_network(rules, options);
  if (!network.closed) return;
  const int size = first_irreversible_size(rules, network);
  const int n = static_cast<int>(target.cells.size());
  const std::string m = std::to_string(modules), s = std::to_string(size);
  const bool serial = plan.algorithm == Algorithm::singleton;
  if (!deadlock_risk(modules, size, n) || (serial && !serial_deadlock(modules, size, n))) return;
  notes.push_back({NoteKind::deadlock, true,
                   m + (serial ? " modules can" : " modules may") +
                       " all be bound in assemblies that lead to no further copy: " +
                       std::to_string(modules / size) + " assemblies of " + s +
                       " modules, which cannot be taken apart any more, have room, but only " +
                       std::to_string(modules / n) + " copies of " + std::to_string(n)});
}

}  // namespace

std::vector<Note> notes_on(const Target& target, const Plan& plan, const Ruleset& rules,
                           int modules) {
  std::vector<Note> notes;
  note_joins(target, plan, rules, notes);
  note_ways(target, plan, notes);
  note_seeds(rules, notes);
  note_deadlock(target, plan, rules, modules, notes);
  note_shape(target, plan, rules, notes);
  return notes;
}

}  // namespace lilytank
