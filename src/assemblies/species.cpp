// Which assemblies a ruleset can make: its rules applied to patterns until nothing new comes.
#include <algorithm>
#include <map>
#include <set>

#include "assemblies/pattern.hpp"

namespace lilytank {
namespace {

// Joins that may be tried before the search is given up; keeps rulesets with very many species
// from holding up the start of a run.
constexpr int kMostJoins = 200000;

class Explorer {
 public:
  Explorer(const Ruleset& rules, int limit, int largest)
      : rules_(rules), target_(canonical_shape(rules.target)), limit_(limit), largest_(largest) {}
  void add(const Pattern& pattern);
  SpeciesTable run();

 private:
  // A side of a module with no neighbour, where another assembly may come.
  struct Site {
    std::size_t pattern, module;
    int direction;
  };
  using LabelKey = std::pair<int, int>;

  static LabelKey label(const PatternModule& m, int direction) {
    return {m.label, hop_of(m.last, direction)};
  }
  static LabelKey label(const Label& l) { return {l.state, l.hop}; }
  static void relabel(PatternModule& m, int direction, const Label& after) {
    m.label = after.state;
    m.last = last_after(direction, after.hop);
  }
  void explore(std::size_t index);
  void meet(const Site& site);
  void join(const Site& a, const Site& b, const Label& after_a, const Label& after_b);
  void change(const Pattern& pattern, std::size_t a, std::size_t b, int direction);
  void add_parts(const Pattern& pattern);

  const Ruleset& rules_;
  std::vector<Cell> target_;
  int limit_, largest_, joins_ = 0;
  bool closed_ = true;
  std::vector<Pattern> patterns_;
  std::set<std::string> keys_;
  std::map<LabelKey, std::vector<Site>> sites_;
};

void Explorer::add(const Pattern& pattern) {
  if (static_cast<int>(pattern.size()) > largest_) return;
  Pattern least = canonical(pattern);
  if (keys_.count(key_of(least)) > 0) return;
  if (static_cast<int>(patterns_.size()) >= limit_) {
    closed_ = false;
    return;
  }
  keys_.insert(key_of(least));
  patterns_.push_back(std::move(least));
}

std::size_t module_at(const Pattern& pattern, Cell cell) {
  std::size_t k = 0;
  while (k < pattern.size() && pattern[k].cell != cell) ++k;
  return k;
}

// Parts over bonds, each a pattern of its own.
void Explorer::add_parts(const Pattern& pattern) {
  std::vector<bool> done(pattern.size(), false);
  for (std::size_t k = 0; k < pattern.size(); ++k) {
    if (done[k]) continue;
    Pattern part;
    std::vector<std::size_t> edge = {k};
    done[k] = true;
    while (!edge.empty()) {
      const PatternModule& m = pattern[edge.back()];
      edge.pop_back();
      part.push_back(m);
      for (int d = 0; d < 4; ++d) {
        if ((m.bonds >> d & 1u) == 0) continue;
        const std::size_t n = module_at(pattern, neighbour(m.cell, d));
        if (!done[n]) done[n] = true, edge.push_back(n);
      }
    }
    add(part);
  }
}

// Two neighbours in one pattern: rules on their bond, or link rules on their contact.
void Explorer::change(const Pattern& pattern, std::size_t a, std::size_t b, int direction) {
  const bool standing = (pattern[a].bonds >> direction & 1u) != 0;
  for (const Rule& rule : rules_.rules) {
    if (!(rule.p > 0) || (rule.kind != RuleKind::link) != standing) continue;
    for (int order = 0; order < 2; ++order) {
      if (label(rule.before[order]) != label(pattern[a], direction) ||
          label(rule.before[1 - order]) != label(pattern[b], (direction + 2) & 3))
        continue;
      Pattern changed = pattern;
      relabel(changed[a], direction, rule.after[order]);
      relabel(changed[b], (direction + 2) & 3, rule.after[1 - order]);
      const unsigned bit_a = 1u << direction, bit_b = 1u << ((direction + 2) & 3);
      if (rule.kind == RuleKind::link) changed[a].bonds |= bit_a, changed[b].bonds |= bit_b;
      if (rule.kind == RuleKind::unlink) changed[a].bonds &= ~bit_a, changed[b].bonds &= ~bit_b;
      add_parts(changed);
    }
  }
}

// Pattern b comes to a's side, turned and moved to fit; nothing happens if they would overlap.
// Contacts other than the one that joins stay without a bond.
void Explorer::join(const Site& a, const Site& b, const Label& after_a, const Label& after_b) {
  if (joins_ >= kMostJoins) {
    closed_ = false;
    return;
  }
  ++joins_;
  Pattern whole = patterns_[a.pattern], guest = patterns_[b.pattern];
  if (static_cast<int>(whole.size() + guest.size()) > largest_) return;
  const int turns = (a.direction + 2 - b.direction) & 3;
  for (int t = 0; t < turns; ++t) guest = turned(std::move(guest));
  const Cell to = neighbour(whole[a.module].cell, a.direction), from = guest[b.module].cell;
  for (PatternModule& m : guest) {
    m.cell = {m.cell.x - from.x + to.x, m.cell.y - from.y + to.y};
    if (module_at(whole, m.cell) < whole.size()) return;
  }
  const int back = (a.direction + 2) & 3;
  relabel(whole[a.module], a.direction, after_a);
  relabel(guest[b.module], back, after_b);
  whole[a.module].bonds |= 1u << a.direction;
  guest[b.module].bonds |= 1u << back;
  whole.insert(whole.end(), guest.begin(), guest.end());
  add(whole);
}

// All joins of a new site with the known ones (itself among them).
void Explorer::meet(const Site& site) {
  const LabelKey own = label(patterns_[site.pattern][site.module], site.direction);
  sites_[own].push_back(site);
  for (const Rule& rule : rules_.rules) {
    if (rule.kind != RuleKind::link || !(rule.p > 0)) continue;
    for (int order = 0; order < 2; ++order) {
      if (label(rule.before[order]) != own) continue;
      const auto others = sites_.find(label(rule.before[1 - order]));
      if (others == sites_.end()) continue;
      for (const Site& other : others->second)
        join(site, other, rule.after[order], rule.after[1 - order]);
    }
  }
}

void Explorer::explore(std::size_t index) {
  const Pattern pattern = patterns_[index];  // a copy: the list grows
  for (std::size_t k = 0; k < pattern.size(); ++k) {
    for (int d = 0; d < 4; ++d) {
      const std::size_t n = module_at(pattern, neighbour(pattern[k].cell, d));
      if (n < pattern.size()) {
        if (d < 2) change(pattern, k, n, d);
      } else if (pattern.size() > 1 || d == 0 || pattern[k].last >= 0) {
        // A lone isolated module has four equal sides: one stands for all.
        meet({index, k, d});
      }
    }
  }
}

SpeciesTable Explorer::run() {
  for (std::size_t k = 0; k < patterns_.size(); ++k) explore(k);
  SpeciesTable table;
  table.closed = closed_;
  for (const Pattern& pattern : patterns_) table.species.push_back(species_of(pattern, target_));
  return table;
}

}  // namespace

bool SpeciesTable::contains(const std::string& key) const {
  return std::any_of(species.begin(), species.end(),
                     [&](const Species& s) { return s.key == key; });
}

SpeciesTable species_from(const Ruleset& rules, const std::vector<Pattern>& seeds, int limit,
                          int largest) {
  Explorer explorer(rules, limit, largest);
  explorer.add({PatternModule{}});
  for (const Pattern& seed : seeds) explorer.add(seed);
  return explorer.run();
}

SpeciesTable reachable_species(const Ruleset& rules, int limit, int largest) {
  return species_from(rules, {}, limit, largest);
}

}  // namespace lilytank
