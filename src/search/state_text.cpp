#include "search/state_text.hpp"

#include <charconv>
#include <limits>

#include "text/fnv.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr std::string_view kMagic = "lilytank search 1 ";
constexpr std::string_view kHash = "hash ";

std::string hash_of(std::string_view text) {
  Fnv hash;
  hash.add(text);
  char buffer[17];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, hash.value(), 16).ptr;
  return {buffer, end};
}

}  // namespace

StateWriter::StateWriter(std::string_view kind) {
  text_.append(kMagic).append(kind).append("\n");
}

void StateWriter::word(std::string_view key, std::string_view value) {
  text_.append(key).append(" ").append(value).append("\n");
}

void StateWriter::whole(std::string_view key, std::int64_t value) {
  wholes(key, {&value, 1});
}

void StateWriter::number(std::string_view key, double value) {
  numbers(key, {&value, 1});
}

void StateWriter::wholes(std::string_view key, std::span<const std::int64_t> values) {
  text_.append(key);
  for (const std::int64_t value : values) text_.append(" ").append(std::to_string(value));
  text_.append("\n");
}

void StateWriter::numbers(std::string_view key, std::span<const double> values) {
  text_.append(key);
  for (const double value : values) text_.append(" ").append(shortest(value));
  text_.append("\n");
}

std::string StateWriter::finish() {
  const std::string hash = hash_of(text_);
  return std::move(text_.append(kHash).append(hash).append("\n"));
}

StateReader::StateReader(std::string_view text, std::string file) : file_(std::move(file)) {
  const SourcePlace place{file_, 1, 1};
  if (!text.starts_with(kMagic)) {
    throw InputError(place, "not the state of a search of this version ('" + std::string(kMagic) +
                                "...' was expected)");
  }
  const auto end = text.rfind(kHash);
  const bool whole = end != std::string_view::npos && text[end - 1] == '\n' &&
                     text.substr(end) == std::string(kHash) + hash_of(text.substr(0, end)) + "\n";
  if (!whole) throw InputError(place, "the state of the search is cut or was changed");
  rest_ = text.substr(0, end);
  kind_ = next_line().substr(kMagic.size());
}

std::string_view StateReader::next_line() {
  ++line_;
  const auto end = rest_.find('\n');
  if (end == std::string_view::npos) refuse("the state of the search ends too early");
  const std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(end + 1);
  return line;
}

std::vector<std::string_view> StateReader::values(std::string_view key) {
  std::string_view line = next_line();
  if (!line.starts_with(key) || (line.size() > key.size() && line[key.size()] != ' ')) {
    refuse("'" + std::string(key) + "' was expected, not '" + std::string(line.substr(0, 40)) +
           "'");
  }
  line.remove_prefix(key.size());
  std::vector<std::string_view> out;
  while (!line.empty()) {
    line.remove_prefix(1);
    const auto end = std::min(line.find(' '), line.size());
    out.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return out;
}

std::string StateReader::word(std::string_view key) {
  const auto found = values(key);
  if (found.size() != 1) refuse("one word was expected");
  return std::string(found[0]);
}

std::int64_t StateReader::whole(std::string_view key, std::int64_t low, std::int64_t high) {
  const auto found = wholes(key);
  if (found.size() != 1 || found[0] < low || found[0] > high) {
    refuse("one whole number from " + std::to_string(low) + " to " + std::to_string(high) +
           " was expected");
  }
  return found[0];
}

double StateReader::number(std::string_view key) {
  return numbers(key, 1)[0];
}

std::vector<std::int64_t> StateReader::wholes(std::string_view key) {
  std::vector<std::int64_t> out;
  for (const std::string_view value : values(key)) {
    const auto parsed = parse_whole(value);
    if (!parsed) refuse("'" + std::string(value) + "' is not a whole number");
    out.push_back(*parsed);
  }
  return out;
}

std::vector<double> StateReader::numbers(std::string_view key) {
  std::vector<double> out;
  for (const std::string_view value : values(key)) {
    double parsed = 0;  // infinities and NaN are values of a search, too
    const auto [end, problem] = std::from_chars(value.data(), value.data() + value.size(), parsed);
    if (problem != std::errc() || end != value.data() + value.size()) {
      refuse("'" + std::string(value) + "' is not a number");
    }
    out.push_back(parsed);
  }
  return out;
}

std::vector<double> StateReader::numbers(std::string_view key, std::size_t count) {
  std::vector<double> out = numbers(key);
  if (out.size() != count) refuse(std::to_string(count) + " numbers were expected");
  return out;
}

void StateReader::end() {
  if (!rest_.empty()) refuse("the state of the search goes on after its end");
}

void StateReader::refuse(const std::string& message) const {
  throw InputError(SourcePlace{file_, line_, 1}, message);
}

}  // namespace lilytank
