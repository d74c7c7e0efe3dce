#include "io/units.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "text/number.hpp"

namespace lilytank {
namespace {

struct NamedUnit {
  std::string_view name;
  Unit unit;
  bool prefixes;
};

constexpr double kDegree = 0.017453292519943295;  // rad

// Tried in this order, whole words first: "min" is a minute, "d" a day, "Pa" no prefix at all.
constexpr NamedUnit kUnits[] = {
    {"1", {{}, 0, 1}, false},
    {"%", {{}, -2, 1}, false},
    {"m", {{1, 0, 0, 0}, 0, 1}, true},
    {"g", {{0, 1, 0, 0}, -3, 1}, true},
    {"s", {{0, 0, 1, 0}, 0, 1}, true},
    {"rad", {{0, 0, 0, 1}, 0, 1}, true},
    {"min", {{0, 0, 1, 0}, 0, 60}, false},
    {"h", {{0, 0, 1, 0}, 0, 3600}, false},
    {"d", {{0, 0, 1, 0}, 0, 86400}, false},
    {"deg", {{0, 0, 0, 1}, 0, kDegree}, false},
    {"N", {{1, 1, -2, 0}, 0, 1}, true},
    {"Hz", {{0, 0, -1, 0}, 0, 1}, true},
    {"l", {{3, 0, 0, 0}, -3, 1}, true},
    {"Pa", {{-1, 1, -2, 0}, 0, 1}, true},
    {"J", {{2, 1, -2, 0}, 0, 1}, true},
    {"W", {{2, 1, -3, 0}, 0, 1}, true},
};

/// Letters that keyboards and word processors put in units, as they are read here: both micro
/// signs, blanks that do not break, dots of products, degrees, minus signs, powers.
constexpr std::pair<std::string_view, std::string_view> kLetters[] = {
    {"\u00b5", "u"}, {"\u03bc", "u"},   {"\u00a0", " "}, {"\u202f", " "},
    {"\u2009", " "}, {"\u2007", " "},   {"\u2002", " "}, {"\u2003", " "},
    {"\u200a", " "}, {"\u3000", " "},   {"\u00b7", " "}, {"\u22c5", " "},
    {"\u2212", "-"}, {"\u00b0", "deg"}, {"\u2215", "/"}, {"\u2044", "/"}};
constexpr std::pair<std::string_view, char> kSuperscripts[] = {
    {"\u207b", '-'}, {"\u2070", '0'}, {"\u00b9", '1'}, {"\u00b2", '2'},
    {"\u00b3", '3'}, {"\u2074", '4'}, {"\u2075", '5'}, {"\u2076", '6'},
    {"\u2077", '7'}, {"\u2078", '8'}, {"\u2079", '9'}};

/// The text in ASCII: "3 um" of "3\u00a0\u03bcm", "m/s^2" of "m/s\u00b2". Other letters stay.
std::string in_ascii(std::string_view text) {
  std::string out;
  bool raised = false;  // within a power
  while (!text.empty()) {
    const auto begins = [&](const auto& letter) { return text.starts_with(letter.first); };
    const auto power = std::find_if(std::begin(kSuperscripts), std::end(kSuperscripts), begins);
    const auto letter = std::find_if(std::begin(kLetters), std::end(kLetters), begins);
    std::size_t length = 1;
    if (power != std::end(kSuperscripts)) {
      out += raised ? "" : "^";
      out += power->second, length = power->first.size();
    } else if (letter != std::end(kLetters)) {
      out += letter->second, length = letter->first.size();
    } else {
      out += text.front();
    }
    raised = power != std::end(kSuperscripts);
    text.remove_prefix(length);
  }
  return out;
}

/// With their powers of ten.
constexpr std::pair<std::string_view, int> kPrefixes[] = {
    {"n", -9}, {"u", -6}, {"m", -3}, {"c", -2}, {"d", -1}, {"k", 3}, {"M", 6}};

std::optional<Unit> named_unit(std::string_view word) {
  for (const NamedUnit& known : kUnits) {
    if (word == known.name) return known.unit;
  }
  for (const NamedUnit& known : kUnits) {
    if (!known.prefixes || !word.ends_with(known.name)) continue;
    for (const auto& [prefix, ten] : kPrefixes) {
      if (word.substr(0, word.size() - known.name.size()) != prefix) continue;
      Unit unit = known.unit;
      unit.ten += ten;
      return unit;
    }
  }
  return std::nullopt;
}

/// out * unit^n.
Unit times(Unit out, const Unit& unit, int n) {
  for (std::size_t i = 0; i < out.powers.size(); ++i) out.powers[i] += n * unit.powers[i];
  out.ten += n * unit.ten;
  double scale = 1;
  for (int i = 0; i < std::abs(n); ++i) scale *= unit.scale;
  out.scale *= n < 0 ? 1 / scale : scale;
  return out;
}

/// Reads factors joined by blanks, '*' and '/', each a word or a group, with '^' and a power.
class UnitReader {
 public:
  explicit UnitReader(std::string_view text) : text_(text) {}

  std::optional<Unit> whole() {
    const auto unit = factors(0);
    return at_ == text_.size() ? unit : std::nullopt;
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }

  std::optional<Unit> factors(int depth) {
    Unit out;
    int sign = 1;
    for (bool first = true;; first = false) {
      skip_blanks();
      if (at_ == text_.size() || text_[at_] == ')')
        return first ? std::nullopt : std::optional(out);
      if (!first && (text_[at_] == '*' || text_[at_] == '/')) {
        sign = text_[at_++] == '/' ? -1 : 1;
        skip_blanks();
      }
      const auto next = factor(depth);
      if (!next) return std::nullopt;
      out = times(out, *next, sign);
      sign = 1;
    }
  }

  std::optional<Unit> factor(int depth) {
    std::optional<Unit> unit;
    if (at_ < text_.size() && text_[at_] == '(') {
      if (depth > 3) return std::nullopt;
      ++at_;
      unit = factors(depth + 1);
      if (!unit || at_ == text_.size() || text_[at_++] != ')') return std::nullopt;
    } else {
      const std::size_t end = std::min(text_.find_first_of(" */^()", at_), text_.size());
      unit = named_unit(text_.substr(at_, end - at_));
      at_ = end;
    }
    if (!unit || at_ == text_.size() || text_[at_] != '^') return unit;
    int n = 0;
    const char* begin = text_.data() + at_ + 1;
    const auto [end, problem] = std::from_chars(begin, text_.data() + text_.size(), n);
    if (problem != std::errc() || std::abs(n) > 9) return std::nullopt;
    at_ = static_cast<std::size_t>(end - text_.data());
    return times({}, *unit, n);
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

/// The decimal number `digits` times 10^shift, rounded once.
std::optional<double> shifted(std::string_view digits, int shift) {
  const auto e = digits.find_first_of("eE");
  int exponent = shift;
  if (e != std::string_view::npos) {
    const auto written = parse_whole(digits.substr(e + 1));
    if (!written || std::abs(*written) > 9999) return std::nullopt;
    exponent += static_cast<int>(*written);
  }
  return parse_number(std::string(digits.substr(0, e)) + "e" + std::to_string(exponent));
}

/// What is measured in a unit.
constexpr std::pair<std::string_view, std::string_view> kDimensions[] = {
    {"m", "a length"},
    {"kg", "a mass"},
    {"s", "a time"},
    {"rad", "an angle"},
    {"N", "a force"},
    {"m/s", "a speed"},
    {"1/s", "a rate"},
    {"rad/s", "a spin"},
    {"m^2", "an area"},
    {"N m", "a torque"},
    {"N/m", "a stiffness"},
    {"kg/m^3", "a density"},
    {"m/s^2", "an acceleration"},
    {"m^3", "a volume"},
    {"kg m^2", "a moment of inertia"},
};

std::string_view dimension_name(std::string_view unit) {
  const auto wanted = parse_unit(unit);
  for (const auto& [known, name] : kDimensions) {
    if (wanted && wanted->same_dimension(*parse_unit(known))) return name;
  }
  return "a value";
}

}  // namespace

std::optional<Unit> parse_unit(std::string_view text) {
  return UnitReader(in_ascii(text)).whole();
}

std::vector<std::string> units_like(std::string_view unit) {
  std::vector<std::string> out;
  const auto like = parse_unit(unit);
  for (const NamedUnit& known : kUnits) {
    if (!like || !known.unit.same_dimension(*like)) continue;
    out.emplace_back(known.name);
    if (!known.prefixes) continue;
    for (const auto& [prefix, ten] : kPrefixes) out.push_back(std::string(prefix) += known.name);
  }
  return out;
}

std::string described(std::string_view unit) {
  if (unit == "1" || unit.empty()) return "a number without a unit";
  if (unit == "%") return "a fraction in %";
  return std::string(dimension_name(unit)) + " in " + std::string(unit);
}

double read_quantity(std::string_view text, std::string_view unit, std::string_view path,
                     const SourcePlace& place) {
  const std::string quoted = "\"" + std::string(text) + "\"", name(path);
  const std::string plain_text = in_ascii(text);
  std::string_view rest = trimmed(plain_text);
  if (rest.size() > 1 && rest[0] == '+' && rest[1] != '-') rest.remove_prefix(1);
  double plain = 0;
  const auto [end, problem] = std::from_chars(rest.data(), rest.data() + rest.size(), plain);
  const std::string_view digits = rest.substr(0, static_cast<std::size_t>(end - rest.data()));
  const bool number = problem == std::errc() && std::isfinite(plain);
  if (!number) {
    throw InputError(
        place, name + " = " + quoted + " is not a number; " + name + " is " + described(unit));
  }
  const std::string_view given = trimmed(rest.substr(digits.size()));
  if (given.starts_with(',')) {
    std::string pointed(rest);
    pointed[digits.size()] = '.';
    throw InputError(place, name + " = " + quoted +
                                " has a comma in its number, which is not read: "
                                "write \"" +
                                pointed + "\" if it is a decimal comma");
  }
  if (given.empty()) {
    // As TOML takes it: not ".3" or "3.".
    throw InputError(place, name + " = " + quoted + " has no unit - write " + shortest(plain) +
                                " without quotes for SI units, or name the unit");
  }
  const auto wanted = parse_unit(unit), found = parse_unit(given);
  if (given == unit) return *parse_number(digits);
  if (!found) {
    throw InputError(place, "'" + std::string(given) + "' is not a unit known here; " + name +
                                " is " + described(unit));
  }
  if (!wanted || !found->same_dimension(*wanted)) {
    throw InputError(place,
                     name + " is " + described(unit) + "; '" + std::string(given) + "' is not");
  }
  const auto value = shifted(digits, found->ten - wanted->ten);
  const double scaled = value ? *value * (found->scale / wanted->scale) : HUGE_VAL;
  if (!std::isfinite(scaled)) throw InputError(place, name + " = " + quoted + " is too large");
  return scaled;
}

std::string unit_hint(double value, std::string_view unit, double low, double high) {
  constexpr std::string_view kCommon[] = {"mm",   "cm",   "g",    "ms",   "min",
                                          "h",    "mN",   "deg",  "%",    "mm^2",
                                          "cm^2", "mm/s", "cm/s", "mN m", "deg/s"};
  const auto wanted = parse_unit(unit);
  if (!wanted) return {};
  for (const std::string_view name : kCommon) {
    const auto common = parse_unit(name);
    if (name == unit || !common || !common->same_dimension(*wanted)) continue;
    const std::string written = shortest(value) + " " + std::string(name);
    const double meant = read_quantity(written, unit, "", {});
    if (meant < low || meant > high || meant == value) continue;
    return " - if this is in " + std::string(name) + ", write \"" + written + "\"";
  }
  return {};
}

}  // namespace lilytank
