// Monte Carlo of label dynamics: modules on lattices that meet at random, without water.
#include <algorithm>
#include <array>

#include "lilytank/lattice.hpp"
#include "lilytank/random.hpp"
#include "synthesis/steric.hpp"

namespace lilytank {
namespace {

// A face pair of one assembly, and what became of it.
struct Touch {
  std::size_t a = 0, b = 0;
  int direction = 0;  // from a to b
};

class LatticeWorld {
 public:
  LatticeWorld(const Ruleset& rules, const ReactionNetwork& network, const LatticeOptions& options)
      : rules_(rules), options_(options), target_(canonical_shape(rules.target)) {
    for (std::size_t k = 0; k < network.species.size(); ++k)
      legal_[network.species[k].key] = static_cast<int>(k);
    assemblies_.assign(options.modules, {PatternModule{}});
    if (!target_.empty()) result_.possible = options.modules / static_cast<int>(target_.size());
  }

  LatticeResult run() {
    std::int64_t changes = -1;
    while (result_.attempts < options_.attempts) {
      options_.check_stop();
      index_ = 0;
      attempt();
      evaluate_bonds();
      ++result_.attempts;
      if (changes != result_.links + result_.unlinks) {
        changes = result_.links + result_.unlinks;
        count();
      }
      const bool full = result_.possible > 0 && result_.copies == result_.possible;
      if (full && !options_.to_the_end) break;
    }
    for (const Pattern& pattern : assemblies_)
      ++result_.standing[species_of(canonical(pattern), target_).drawing];
    return result_;
  }

 private:
  double draw() { return uniform({options_.seed, Stream::lattice, result_.attempts, 0, index_++}); }
  std::size_t below(std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(draw() * static_cast<double>(n)));
  }

  void attempt() {
    const std::size_t n = assemblies_.size();
    if (n < 2) return;
    const std::size_t i = below(n);
    std::size_t j = below(n - 1);
    if (j >= i) ++j;
    const std::vector<Site> ours = free_sites(assemblies_[i]), theirs = free_sites(assemblies_[j]);
    const Site a = ours[below(ours.size())], b = theirs[below(theirs.size())];
    const auto whole = beside(assemblies_[i], a, assemblies_[j], b);
    if (whole)
      meet(i, j, *whole, assemblies_[i].size(), a);
    else
      ++result_.crowded;
  }

  void meet(std::size_t i, std::size_t j, const Pattern& placed, std::size_t host,
            const Site& ours) {
    std::vector<Touch> touches;
    for (std::size_t a = 0; a < host; ++a) {
      for (int d = 0; d < 4; ++d) {
        const std::size_t b = module_at(placed, neighbour(placed[a].cell, d));
        if (b >= host && b < placed.size()) touches.push_back({a, b, d});
      }
    }
    // What no rule would hold is not worth the search for a way.
    if (!any_rule(placed, touches)) {
      ++result_.refusals;
      return;
    }
    if (!free_to_meet(placed, host, ours)) {
      ++result_.blocked;
      return;
    }
    Pattern whole = placed;
    int bonds = 0;
    while (!touches.empty()) {
      const std::size_t k = below(touches.size());
      bonds += negotiate(whole, touches[k]) ? 1 : 0;
      touches.erase(touches.begin() + static_cast<std::ptrdiff_t>(k));
    }
    if (bonds == 0) {
      ++result_.refusals;
      return;
    }
    result_.double_bonds += bonds > 1 ? 1 : 0;
    appeared(whole);
    assemblies_[i] = std::move(whole);
    assemblies_.erase(assemblies_.begin() + static_cast<std::ptrdiff_t>(j));
  }

  bool any_rule(const Pattern& whole, const std::vector<Touch>& touches) const {
    return std::any_of(touches.begin(), touches.end(), [&](const Touch& touch) {
      return match(rules_, label_at(whole[touch.a], touch.direction),
                   label_at(whole[touch.b], touch.direction + 2), false, 0)
          .applicable;
    });
  }

  // One new contact until it is decided; true if it became a bond.
  bool negotiate(Pattern& whole, const Touch& touch) {
    const Label la = label_at(whole[touch.a], touch.direction);
    const Label lb = label_at(whole[touch.b], touch.direction + 2);
    // Rules whose p are all 0 hold a latch for ever without a bond; here it lets go.
    if (match(rules_, la, lb, false, 0).rule < 0) return false;
    for (;;) {
      const bool straight = draw() < 0.5;  // who initiates
      const Match found = match(rules_, straight ? la : lb, straight ? lb : la, false, draw());
      if (found.rule < 0 && found.applicable) continue;
      if (found.rule < 0) return false;
      const Rule& rule = rules_.rules[found.rule];
      const std::size_t first = straight != found.swapped ? 0 : 1;  // the label of touch.a
      const Pattern before = whole;
      apply(rule, first, whole, touch.a, touch.b, touch.direction);
      ++result_.links;
      check_undoing(before, whole, touch);
      return true;
    }
  }

  // Undoes a join on a copy by each unlink rule that applies, and compares with what was before.
  void check_undoing(const Pattern& before, const Pattern& after, const Touch& touch) {
    const Label la = label_at(after[touch.a], touch.direction);
    const Label lb = label_at(after[touch.b], touch.direction + 2);
    for (const Rule& rule : rules_.rules) {
      if (rule.kind != RuleKind::unlink) continue;
      for (std::size_t order = 0; order < 2; ++order) {
        if (!fits(rule, order, la, lb)) continue;
        Pattern undone = after;
        apply(rule, order, undone, touch.a, touch.b, touch.direction);
        ++(undone == before ? result_.restored : result_.unrestored);
      }
    }
  }

  void evaluate_bonds() {
    for (std::size_t i = 0; i < assemblies_.size(); ++i) {
      bool whole = true;
      for (std::size_t k = 0; whole && k < assemblies_[i].size(); ++k) {
        for (int d = 0; whole && d < 2; ++d) {
          if ((assemblies_[i][k].bonds >> d & 1u) == 0 || draw() >= options_.evaluations) continue;
          whole = !evaluate(i, k, d);
        }
      }
    }
  }

  // True if the assembly fell apart, so that its modules are elsewhere now.
  bool evaluate(std::size_t assembly, std::size_t module, int direction) {
    Pattern& pattern = assemblies_[assembly];
    const std::size_t other = module_at(pattern, neighbour(pattern[module].cell, direction));
    const Label la = label_at(pattern[module], direction);
    const Label lb = label_at(pattern[other], direction + 2);
    const bool straight = draw() < 0.5;
    const Match found = match(rules_, straight ? la : lb, straight ? lb : la, true, draw());
    if (found.rule < 0) return false;
    const Rule& rule = rules_.rules[found.rule];
    const std::size_t first = straight != found.swapped ? 0 : 1;
    apply(rule, first, pattern, module, other, direction);
    if (rule.kind == RuleKind::update) {
      appeared(pattern);
      return false;
    }
    ++result_.unlinks;
    std::vector<Pattern> parts = parts_of(pattern);
    for (const Pattern& part : parts) appeared(part);
    assemblies_[assembly] = std::move(parts.front());
    for (std::size_t k = 1; k < parts.size(); ++k) assemblies_.push_back(std::move(parts[k]));
    return parts.size() > 1;
  }

  void appeared(const Pattern& pattern) {
    const Pattern least = canonical(pattern);
    if (legal_.count(key_of(least)) > 0) return;
    ++result_.illegal;
    if (result_.first_illegal.empty()) result_.first_illegal = species_of(least, target_).drawing;
  }

  void count() {
    result_.copies = 0;
    for (const Pattern& pattern : assemblies_) {
      if (pattern.size() != target_.size() || target_.empty()) continue;
      std::vector<Cell> cells;
      for (const PatternModule& module : pattern) cells.push_back(module.cell);
      result_.copies += canonical_shape(std::move(cells)) == target_ ? 1 : 0;
    }
    while (static_cast<int>(result_.completion.size()) < result_.copies)
      result_.completion.push_back(result_.attempts);
  }

  const Ruleset& rules_;
  const LatticeOptions& options_;
  std::map<std::string, int> legal_;
  std::vector<Cell> target_;
  std::vector<Pattern> assemblies_;
  LatticeResult result_;
  std::uint32_t index_ = 0;
};

}  // namespace

LatticeResult run_lattice(const Ruleset& rules, const ReactionNetwork& network,
                          const LatticeOptions& options) {
  if (options.modules < 1) throw InputError("a lattice simulation needs one module or more");
  return LatticeWorld(rules, network, options).run();
}

}  // namespace lilytank
