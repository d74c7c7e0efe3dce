#include "model/ruleset_scanner.hpp"

#include <algorithm>
#include <charconv>

namespace lilytank {
namespace {

bool blank(char c) {
  return c == ' ' || c == '\t';
}

// Where a word ends, so that "r1:" and "p=0.1" and "(1,2)" fall into their parts.
bool ends_word(char c) {
  return blank(c) || std::string_view(":=(),-<>").find(c) != std::string_view::npos;
}

bool letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool name_letter(char c) {
  return letter(c) || (c >= '0' && c <= '9') || c == '-';
}

}  // namespace

bool is_name(std::string_view text) {
  return !text.empty() && letter(text[0]) && std::all_of(text.begin(), text.end(), name_letter);
}

std::string text_of(const Label& label) {
  return "(" + std::to_string(label.state) + "," + std::to_string(label.hop) + ")";
}

bool RulesetScanner::at_end() {
  while (at_ < line_.size() && blank(line_[at_])) ++at_;
  return at_ == line_.size();
}

SourcePlace RulesetScanner::place() {
  at_end();
  SourcePlace place = place_;
  place.column = static_cast<int>(at_) + 1;
  return place;
}

void RulesetScanner::fail(const std::string& message) {
  throw InputError(place(), message);
}

std::string RulesetScanner::next_text() {
  if (at_end()) return "the end of the line";
  std::size_t end = at_;
  while (end < line_.size() && !blank(line_[end])) ++end;
  return "'" + std::string(line_.substr(at_, end - at_)) + "'";
}

bool RulesetScanner::ahead(std::string_view text) {
  at_end();
  return line_.substr(at_, text.size()) == text;
}

bool RulesetScanner::take(std::string_view text) {
  if (!ahead(text)) return false;
  at_ += text.size();
  return true;
}

void RulesetScanner::expect(std::string_view text, std::string_view why) {
  if (take(text)) return;
  fail("expected '" + std::string(text) + "' " + std::string(why) + ", found " + next_text());
}

std::string_view RulesetScanner::word() {
  at_end();
  std::size_t end = at_;
  while (end < line_.size() && !ends_word(line_[end])) ++end;
  // Names may hold dashes inside; "->" ends one.
  while (end > at_ && end + 1 < line_.size() && line_[end] == '-' && !ends_word(line_[end + 1])) {
    ++end;
    while (end < line_.size() && !ends_word(line_[end])) ++end;
  }
  const std::string_view found = line_.substr(at_, end - at_);
  at_ = end;
  return found;
}

int RulesetScanner::whole_number(std::string_view what, int high) {
  at_end();
  const char* begin = line_.data() + at_;
  const char* end = line_.data() + line_.size();
  int value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  const std::string range =
      "a " + std::string(what) + ", a whole number 0 .. " + std::to_string(high);
  if (error == std::errc::result_out_of_range)
    fail(next_text() + " is out of range: expected " + range);
  if (error != std::errc()) fail("expected " + range + ", found " + next_text());
  if (value < 0 || value > high)
    fail(std::to_string(value) + " is out of range: expected " + range);
  at_ += static_cast<std::size_t>(stop - begin);
  return value;
}

Label RulesetScanner::label() {
  const SourcePlace start = place();
  expect("(", "to begin a label (control state, hop) such as (3,1)");
  Label label;
  label.state = whole_number("control state", 255);
  expect(",", "between control state and hop");
  label.hop = whole_number("hop", 4);
  expect(")", "to end the label");
  const std::string text = text_of(label);
  if (label.state == 0 && label.hop != 0)
    throw InputError(start, text + " has a hop but no control state: an isolated module is (0,0)");
  if (label.state != 0 && label.hop == 0)
    throw InputError(start,
                     text + " has no hop: only the isolated module (0,0) has hop 0, others 1 .. 4");
  return label;
}

double RulesetScanner::probability() {
  at_end();
  const std::string found = next_text();
  const char* begin = line_.data() + at_;
  double value = 0;
  const auto [stop, error] = std::from_chars(begin, line_.data() + line_.size(), value);
  const bool whole = stop == line_.data() + line_.size() || blank(*stop);
  if (error != std::errc() || !whole) fail("expected a probability 0 .. 1, found " + found);
  if (!(value >= 0 && value <= 1)) fail(found + " is not a probability: expected 0 .. 1");
  at_ += static_cast<std::size_t>(stop - begin);
  return value;
}

void RulesetScanner::expect_end(std::string_view after) {
  if (!at_end()) fail("unexpected " + next_text() + " after " + std::string(after));
}

}  // namespace lilytank
