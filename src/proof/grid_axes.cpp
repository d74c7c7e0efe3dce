// Cells of a grid, and its axes as a user writes them.
#include <algorithm>
#include <cmath>

#include "io/units.hpp"
#include "lilytank/proof_grid.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

const std::vector<std::string> kAxes{"balls", "lilies", "modules", "budget"};

struct Axis {
  std::vector<double>* values;
  double low, high;
  bool seconds = false, whole = false;
};

Axis axis_named(GridAxes& axes, const std::string& name) {
  if (name == "balls") return {&axes.balls, 6, 36000, true};
  if (name == "lilies") return {&axes.lilies, 12, 36000, true};
  if (name == "modules") return {&axes.modules, 2, 100, false, true};
  if (name == "budget") return {&axes.budget, 1, 1e4};
  throw InputError("'" + name + "' is none of " + joined(kAxes, ", ") + did_you_mean(name, kAxes));
}

double value_on(const Axis& axis, const std::string& word, const std::string& name) {
  auto value = parse_number(word);
  if (value && axis.seconds) *value *= 60;
  if (!value && !axis.whole) {
    value = read_quantity(word, axis.seconds ? "s" : "min", name, SourcePlace{name, 0, 0});
  }
  if (!value || (axis.whole && *value != std::floor(*value))) {
    throw InputError(name + ": '" + word + "' is not a whole number");
  }
  if (*value >= axis.low && *value <= axis.high) return *value;
  const std::string unit = axis.seconds ? " s" : axis.whole ? "" : " min";
  throw InputError(name + ": " + word + " is outside " + shortest(axis.low) + " .. " +
                   shortest(axis.high) + unit);
}

// "4min", "20s".
std::string length_name(double seconds) {
  const bool minutes = std::fmod(seconds, 60) == 0;
  return shortest(minutes ? seconds / 60 : seconds) + (minutes ? "min" : "s");
}

}  // namespace

std::string GridCell::name() const {
  return (balls > 0 ? "balls-" + length_name(balls) : "known-flow") + "_lilies-" +
         length_name(lilies) + "_modules-" + std::to_string(modules) + "_budget-" +
         shortest(budget);
}

std::vector<GridCell> GridAxes::cells(bool known_flow) const {
  const std::vector<double> none{0};
  std::vector<GridCell> out;
  for (const double b : budget) {
    for (const double m : modules) {
      for (const double l : lilies) {
        for (const double f : known_flow ? none : balls) {
          out.push_back({f, l, static_cast<int>(m), b});
        }
      }
    }
  }
  return out;
}

void set_axis(GridAxes& axes, const std::string& text) {
  const std::size_t sign = text.find('=');
  const std::string name = text.substr(0, sign);
  const Axis axis = axis_named(axes, name);
  if (sign == std::string::npos)
    throw InputError("'" + text + "' has no values: write " + name + "=");
  std::vector<double> values;
  for (std::size_t at = sign; at != std::string::npos;) {
    const std::size_t end = text.find(',', at + 1);
    const std::string word = text.substr(at + 1, end == std::string::npos ? end : end - at - 1);
    values.push_back(value_on(axis, word, name));
    if (std::ranges::count(values, values.back()) > 1) {
      throw InputError(name + ": " + word + " is there twice");
    }
    at = end;
  }
  *axis.values = std::move(values);
}

}  // namespace lilytank
