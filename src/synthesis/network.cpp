// The reaction network of a ruleset: species by exploration, and the reactions among them.
#include <algorithm>
#include <map>

#include "lilytank/lattice.hpp"
#include "model/ruleset_scanner.hpp"
#include "synthesis/steric.hpp"

namespace lilytank {
namespace {

// Meetings that may be tried before the search is given up.
constexpr int kMostMeetings = 2000000;

// What a reaction was found to be, without its places.
struct ReactionKey {
  int rule = -1;
  std::vector<int> from, to;
  friend auto operator<=>(const ReactionKey&, const ReactionKey&) = default;
};

// A join that no way leads to; what it would make is known only by its pattern.
struct Blocked {
  int rule = -1;
  std::vector<int> from;
  std::string made;
  friend auto operator<=>(const Blocked&, const Blocked&) = default;
};

// Two modules with equal labels: either may initiate and take the first right side. Where the right
// sides are equal, too, both orders are one.
std::size_t orders_of(const Rule& rule) {
  return rule.before[0] == rule.before[1] && rule.after[0] == rule.after[1] ? 1 : 2;
}

// Share of the places at which an order that fits is taken.
double share_of_order(const Rule& rule) {
  return rule.before[0] == rule.before[1] && orders_of(rule) == 2 ? 0.5 : 1;
}

class Network {
 public:
  Network(const Ruleset& rules, const NetworkOptions& options) : rules_(rules), options_(options) {}

  ReactionNetwork run() {
    add({PatternModule{}});
    for (int k = 0; k < static_cast<int>(patterns_.size()); ++k) {
      inside(k);
      for (int other = 0; other <= k; ++other) meet(k, other);
    }
    ReactionNetwork network;
    network.closed = closed_;
    network.unrestored = std::move(unrestored_);
    const std::vector<Cell> target = canonical_shape(rules_.target);
    for (const Pattern& pattern : patterns_) network.species.push_back(species_of(pattern, target));
    const auto kind = [&](int rule) { return rules_.rules[rule].kind; };
    for (const auto& [key, places] : reactions_)
      network.reactions.push_back({key.rule, kind(key.rule), key.from, key.to, places});
    for (const auto& [key, places] : blocked_) {
      const auto made = index_.find(key.made);
      std::vector<int> to;
      if (made != index_.end()) to.push_back(made->second);
      network.blocked.push_back({key.rule, RuleKind::link, key.from, to, places});
    }
    return network;
  }

 private:
  bool fires(const Rule& rule) const { return options_.never || rule.p > 0; }

  // The species of a pattern; -1 if it is larger than options_.largest.
  int add(const Pattern& pattern) {
    if (static_cast<int>(pattern.size()) > options_.largest) return -1;
    Pattern least = canonical(pattern);
    const std::string key = key_of(least);
    const auto known = index_.find(key);
    if (known != index_.end()) return known->second;
    if (static_cast<int>(patterns_.size()) >= options_.limit) {
      closed_ = false;
      return -1;
    }
    const int index = static_cast<int>(patterns_.size());
    patterns_.push_back(std::move(least));
    index_.emplace(key, index);
    return index;
  }

  void inside(int index) {
    const Pattern pattern = patterns_[index];  // a copy: the list grows
    for (std::size_t k = 0; k < pattern.size(); ++k) {
      for (int d = 0; d < 2; ++d) {
        const std::size_t n = module_at(pattern, neighbour(pattern[k].cell, d));
        if (n < pattern.size()) bond(index, pattern, k, n, d);
      }
    }
  }

  // Neighbours in one assembly: rules on their bond, or link rules on their contact.
  void bond(int index, const Pattern& pattern, std::size_t a, std::size_t b, int direction) {
    const bool standing = (pattern[a].bonds >> direction & 1u) != 0;
    const Label la = label_at(pattern[a], direction), lb = label_at(pattern[b], direction + 2);
    for (std::size_t r = 0; r < rules_.rules.size(); ++r) {
      const Rule& rule = rules_.rules[r];
      if ((rule.kind != RuleKind::link) != standing) continue;
      if (!fires(rule) && rule.kind != RuleKind::unlink) continue;
      for (std::size_t order = 0; order < orders_of(rule); ++order) {
        if (!fits(rule, order, la, lb)) continue;
        Pattern changed = pattern;
        apply(rule, order, changed, a, b, direction);
        if (rule.kind == RuleKind::unlink) check_undone(pattern, changed, a, b, direction, r);
        if (!fires(rule)) continue;
        std::vector<int> to;
        for (const Pattern& part : parts_of(changed)) to.push_back(add(part));
        record(r, {index}, std::move(to));
      }
    }
  }

  // Whether linking again what an unlink rule has parted would give both modules their states back.
  void check_undone(const Pattern& before, const Pattern& after, std::size_t a, std::size_t b,
                    int direction, std::size_t rule) {
    const std::string& name = rules_.rules[rule].name;
    for (const std::size_t k : {a, b}) {
      if ((after[k].label == 0) != (after[k].bonds == 0)) {
        unrestored_.try_emplace(
            static_cast<int>(rule),
            name + (after[k].label == 0 ? " makes a module isolated that others still hold"
                                        : " leaves a control state to a module that nobody holds"));
        return;
      }
    }
    const Label la = label_at(after[a], direction), lb = label_at(after[b], direction + 2);
    bool known = false;
    for (const Rule& link : rules_.rules) {
      if (link.kind != RuleKind::link) continue;
      for (std::size_t order = 0; order < 2; ++order) {
        if (!fits(link, order, la, lb)) continue;
        known = true;
        Pattern again = after;
        apply(link, order, again, a, b, direction);
        if (again == before) return;
      }
    }
    unrestored_.try_emplace(
        static_cast<int>(rule),
        name + " leaves the labels " + text_of(la) + " and " + text_of(lb) +
            " at the faces it releases, " +
            (known ? "which join to something else than before" : "which no rule joins again"));
  }

  // All joins of an assembly of species i with one of species j.
  void meet(int i, int j) {
    const Pattern host = patterns_[i];  // copies: the list grows
    const Pattern guest = patterns_[j];
    if (static_cast<int>(host.size() + guest.size()) > options_.largest) return;
    const std::vector<Site> ours = free_sites(host), theirs = free_sites(guest);
    for (std::size_t r = 0; r < rules_.rules.size(); ++r) {
      const Rule& rule = rules_.rules[r];
      if (rule.kind != RuleKind::link || !fires(rule)) continue;
      for (std::size_t order = 0; order < orders_of(rule); ++order) {
        for (const Site& a : ours) {
          if (label_at(host[a.module], a.direction) != rule.before[order]) continue;
          for (const Site& b : theirs)
            if (label_at(guest[b.module], b.direction) == rule.before[1 - order])
              join(i, j, host, a, guest, b, r, order);
        }
      }
    }
  }

  void join(int i, int j, const Pattern& host, const Site& ours, const Pattern& guest,
            const Site& theirs, std::size_t rule, std::size_t order) {
    if (++meetings_ > kMostMeetings) {
      closed_ = false;
      return;
    }
    auto whole = beside(host, ours, guest, theirs);
    if (!whole) return;
    const Rule& r = rules_.rules[rule];
    const bool free = !options_.sterics || free_to_meet(*whole, host.size(), ours);
    apply(r, order, *whole, ours.module, host.size() + theirs.module, ours.direction);
    if (free)
      record(rule, {i, j}, {add(*whole)});
    else
      blocked_[{
          static_cast<int>(rule), {std::min(i, j), std::max(i, j)}, key_of(canonical(*whole))}] +=
          share_of_order(r);
  }

  void record(std::size_t rule, std::vector<int> from, std::vector<int> to) {
    std::sort(from.begin(), from.end());
    std::sort(to.begin(), to.end());
    if (!to.empty() && to.front() < 0) return;
    reactions_[{static_cast<int>(rule), std::move(from), std::move(to)}] +=
        share_of_order(rules_.rules[rule]);
  }

  const Ruleset& rules_;
  const NetworkOptions& options_;
  std::vector<Pattern> patterns_;
  std::map<std::string, int> index_;
  std::map<ReactionKey, double> reactions_;
  std::map<Blocked, double> blocked_;
  std::map<int, std::string> unrestored_;
  int meetings_ = 0;
  bool closed_ = true;
};

}  // namespace

int ReactionNetwork::find(const std::string& key) const {
  for (std::size_t k = 0; k < species.size(); ++k)
    if (species[k].key == key) return static_cast<int>(k);
  return -1;
}

ReactionNetwork reaction_network(const Ruleset& rules, const NetworkOptions& options) {
  return Network(rules, options).run();
}

}  // namespace lilytank
