#include "lilytank/ruleset.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "support/control_rig.hpp"

using namespace lilytank;
using lilytank::test::rules_of;
using lilytank::test::ruleset_file;
using lilytank::test::shipped_rulesets;

namespace {

const std::string kHead = "lilytank ruleset 1\nhops counter-clockwise\n";
const std::string kRule = "(0,0) (0,0) -> (1,1)-(2,1)\n";

std::string message(const std::string& text) {
  try {
    parse_ruleset(text, "bad.rules");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

struct Bad {
  std::string text, says;
};

void expect_messages(const std::vector<Bad>& cases) {
  for (const Bad& bad : cases) EXPECT_EQ(message(bad.text), bad.says) << bad.text;
}

TEST(Hop, CountsCounterClockwiseFromTheLastConnector) {
  EXPECT_EQ(hop_of(-1, 2), 0);  // isolated: connectors are anonymous
  EXPECT_EQ(hop_of(1, 1), 1);
  EXPECT_EQ(hop_of(1, 2), 2);
  EXPECT_EQ(hop_of(1, 3), 3);
  EXPECT_EQ(hop_of(1, 0), 4);
  EXPECT_EQ(hop_of(3, 0), 2);
}

TEST(Hop, ReverseHopUndoesAJoin) {
  EXPECT_EQ(reverse_hop(1), 1);
  EXPECT_EQ(reverse_hop(2), 4);
  EXPECT_EQ(reverse_hop(3), 3);
  EXPECT_EQ(reverse_hop(4), 2);
  EXPECT_EQ(reverse_hop(0), 0);
  for (int last = -1; last < 4; ++last) {
    for (int connector = 0; connector < 4; ++connector) {
      const int hop = hop_of(last, connector);
      EXPECT_EQ(last_after(connector, reverse_hop(hop)), last) << last << " " << connector;
    }
  }
}

TEST(CanonicalShape, IgnoresTurnsAndPlaceButNotMirroring) {
  const std::vector<Cell> l = {{0, 2}, {0, 1}, {0, 0}, {1, 0}};
  const std::vector<Cell> j = {{1, 2}, {1, 1}, {1, 0}, {0, 0}};
  std::vector<Cell> turned;
  for (const Cell& c : l) turned.push_back({7 - c.y, c.x - 3});
  EXPECT_EQ(canonical_shape(turned), canonical_shape(l));
  EXPECT_NE(canonical_shape(j), canonical_shape(l));
  EXPECT_TRUE(canonical_shape({}).empty());
}

TEST(Match, TakesOnlyRulesOfTheConnectionsKind) {
  const Ruleset rules = rules_of("(1,1) (2,1) -> (3,1)-(4,1)\n(1,1)-(2,1) -> (0,0) (0,0) p=1\n");
  EXPECT_EQ(match(rules, {1, 1}, {2, 1}, false, 0.5).rule, 0);
  EXPECT_EQ(match(rules, {1, 1}, {2, 1}, true, 0.5).rule, 1);
  EXPECT_FALSE(match(rules, {1, 1}, {2, 2}, true, 0.5).applicable);
}

TEST(Match, FindsTheRuleWhicheverSideInitiates) {
  const Ruleset rules = rules_of("(1,3) (0,0) -> (3,1)-(4,1)\n");
  EXPECT_FALSE(match(rules, {1, 3}, {0, 0}, false, 0.5).swapped);
  EXPECT_TRUE(match(rules, {0, 0}, {1, 3}, false, 0.5).swapped);
}

TEST(Match, EqualLabelsPutTheInitiatorFirst) {
  const Match m = match(rules_of(kRule), {0, 0}, {0, 0}, false, 0.5);
  EXPECT_EQ(m.rule, 0);
  EXPECT_FALSE(m.swapped);
}

TEST(Match, RulesWithOneLeftSideShareTheRandomNumber) {
  const Ruleset rules = rules_of(
      "(0,0) (0,0) -> (1,1)-(2,1) p=0.5\n(5,1) (0,0) -> (9,1)-(8,1)\n"
      "(0,0) (0,0) -> (3,1)-(4,1) p=0.25\n");
  const auto rule = [&](double u) { return match(rules, {0, 0}, {0, 0}, false, u).rule; };
  EXPECT_EQ(rule(0.001), 0);
  EXPECT_EQ(rule(0.499), 0);
  EXPECT_EQ(rule(0.501), 2);
  EXPECT_EQ(rule(0.749), 2);
  EXPECT_EQ(rule(0.751), -1);
  EXPECT_TRUE(match(rules, {0, 0}, {0, 0}, false, 0.9).applicable);
}

TEST(Match, LeftSidesInEitherOrderShareTheRandomNumber) {
  const Ruleset rules =
      rules_of("(1,1)-(2,1) -> (0,0) (0,0) p=0.25\n(2,1)-(1,1) -> (5,1)-(6,1) p=0.25\n");
  EXPECT_EQ(match(rules, {1, 1}, {2, 1}, true, 0.2).rule, 0);
  const Match second = match(rules, {1, 1}, {2, 1}, true, 0.4);
  EXPECT_EQ(second.rule, 1);
  EXPECT_TRUE(second.swapped);
  EXPECT_EQ(match(rules, {1, 1}, {2, 1}, true, 0.6).rule, -1);
}

TEST(Match, ProbabilityOneAlwaysFiresAndZeroNever) {
  const Ruleset rules = rules_of("(0,0) (0,0) -> (1,1)-(2,1)\n(1,1)-(2,1) -> (0,0) (0,0)\n");
  EXPECT_EQ(match(rules, {0, 0}, {0, 0}, false, 1 - 0x1p-33).rule, 0);
  EXPECT_EQ(match(rules, {1, 1}, {2, 1}, true, 0x1p-33).rule, -1);
}

TEST(RulesetText, ReadsKindsNamesAndDefaults) {
  const Ruleset r = parse_ruleset(
      "# heading\nlilytank ruleset 1  # version\nname pair\nhops counter-clockwise\n"
      "target\n  ##\n  #.\nend\n\n"
      "grow: (0,0) (0,0) -> (1,1)-(2,1)\n"
      "(1,1)-(2,1)->(0,0)(0,0)\n"
      "swap-2: ( 2 , 1 ) - (4,3) -> (5,1)-(6,2) p = 0.25 # update\n",
      "pair.rules");
  EXPECT_EQ(r.name, "pair");
  ASSERT_EQ(r.rules.size(), 3u);
  EXPECT_EQ(r.rules[0].kind, RuleKind::link);
  EXPECT_EQ(r.rules[0].p, 1);
  EXPECT_EQ(r.rules[1].name, "r2");
  EXPECT_EQ(r.rules[1].kind, RuleKind::unlink);
  EXPECT_EQ(r.rules[1].p, 0);
  EXPECT_EQ(r.rules[2].kind, RuleKind::update);
  EXPECT_EQ(r.rules[2].name, "swap-2");
  EXPECT_EQ(r.rules[2].before[1], (Label{4, 3}));
  EXPECT_EQ(r.rules[2].p, 0.25);
  EXPECT_EQ(r.rules[2].where.text(), "pair.rules:12:9");
  EXPECT_EQ(canonical_shape(r.target), canonical_shape({{0, 0}, {0, 1}, {1, 1}}));
}

TEST(RulesetText, TakesWindowsLineEndsAndAByteOrderMark) {
  const Ruleset r = parse_ruleset(
      "\xEF\xBB\xBFlilytank ruleset 1\r\nhops counter-clockwise\r\ntarget\r\n##\r\nend\r\n"
      "(0,0) (0,0) -> (1,1)-(2,1)\r\n",
      "dir/windows.rules");
  EXPECT_EQ(r.rules.size(), 1u);
  EXPECT_EQ(r.target.size(), 2u);
  EXPECT_EQ(r.name, "windows");
}

TEST(RulesetText, PrintedRulesetReadsBackTheSame) {
  std::vector<Ruleset> all = {
      rules_of("b: (2,1)-(4,3) -> (5,1)-(6,2) p=0.1\n(9,4) (0,0) -> (255,1)-(3,1) p=1e-05\n")};
  for (const std::string& name : shipped_rulesets())
    all.push_back(read_ruleset(ruleset_file(name)));
  for (const Ruleset& r : all) {
    const Ruleset again = parse_ruleset(to_text(r), r.file);
    EXPECT_EQ(again.name, r.name);
    ASSERT_EQ(again.rules.size(), r.rules.size());
    for (std::size_t k = 0; k < r.rules.size(); ++k) {
      EXPECT_EQ(again.rules[k].name, r.rules[k].name);
      EXPECT_EQ(again.rules[k].kind, r.rules[k].kind);
      EXPECT_EQ(again.rules[k].before, r.rules[k].before);
      EXPECT_EQ(again.rules[k].after, r.rules[k].after);
      EXPECT_EQ(again.rules[k].p, r.rules[k].p);
    }
    EXPECT_EQ(canonical_shape(again.target), canonical_shape(r.target));
  }
}

TEST(RulesetText, ShippedRulesetsUndoTheirJoins) {
  for (const std::string& name : shipped_rulesets()) {
    const Ruleset r = read_ruleset(ruleset_file(name));
    EXPECT_EQ(r.name, name);
    const std::size_t n = r.rules.size() / 2;
    EXPECT_EQ(r.target.size(), n + 1) << name;
    for (std::size_t k = 0; k < n; ++k) {
      const Rule& forward = r.rules[k];
      const Rule& back = r.rules[n + k];
      EXPECT_EQ(back.name, forward.name + "_reverse");
      EXPECT_EQ(back.before, forward.after);
      for (int side = 0; side < 2; ++side) {
        EXPECT_EQ(back.after[side].state, forward.before[side].state);
        EXPECT_EQ(back.after[side].hop, reverse_hop(forward.before[side].hop));
      }
    }
  }
}

TEST(RulesetText, PaperRulesets) {
  const Ruleset chain = read_ruleset(ruleset_file("chain5"));
  const Ruleset cross = read_ruleset(ruleset_file("cross5"));
  const std::array<Label, 4> chain_left = {Label{0, 0}, {1, 3}, {4, 3}, {6, 3}};
  const std::array<Label, 4> cross_left = {Label{0, 0}, {1, 2}, {3, 3}, {5, 4}};
  const std::array<double, 4> p_e = {0.01, 0.005, 0.000025, 0};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(chain.rules[k].before[0], chain_left[k]);
    EXPECT_EQ(cross.rules[k].before[0], cross_left[k]);
    EXPECT_EQ(chain.rules[4 + k].p, p_e[k]);
    EXPECT_EQ(cross.rules[4 + k].p, p_e[k]);
  }
  EXPECT_EQ(cross.rules[7].after[0], (Label{5, 2}));  // garbled in print
}

TEST(RulesetErrors, Header) {
  const std::string begins = "a ruleset file begins with the line 'lilytank ruleset 1'";
  expect_messages({
      {"", "bad.rules: the file is empty: " + begins},
      {"# only words\n\n", "bad.rules: the file is empty: " + begins},
      {"name x\n", "bad.rules:1:1: found 'name': " + begins},
      {"lilytank ruleset 2\n", "bad.rules:1:18: ruleset version '2' is not known: " + begins},
      {"lilytank ruleset 1 x\n", "bad.rules:1:20: unexpected 'x' after lilytank ruleset 1"},
      {"lilytank ruleset 1\n" + kRule,
       "bad.rules: the line 'hops counter-clockwise' is missing: it says which way hop numbers "
       "count"},
      {kHead, "bad.rules: there is no rule in the file"},
      {kHead + "name a\nname b\n" + kRule, "bad.rules:4:6: 'name' is given twice: first in line 3"},
      {kHead + "name 5x\n" + kRule,
       "bad.rules:3:6: '5x' is not a name: expected a letter, then letters, digits, '_' or '-'"},
      {kHead + "nmae five\n",
       "bad.rules:3:1: 'nmae' is not known here: expected 'name', 'hops', 'target' or a rule - did "
       "you mean 'name'?"},
      {kHead + "hops counter-clockwise\n", "bad.rules:3:6: 'hops' is given twice: first in line 2"},
  });
}

TEST(RulesetErrors, HopConvention) {
  const std::string only =
      ": only 'counter-clockwise' is known, hops that count counter-clockwise seen from above from "
      "the connector engaged last; in rules of the other sense exchange hops 2 and 4";
  expect_messages({
      {"lilytank ruleset 1\nhops clockwise\n", "bad.rules:2:6: hop convention 'clockwise'" + only},
      {"lilytank ruleset 1\nhops counterclockwise\n",
       "bad.rules:2:6: hop convention 'counterclockwise'" + only +
           " - did you mean 'counter-clockwise'?"},
      {"lilytank ruleset 1\nhops\n", "bad.rules:2:5: hop convention the end of the line" + only},
  });
}

TEST(RulesetErrors, Target) {
  expect_messages({
      {kHead + "target\n  ##\n",
       "bad.rules:3:1: the target has no 'end': the file stops in line 4"},
      {kHead + "target\n  ##\n" + kRule,
       "bad.rules:5:1: '(' in a target row: rows are of '#' and '.', and 'end' ends the target "
       "that "
       "starts in line 3"},
      {kHead + "target\n  ..\nend\n" + kRule, "bad.rules:3:1: the target has no '#'"},
      {kHead + "target\n  #.\n  .#\nend\n" + kRule,
       "bad.rules:3:1: the target is in several pieces"},
      {kHead + "target now\n", "bad.rules:3:8: unexpected 'now' after 'target'"},
  });
}

TEST(RulesetErrors, Rules) {
  const auto rule = [](const std::string& line) { return kHead + line + "\n"; };
  expect_messages({
      {rule("(256,1) (0,0) -> (1,1)-(2,1)"),
       "bad.rules:3:2: 256 is out of range: expected a control state, a whole number 0 .. 255"},
      {rule("(-1,1) (0,0) -> (1,1)-(2,1)"),
       "bad.rules:3:2: -1 is out of range: expected a control state, a whole number 0 .. 255"},
      {rule("(1,5) (0,0) -> (1,1)-(2,1)"),
       "bad.rules:3:4: 5 is out of range: expected a hop, a whole number 0 .. 4"},
      {rule("(99999999999,1) (0,0) -> (1,1)-(2,1)"),
       "bad.rules:3:2: '99999999999,1)' is out of range: expected a control state, a whole number "
       "0 "
       ".. 255"},
      {rule("(a,1) (0,0) -> (1,1)-(2,1)"),
       "bad.rules:3:2: expected a control state, a whole number 0 .. 255, found 'a,1)'"},
      {rule("(0,2) (0,0) -> (1,1)-(2,1)"),
       "bad.rules:3:1: (0,2) has a hop but no control state: an isolated module is (0,0)"},
      {rule("(3,0) (0,0) -> (1,1)-(2,1)"),
       "bad.rules:3:1: (3,0) has no hop: only the isolated module (0,0) has hop 0, others 1 .. 4"},
      {rule("(0,0) -> (1,1)-(2,1)"),
       "bad.rules:3:7: expected '(' to begin a label (control state, hop) such as (3,1), found "
       "'->'"},
      {rule("(0,0) (0,0) > (1,1)-(2,1)"),
       "bad.rules:3:13: expected '->' between the two sides of a rule, found '>'"},
      {rule("(0,0) (0,0) -> (1;1)-(2,1)"),
       "bad.rules:3:18: expected ',' between control state and hop, found ';1)-(2,1)'"},
      {rule("(0,0) (0,0) -> (1,1-(2,1)"),
       "bad.rules:3:20: expected ')' to end the label, found '-(2,1)'"},
      {rule("(0,0) (0,0) -> (1,1) (2,1)"),
       "bad.rules:3:1: no side of the rule is a bond: write '-' between the labels of modules that "
       "hold each other"},
      {rule("(0,0)-(2,1) -> (1,1) (0,0)"),
       "bad.rules:3:1: (0,0)-(2,1) is not a bond: a module that is held has a control state, and "
       "(0,0) has none"},
      {rule("(1,1) (2,1) -> (1,1)-(0,0)"),
       "bad.rules:3:16: (1,1)-(0,0) is not a bond: a module that is held has a control state, and "
       "(0,0) has none"},
      {rule("1x: (0,0) (0,0) -> (1,1)-(2,1)"),
       "bad.rules:3:1: '1x' is not a rule name: expected a letter, then letters, digits, '_' or "
       "'-'"},
      {rule("r.1: (0,0) (0,0) -> (1,1)-(2,1)"),
       "bad.rules:3:1: 'r.1' is not a rule name: expected a letter, then letters, digits, '_' or "
       "'-'"},
      {kHead + "a: " + kRule + "a: (1,1)-(2,1) -> (0,0) (0,0)\n",
       "bad.rules:4:1: two rules are named 'a': the first is in line 3"},
      {kHead + "r2: " + kRule + "(1,1)-(2,1) -> (0,0) (0,0)\n",
       "bad.rules:4:1: two rules are named 'r2': the first is in line 3"},
  });
}

TEST(RulesetErrors, Probabilities) {
  const auto with = [](const std::string& p) {
    return kHead + "(0,0) (0,0) -> (1,1)-(2,1) " + p + "\n";
  };
  expect_messages({
      {with("p=1.5"), "bad.rules:3:30: '1.5' is not a probability: expected 0 .. 1"},
      {with("p=-0.1"), "bad.rules:3:30: '-0.1' is not a probability: expected 0 .. 1"},
      {with("p=nan"), "bad.rules:3:30: 'nan' is not a probability: expected 0 .. 1"},
      {with("p=often"), "bad.rules:3:30: expected a probability 0 .. 1, found 'often'"},
      {with("p=0,5"), "bad.rules:3:30: expected a probability 0 .. 1, found '0,5'"},
      {with("p="), "bad.rules:3:30: expected a probability 0 .. 1, found the end of the line"},
      {with("p 0.5"), "bad.rules:3:30: expected '=' after 'p', found '0.5'"},
      {with("q=0.5"),
       "bad.rules:3:28: unexpected 'q=0.5' after the rule: expected 'p=' and a probability, or "
       "nothing"},
      {with("p=0.5 p=1"), "bad.rules:3:34: unexpected 'p=1' after the probability"},
      {with("p=0.75") + "(0,0) (0,0) -> (3,1)-(4,1) p=0.5\n",
       "bad.rules:4:1: rule 'r2': the rules with left side (0,0) (0,0) share one random number, "
       "and "
       "their p add up to 1.25, more than 1"},
      {kHead + "(1,1)-(2,1) -> (0,0) (0,0) p=0.5\n(2,1)-(1,1) -> (3,1)-(4,1) p=0.75\n",
       "bad.rules:4:1: rule 'r2': the rules with left side (2,1)-(1,1) share one random number, "
       "and "
       "their p add up to 1.25, more than 1"},
  });
}

TEST(RulesetErrors, TenTimesATenthIsOne) {
  std::string text = kHead;
  for (int k = 1; k <= 10; ++k)
    text += "(0,0) (0,0) -> (" + std::to_string(2 * k) + ",1)-(1,1) p=0.1\n";
  EXPECT_EQ(message(text), "no error");
}

TEST(RulesetErrors, MissingFile) {
  try {
    read_ruleset("no/such.rules");
    FAIL() << "read a file that is not there";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "no/such.rules: the ruleset cannot be read: no such file, or no permission");
  }
}

TEST(RulesetErrors, ChangedProbabilitiesAreCheckedAgain) {
  Ruleset rules = rules_of(kRule);
  rules.rules[0].p = 2;
  EXPECT_THROW(check_probabilities(rules), InputError);
}

}  // namespace
