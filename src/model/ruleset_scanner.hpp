// Reads one line of a ruleset file word by word and reports what is wrong with it, and where.
#pragma once
#include <string>
#include <string_view>

#include "lilytank/ruleset.hpp"

namespace lilytank {

/// Whether a text is a name of a ruleset, rule or target, and how it is described in messages.
bool is_name(std::string_view text);
inline const std::string kNameForm = "expected a letter, then letters, digits, '_' or '-'";
/// "(3,1)".
std::string text_of(const Label& label);
/// A rule's two sides, "(1,3) (0,0) -> (3,1)-(4,1)".
std::string rule_text(const Rule& rule);

/// A line with a reading position. All errors carry file, line and column.
class RulesetScanner {
 public:
  /// `line` is without its end of line and comment; `number` counts from 1.
  RulesetScanner(std::string_view line, std::string file, int number)
      : line_(line), place_{std::move(file), number, 0} {}

  /// Skips blanks; true at the end of the line.
  bool at_end();
  /// Skips blanks; takes `text` if it is next.
  bool take(std::string_view text);
  /// Skips blanks; true if `text` is next.
  bool ahead(std::string_view text);
  /// Takes `text` or throws: "expected `text` <why>".
  void expect(std::string_view text, std::string_view why);
  /// Takes the next word, up to a blank or one of :=(),<> or a dash at its end; may be empty.
  std::string_view word();
  /// A control state and hop, "(3,1)". Throws where it is not one, out of range, or half isolated.
  Label label();
  /// A probability in [0,1].
  double probability();
  /// Throws unless the line ends here.
  void expect_end(std::string_view after);

  /// The place of the next non-blank character.
  SourcePlace place();
  /// What is next, for messages: a word in quotes, or "the end of the line".
  std::string next_text();
  [[noreturn]] void fail(const std::string& message);

 private:
  int whole_number(std::string_view what, int high);
  std::string_view line_;
  SourcePlace place_;
  std::size_t at_ = 0;
};

}  // namespace lilytank
