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

  void add(const Pattern& pattern) {
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

  SpeciesTable run() {
    for (std::size_t k = 0; k < patterns_.size(); ++k) explore(k);
    SpeciesTable table;
    table.closed = closed_;
    for (const Pattern& pattern : patterns_) table.species.push_back(species_of(pattern, target_));
    return table;
  }

 private:
  // A free face of a pattern, where another assembly may come.
  struct Place {
    std::size_t pattern;
    Site site;
  };
  using LabelKey = std::pair<int, int>;
  static LabelKey key(const Label& label) { return {label.state, label.hop}; }

  // Two neighbours in one pattern: rules on their bond, or link rules on their contact.
  void change(const Pattern& pattern, std::size_t a, std::size_t b, int direction) {
    const bool standing = (pattern[a].bonds >> direction & 1u) != 0;
    const Label la = label_at(pattern[a], direction), lb = label_at(pattern[b], direction + 2);
    for (const Rule& rule : rules_.rules) {
      if (!(rule.p > 0) || (rule.kind != RuleKind::link) != standing) continue;
      for (std::size_t order = 0; order < 2; ++order) {
        if (!fits(rule, order, la, lb)) continue;
        Pattern changed = pattern;
        apply(rule, order, changed, a, b, direction);
        for (const Pattern& part : parts_of(changed)) add(part);
      }
    }
  }

  // Contacts other than the one that joins stay without a bond.
  void join(const Place& a, const Place& b, const Rule& rule, std::size_t order) {
    if (joins_ >= kMostJoins) {
      closed_ = false;
      return;
    }
    ++joins_;
    const Pattern &host = patterns_[a.pattern], &guest = patterns_[b.pattern];
    if (static_cast<int>(host.size() + guest.size()) > largest_) return;
    auto whole = beside(host, a.site, guest, b.site);
    if (!whole) return;
    apply(rule, order, *whole, a.site.module, host.size() + b.site.module, a.site.direction);
    add(*whole);
  }

  // All joins of a new face with the known ones (itself among them).
  void meet(const Place& place) {
    const Label own = label_at(patterns_[place.pattern][place.site.module], place.site.direction);
    places_[key(own)].push_back(place);
    for (const Rule& rule : rules_.rules) {
      if (rule.kind != RuleKind::link || !(rule.p > 0)) continue;
      for (std::size_t order = 0; order < 2; ++order) {
        if (rule.before[order] != own) continue;
        const auto others = places_.find(key(rule.before[1 - order]));
        if (others == places_.end()) continue;
        for (const Place& other : others->second) join(place, other, rule, order);
      }
    }
  }

  void explore(std::size_t index) {
    const Pattern pattern = patterns_[index];  // a copy: the list grows
    for (std::size_t k = 0; k < pattern.size(); ++k) {
      for (int d = 0; d < 4; ++d) {
        const std::size_t n = module_at(pattern, neighbour(pattern[k].cell, d));
        if (n < pattern.size()) {
          if (d < 2) change(pattern, k, n, d);
        } else if (pattern.size() > 1 || d == 0 || pattern[k].last >= 0) {
          // A lone isolated module has four equal sides: one stands for all.
          meet({index, {k, d}});
        }
      }
    }
  }

  const Ruleset& rules_;
  std::vector<Cell> target_;
  int limit_, largest_, joins_ = 0;
  bool closed_ = true;
  std::vector<Pattern> patterns_;
  std::set<std::string> keys_;
  std::map<LabelKey, std::vector<Place>> places_;
};

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
