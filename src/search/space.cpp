#include "search/space.hpp"

#include <algorithm>
#include <cmath>

#include "lilytank/math.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr std::int64_t kMostAxes = 1000;

bool is_word(const std::string& name) {
  const std::string_view allowed = "_.-";
  return !name.empty() && std::all_of(name.begin(), name.end(), [&](char c) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    return letter || allowed.find(c) != std::string_view::npos;
  });
}

double log_range(const SearchAxis& axis) {
  return log_portable(axis.high) - log_portable(axis.low);
}

void check_axis(const SearchAxis& axis) {
  if (!is_word(axis.name)) {
    throw InputError("'" + axis.name + "' is no name of a searched parameter");
  }
  const std::string of = "the bounds of " + axis.name;
  if (!std::isfinite(axis.low) || !std::isfinite(axis.high) || !(axis.low < axis.high)) {
    throw InputError(of + " must be finite and in order, not " + shortest(axis.low) + " and " +
                     shortest(axis.high));
  }
  if (axis.logarithmic && !(axis.low > 0)) {
    throw InputError(of + " must be above 0 on a log scale, not " + shortest(axis.low));
  }
}

}  // namespace

void check_space(const SearchSpace& space) {
  if (space.empty()) throw InputError("nothing to search: no parameter is free");
  if (static_cast<std::int64_t>(space.size()) > kMostAxes) {
    throw InputError("more than " + std::to_string(kMostAxes) + " searched parameters");
  }
  for (std::size_t a = 0; a < space.size(); ++a) {
    check_axis(space[a]);
    for (std::size_t b = 0; b < a; ++b) {
      if (space[a].name == space[b].name) {
        throw InputError("the parameter " + space[a].name + " is searched twice");
      }
    }
  }
}

void check_point(const SearchSpace& space, const std::vector<double>& point,
                 const std::string& what) {
  if (point.size() != space.size()) {
    throw InputError(what + " has " + std::to_string(point.size()) + " values for " +
                     std::to_string(space.size()) + " parameters");
  }
  for (std::size_t a = 0; a < space.size(); ++a) {
    if (point[a] >= space[a].low && point[a] <= space[a].high) continue;
    throw InputError(what + " has " + space[a].name + " = " + shortest(point[a]) + ", outside " +
                     shortest(space[a].low) + " .. " + shortest(space[a].high));
  }
}

std::vector<double> from_unit(const SearchSpace& space, const std::vector<double>& u) {
  std::vector<double> point(u.size());
  for (std::size_t a = 0; a < u.size(); ++a) {
    const SearchAxis& axis = space[a];
    const double value = axis.logarithmic ? axis.low * exp_portable(u[a] * log_range(axis))
                                          : axis.low + u[a] * (axis.high - axis.low);
    point[a] = u[a] == 1 ? axis.high : std::clamp(value, axis.low, axis.high);
  }
  return point;
}

std::vector<double> to_unit(const SearchSpace& space, const std::vector<double>& point) {
  std::vector<double> u(point.size());
  for (std::size_t a = 0; a < point.size(); ++a) {
    const SearchAxis& axis = space[a];
    const double share = axis.logarithmic
                             ? (log_portable(point[a]) - log_portable(axis.low)) / log_range(axis)
                             : (point[a] - axis.low) / (axis.high - axis.low);
    u[a] = std::clamp(share, 0.0, 1.0);
  }
  return u;
}

void save_space(StateWriter& out, const SearchSpace& space) {
  out.whole("axes", static_cast<std::int64_t>(space.size()));
  for (const SearchAxis& axis : space) {
    out.word("axis", axis.name);
    out.word("scale", axis.logarithmic ? "log" : "linear");
    const double bounds[] = {axis.low, axis.high};
    out.numbers("bounds", bounds);
  }
}

SearchSpace load_space(StateReader& in) {
  SearchSpace space(static_cast<std::size_t>(in.whole("axes", 1, kMostAxes)));
  for (SearchAxis& axis : space) {
    axis.name = in.word("axis");
    axis.logarithmic = in.word("scale") == "log";
    const auto bounds = in.numbers("bounds", 2);
    axis.low = bounds[0], axis.high = bounds[1];
  }
  check_space(space);
  return space;
}

}  // namespace lilytank
