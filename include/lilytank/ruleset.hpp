// Rulesets: what two latched modules do when they have exchanged their states
// [paper, section 5.1].
//
// A module's state is a control state l_a (0: isolated) and l_n, the connector it engaged last.
// Hop convention, everywhere in this library: connectors 0..3 count counter-clockwise seen from
// above. On the left of a rule, hop = 1 + the number of counter-clockwise connector steps from l_n
// to the connector now engaged; 0 for an isolated module. On the right, hop = 1 + the number of
// counter-clockwise steps from the engaged connector to the one that becomes l_n; 0 makes the
// module isolated again. A forward rule's right side therefore reads (l_a,1), and a reverse rule
// that undoes a join made at hop h reads ((1 - h) mod 4) + 1.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "lilytank/error.hpp"

namespace lilytank {

/// One side of a rule: control state and hop, (0,0) for an isolated module.
struct Label {
  int state = 0;  ///< control state l_a, 0..255
  int hop = 0;    ///< hop l_h, 0..4
  friend bool operator==(const Label&, const Label&) = default;
};

/// What a rule does to the connection. Labels before it on the left, after it on the right.
enum class RuleKind {
  link,    ///< (a,h) (b,h') -> (c,i)-(d,j): a new latch becomes a bond
  unlink,  ///< (a,h)-(b,h') -> (c,i) (d,j): a bond is released
  update,  ///< (a,h)-(b,h') -> (c,i)-(d,j): labels change on a standing bond
};

/// A rewriting rule on the labels of two modules that hold each other.
struct Rule {
  std::string name;  ///< as in the scenario key rules.<name>.p
  RuleKind kind = RuleKind::link;
  /// Labels of both modules, left and right side. Either module may be the first.
  std::array<Label, 2> before, after;
  /// Probability per evaluation, 0 .. 1. Rules with the same left side must not sum to more than 1.
  double p = 1;
  SourcePlace where;  ///< where the file defines it, for messages
};

/// A cell of a target drawing, x to the right, y up.
struct Cell {
  int x = 0, y = 0;
  friend bool operator==(const Cell&, const Cell&) = default;
  friend auto operator<=>(const Cell&, const Cell&) = default;
};

/// The rules that all modules follow, and the shape that they are meant to build.
struct Ruleset {
  std::string name;
  /// In the file's order, which decides how rules with the same left side divide [0,1).
  std::vector<Rule> rules;
  /// Cells of the target; may be empty. One-sided: rotated copies count, mirrored ones do not.
  std::vector<Cell> target;
  std::string file;  ///< path of the file that it was read from; empty if it was made by a program
};

/// Hop of an engaged connector: 1 + ((connector - last) mod 4), or 0 for last < 0 (isolated).
int hop_of(int last, int connector);
/// The connector that becomes l_n by a right-hand hop at the engaged connector; -1 for hop 0.
int last_after(int connector, int hop);
/// The right-hand hop of a reverse rule that undoes a join made at left-hand hop h.
int reverse_hop(int hop);

/// Outcome of an evaluation.
struct Match {
  int rule = -1;  ///< index into Ruleset::rules; -1: no rule fires
  /// The rule's first label is the responder's. For equal labels the initiator comes first.
  bool swapped = false;
  bool applicable = false;  ///< some rule has this left side, whether or not u let it fire
};
/// The rule that fires when `initiator` and `responder` have exchanged labels over a connection,
/// with the initiator's random number u in (0,1). Rules with this left side and kind divide [0,1)
/// by their probabilities in the file's order; none fires if u lies beyond their sum. `standing`:
/// the connection is a bond already (unlink and update rules), else a new latch (link rules).
Match match(const Ruleset& rules, Label initiator, Label responder, bool standing, double u);

/// The labels that final joins leave, a pair a join: those of link rules whose labels no link or
/// update rule goes on from. A finished copy holds one module of each.
std::vector<std::array<int, 2>> final_labels(const Ruleset& rules);

/// Finished copies by the labels of `modules` modules, label_of(i), and by those that final joins
/// leave: a join has two modules; of several joins the one that was made least often counts.
template <class LabelOf>
int finished_copies(const std::vector<std::array<int, 2>>& joins, int modules, LabelOf&& label_of) {
  int fewest = joins.empty() ? 0 : modules;
  for (const auto& [a, b] : joins) {
    int with = 0;
    for (int i = 0; i < modules; ++i) with += label_of(i) == a || label_of(i) == b ? 1 : 0;
    fewest = fewest < with / 2 ? fewest : with / 2;
  }
  return fewest;
}

/// Reads the text format described in scenarios/rulesets/README.md. Throws InputError with file,
/// line, column, the offending word and what was expected.
Ruleset parse_ruleset(const std::string& text, const std::string& file);
/// parse_ruleset() of a file's content. Throws InputError also if the file cannot be read.
Ruleset read_ruleset(const std::string& file);

/// Copies of the target that so many modules can make; 0 without a target.
int possible_copies(const Ruleset& rules, int modules);
/// How often a link rule fires of all dockings that fire one with its left side, in either order:
/// its p as a share of all of theirs, 0 where that is 0.
double docking_share(const Ruleset& rules, const Rule& rule);
/// Throws InputError where a p is outside [0,1] or the rules that share a left side (and with it
/// one random number) have p that add up to more than 1. For callers that change p after reading.
void check_probabilities(const Ruleset& rules);
/// Writes a ruleset so that parse_ruleset gives it back.
std::string to_text(const Ruleset& rules);

/// Cells moved to the origin and turned to the least of the four turns: equal for equal one-sided
/// shapes.
std::vector<Cell> canonical_shape(std::vector<Cell> cells);

}  // namespace lilytank
