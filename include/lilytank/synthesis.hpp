// From a target to a ruleset: a plan (spanning tree and order of joins), and the rules that make
// modules follow it [paper, section 5.1].
//
// Every join of a plan becomes a link rule and the unlink rule that takes it back. Join k gives the
// modules that it engages the control states 2k-1 and 2k, so that a label tells how often and where
// a module has engaged, and a reverse rule needs no memory but its hop.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "lilytank/ruleset.hpp"
#include "lilytank/target.hpp"

namespace lilytank {

/// How the order of joins is chosen.
enum class Algorithm {
  singleton,  ///< one module at a time, the paper's SingletonR
  linchpin,   ///< two parts, each one module at a time, are joined last at one bond
  balanced,   ///< every part is made of two parts as equal as can be
  plan,       ///< the user's tree and order
};
/// "singleton", "linchpin", "balanced", "plan".
const std::vector<std::string>& algorithm_names();
/// Throws InputError that names the nearest right word.
Algorithm algorithm_of(const std::string& name);

/// The order of joins. joins[k] bonds the cells a and b; a's module gets the odd control state.
/// Together the joins are a spanning tree of the target.
struct Plan {
  Algorithm algorithm = Algorithm::singleton;
  std::vector<Contact> joins;
};

/// Breadth-first from the first cell, neighbours in raster order, over the drawn bonds if there are
/// any. n - 1 contacts.
std::vector<Contact> spanning_tree(const Target& target);
/// All spanning trees over the drawn bonds or all contacts, `limit` at most.
std::vector<std::vector<Contact>> spanning_trees(const Target& target, std::size_t limit);
/// Whether a tree of `cells` nodes becomes a path when its leaves are taken off. One-at-a-time
/// growth with a single last join is possible exactly on these.
bool is_caterpillar(int cells, const std::vector<Contact>& tree);

/// SingletonR on a tree: grows from one end to the other so that as few joins as possible are
/// maximal (see maximal_joins), then as few as possible sterically blocked.
Plan singleton_plan(const Target& target, const std::vector<Contact>& tree);
/// Both parts of the tree at edge `linchpin` (an index into tree, -1: the most equal parts) grow
/// from their far ends towards it, so that its join is the only maximal one on any tree.
Plan linchpin_plan(const Target& target, const std::vector<Contact>& tree, int linchpin = -1);
/// Splits at the edge with the most equal parts, each part again, and joins in reverse.
Plan balanced_plan(const Target& target, const std::vector<Contact>& tree);
/// A plan by an algorithm's name. Without drawn bonds the breadth-first tree is used; where its
/// plan has several maximal joins or a blocked one, the first of all spanning trees whose plan is
/// better. Algorithm::plan needs a target whose bonds are numbered. Throws InputError.
Plan make_plan(const Target& target, Algorithm algorithm);
/// Throws InputError if the joins are not a spanning tree of the target.
void check_plan(const Target& target, const Plan& plan);

/// Indices of joins that are the last one of both their modules: only these can be taken back in
/// the finished target, and they must not be, if it is to last.
std::vector<int> maximal_joins(const Target& target, const Plan& plan);
/// Indices of joins for which no straight way leads one finished part to the other.
std::vector<int> blocked_joins(const Target& target, const Plan& plan);
/// Contacts of the target that the plan leaves without a bond.
std::vector<Contact> open_contacts(const Target& target, const Plan& plan);

/// Probabilities of reverse rules, and rules for loops.
struct EmitOptions {
  /// Probabilities of r1_reverse, r2_reverse, ...; those not given are 0 for maximal joins, and
  /// else 0.01, 0.005 or 0.000025 for joins that make 2, 3, or more modules (after the paper's
  /// p_e).
  std::vector<double> p;
  /// Rules c1, c2, ... for contacts that close a loop between modules that have made their last
  /// join. Such a rule can only fire if its contact is evaluated after the join that made it.
  bool closures = false;
};
/// The rules r1, r2, ... of a plan, then r1_reverse, ...; rules that share the left side (0,0)(0,0)
/// get equal shares of probability 1. Throws InputError for a bad plan or p.
Ruleset emit(const Target& target, const Plan& plan, const EmitOptions& options = {});

/// Something that a user should know about a ruleset, in plain words.
enum class NoteKind { maximal, caterpillar, loops, chirality, sterics, seeds, deadlock };
struct Note {
  NoteKind kind;
  bool warning = false;  ///< else a mere remark
  std::string text;      ///< one sentence or two
};
/// `modules`: how many there will be, 0: unknown (deadlocks are then not judged).
std::vector<Note> notes_on(const Target& target, const Plan& plan, const Ruleset& rules,
                           int modules);

/// Bounds on the enumeration of plans; beyond them PlanList::complete is false.
struct PlanLimits {
  std::size_t trees = 1000;   ///< spanning trees
  std::size_t orders = 2000;  ///< per tree and algorithm
  std::size_t plans = 5000;   ///< in all
};
/// Plans of a target: all spanning trees, algorithms and orders of visiting, those with the fewest
/// maximal joins that an algorithm has on a tree; none blocked if there are any such. Plans whose
/// rules differ only in the naming of control states are taken once.
struct PlanList {
  std::vector<Plan> plans;
  bool complete = true;  ///< no limit was met
};
/// Deterministic order: by tree, algorithm and order of visiting.
PlanList all_plans(const Target& target, const PlanLimits& limits = {});
/// Equal for rulesets that differ only in the naming and order of control states and rules.
std::uint64_t structure_of(const Ruleset& rules);

/// What stands after each join, for drawings [paper, Figs. 9 and 11]: a module in a cell of the
/// target.
struct StageModule {
  int cell = 0;          ///< index into Target::cells
  int label = 0;         ///< l_a
  int last = -1;         ///< direction of l_n, -1: isolated
  unsigned bonds = 0;    ///< Bit d: bonded towards direction d
  bool engaged = false;  ///< by this stage's join
};
/// One drawing of an assembly.
struct Stage {
  std::string rule, text;  ///< "r2", "(1,3) (0,0) -> (3,1)-(4,1)"; empty for the first stage
  std::vector<StageModule> modules;  ///< all placed so far; of the first stage a single module
};
/// One stage before the first join and one after each.
std::vector<Stage> stages_of(const Target& target, const Plan& plan);

}  // namespace lilytank
