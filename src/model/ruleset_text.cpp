// The text format of rulesets: reading, checking, writing.
#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "model/ruleset_scanner.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr std::string_view kHeader = "lilytank ruleset 1";

std::string text_of(const std::array<Label, 2>& side, bool held) {
  return text_of(side[0]) + (held ? "-" : " ") + text_of(side[1]);
}
bool held_before(const Rule& rule) {
  return rule.kind != RuleKind::link;
}

// Reads a ruleset line by line.
class Parser {
 public:
  Parser(const std::string& text, const std::string& file) : lines_(text) { out_.file = file; }

  Ruleset run() {
    header();
    while (next_line()) line();
    finish();
    return out_;
  }

 private:
  bool next_line() {
    if (!std::getline(lines_, raw_)) return false;
    ++number_;
    if (!raw_.empty() && raw_.back() == '\r') raw_.pop_back();
    if (number_ == 1 && raw_.starts_with("\xEF\xBB\xBF")) raw_.erase(0, 3);
    content_ = raw_.substr(0, raw_.find('#'));
    return true;
  }

  void header() {
    const std::string expected =
        "a ruleset file begins with the line '" + std::string(kHeader) + "'";
    while (next_line()) {
      RulesetScanner in = scanner();
      if (in.at_end()) continue;
      if (!in.take("lilytank") || !in.take("ruleset"))
        in.fail("found " + in.next_text() + ": " + expected);
      if (in.next_text() != "'1'")
        in.fail("ruleset version " + in.next_text() + " is not known: " + expected);
      in.take("1");
      in.expect_end(kHeader);
      return;
    }
    throw InputError({out_.file, 0, 0}, "the file is empty: " + expected);
  }

  void line() {
    RulesetScanner in = scanner();
    if (in.at_end()) return;
    const SourcePlace place = in.place();
    const std::string found = in.next_text();
    if (in.next_text()[1] == '(') return rule(in, "", place);
    const std::string word(in.word());
    if (in.take(":")) return rule(in, word, place);
    if (word == "name") return name(in);
    if (word == "hops") return hops(in);
    if (word == "target") return target(in);
    const std::string known[] = {"name", "hops", "target"};
    throw InputError(place, found +
                                " is not known here: expected 'name', 'hops', 'target' or a rule" +
                                did_you_mean(word, known));
  }

  void name(RulesetScanner& in) {
    seen_once("name", in);
    const SourcePlace place = in.place();
    out_.name = std::string(in.word());
    if (!is_name(out_.name))
      throw InputError(place, "'" + out_.name + "' is not a name: " + kNameForm);
    in.expect_end("the name");
  }

  void hops(RulesetScanner& in) {
    seen_once("hops", in);
    const SourcePlace place = in.place();
    const std::string found = in.next_text();
    const std::string value(in.word());
    if (value != "counter-clockwise") {
      const std::string known[] = {"counter-clockwise"};
      throw InputError(place, "hop convention " + found +
                                  ": only 'counter-clockwise' is known, hops that count "
                                  "counter-clockwise seen from above from the connector engaged "
                                  "last; in rules of the other sense exchange hops 2 and 4" +
                                  did_you_mean(value, known));
    }
    in.expect_end("'counter-clockwise'");
  }

  void target(RulesetScanner& in) {
    seen_once("target", in);
    in.expect_end("'target'");
    const SourcePlace begin = here();
    for (int y = 0; next_line();) {
      const std::size_t first = raw_.find_first_not_of(" \t");
      if (first == std::string::npos) continue;
      const std::string row = raw_.substr(first, raw_.find_last_not_of(" \t") - first + 1);
      if (row == "end") return finish_target(begin);
      target_row(row, y++, begin.line);
    }
    throw InputError(begin,
                     "the target has no 'end': the file stops in line " + std::to_string(number_));
  }

  void target_row(std::string_view row, int y, int first_line) {
    for (std::size_t x = 0; x < row.size(); ++x) {
      if (row[x] == '#') out_.target.push_back({static_cast<int>(x), -y});
      if (row[x] == '#' || row[x] == '.') continue;
      const int column = static_cast<int>(raw_.find_first_not_of(" \t") + x) + 1;
      throw InputError({out_.file, number_, column},
                       "'" + std::string(1, row[x]) +
                           "' in a target row: rows are of '#' and '.', and 'end' ends "
                           "the target that starts in line " +
                           std::to_string(first_line));
    }
  }

  void finish_target(const SourcePlace& begin) {
    if (out_.target.empty()) throw InputError(begin, "the target has no '#'");
    // Spread from one cell; what is not reached hangs together with nothing.
    std::set<Cell> left(out_.target.begin(), out_.target.end());
    std::vector<Cell> edge = {*left.begin()};
    left.erase(left.begin());
    while (!edge.empty()) {
      const Cell at = edge.back();
      edge.pop_back();
      for (const Cell& next :
           {Cell{at.x + 1, at.y}, Cell{at.x, at.y + 1}, Cell{at.x - 1, at.y}, Cell{at.x, at.y - 1}})
        if (left.erase(next) > 0) edge.push_back(next);
    }
    if (!left.empty()) throw InputError(begin, "the target is in several pieces");
    Cell low = out_.target.front();
    for (const Cell& cell : out_.target) low = {std::min(low.x, cell.x), std::min(low.y, cell.y)};
    for (Cell& cell : out_.target) cell = {cell.x - low.x, cell.y - low.y};
  }

  void rule(RulesetScanner& in, const std::string& name, const SourcePlace& place) {
    Rule rule;
    rule.name = rule_name(name, place);
    rule.where = in.place();
    const bool before = side(in, rule.before);
    in.expect("->", "between the two sides of a rule");
    const bool after = side(in, rule.after);
    if (!before && !after)
      throw InputError(rule.where,
                       "no side of the rule is a bond: write '-' between the labels of "
                       "modules that hold each other");
    rule.kind = !before ? RuleKind::link : after ? RuleKind::update : RuleKind::unlink;
    rule.p = rule.kind == RuleKind::unlink ? 0 : 1;
    if (!in.at_end()) {
      if (!in.take("p"))
        in.fail("unexpected " + in.next_text() +
                " after the rule: expected 'p=' and a probability, or nothing");
      in.expect("=", "after 'p'");
      rule.p = in.probability();
      in.expect_end("the probability");
    }
    out_.rules.push_back(rule);
  }

  std::string rule_name(std::string name, const SourcePlace& place) {
    if (name.empty()) name = "r" + std::to_string(out_.rules.size() + 1);
    if (!is_name(name)) throw InputError(place, "'" + name + "' is not a rule name: " + kNameForm);
    const auto [old, fresh] = seen_.try_emplace(":" + name, number_);
    if (!fresh)
      throw InputError(place, "two rules are named '" + name + "': the first is in line " +
                                  std::to_string(old->second));
    return name;
  }

  // Two labels; true if a dash holds them together.
  bool side(RulesetScanner& in, std::array<Label, 2>& labels) {
    const SourcePlace place = in.place();
    labels[0] = in.label();
    const bool held = !in.ahead("->") && in.take("-");
    labels[1] = in.label();
    if (held && (labels[0] == Label{} || labels[1] == Label{}))
      throw InputError(place, text_of(labels, true) +
                                  " is not a bond: a module that is held has a "
                                  "control state, and (0,0) has none");
    return held;
  }

  void finish() {
    const SourcePlace file{out_.file, 0, 0};
    if (!seen_.count("hops"))
      throw InputError(
          file,
          "the line 'hops counter-clockwise' is missing: it says which way hop numbers count");
    if (out_.rules.empty()) throw InputError(file, "there is no rule in the file");
    if (out_.name.empty()) {
      const std::size_t slash = out_.file.find_last_of("/\\");
      const std::string base = slash == std::string::npos ? out_.file : out_.file.substr(slash + 1);
      out_.name = base.substr(0, base.find('.'));
      if (!is_name(out_.name)) out_.name = "ruleset";
    }
    check_probabilities(out_);
  }

  void seen_once(const std::string& what, RulesetScanner& in) {
    const auto [old, fresh] = seen_.try_emplace(what, number_);
    if (!fresh)
      in.fail("'" + what + "' is given twice: first in line " + std::to_string(old->second));
  }

  RulesetScanner scanner() const { return {content_, out_.file, number_}; }
  SourcePlace here() const { return {out_.file, number_, 1}; }

  std::istringstream lines_;
  std::string raw_;      // the line as it stands, without its end
  std::string content_;  // without its comment
  int number_ = 0;
  std::map<std::string, int> seen_;  // line of each header word and rule name
  Ruleset out_;
};

}  // namespace

void check_probabilities(const Ruleset& rules) {
  for (std::size_t k = 0; k < rules.rules.size(); ++k) {
    const Rule& rule = rules.rules[k];
    if (!(rule.p >= 0 && rule.p <= 1))
      throw InputError(rule.where, "rule '" + rule.name + "': p = " + shortest(rule.p) +
                                       " is not a probability: expected 0 .. 1");
    double sum = 0;
    for (std::size_t m = 0; m <= k; ++m) {
      const Rule& other = rules.rules[m];
      const bool same = held_before(other) == held_before(rule) &&
                        (other.before == rule.before ||
                         (other.before[0] == rule.before[1] && other.before[1] == rule.before[0]));
      if (same) sum += other.p;
    }
    // Room for the rounding of sums such as ten times 0.1.
    if (sum > 1 + 1e-12)
      throw InputError(rule.where, "rule '" + rule.name + "': the rules with left side " +
                                       text_of(rule.before, held_before(rule)) +
                                       " share one random number, and their p add up to " +
                                       shortest(sum) + ", more than 1");
  }
}

Ruleset parse_ruleset(const std::string& text, const std::string& file) {
  return Parser(text, file).run();
}

Ruleset read_ruleset(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (in) text << in.rdbuf();
  if (!in)
    throw InputError({file, 0, 0}, "the ruleset cannot be read: no such file, or no permission");
  return parse_ruleset(text.str(), file);
}

std::string rule_text(const Rule& rule) {
  return text_of(rule.before, held_before(rule)) + " -> " +
         text_of(rule.after, rule.kind != RuleKind::unlink);
}

std::string to_text(const Ruleset& rules) {
  std::string out = std::string(kHeader) + "\nname " + rules.name + "\nhops counter-clockwise\n";
  if (!rules.target.empty()) {
    Cell low = rules.target.front(), high = low;
    for (const Cell& cell : rules.target) {
      low = {std::min(low.x, cell.x), std::min(low.y, cell.y)};
      high = {std::max(high.x, cell.x), std::max(high.y, cell.y)};
    }
    std::vector<std::string> rows(high.y - low.y + 1, std::string(high.x - low.x + 1, '.'));
    for (const Cell& cell : rules.target) rows[high.y - cell.y][cell.x - low.x] = '#';
    out += "target\n";
    for (const std::string& row : rows) out += "  " + row + "\n";
    out += "end\n";
  }
  std::size_t width = 0;
  for (const Rule& rule : rules.rules) width = std::max(width, rule.name.size());
  for (const Rule& rule : rules.rules) {
    out += rule.name + ":" + std::string(width - rule.name.size() + 1, ' ');
    out += rule_text(rule) + "  p=" + shortest(rule.p) + "\n";
  }
  return out;
}

}  // namespace lilytank
