#include "study/axes.hpp"

#include <cmath>
#include <numeric>

#include "lilytank/math.hpp"
#include "lilytank/random.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

/// 15 digits, so that 0.1 + 0.2 becomes 0.3: people read these.
double neat(double value) {
  return parse_number(without_rounding(value)).value_or(value);
}

/// The value a share of the way. The library's own functions: every machine of a study must find
/// the same values.
double at_share(const AxisRange& range, double share) {
  const double value = range.log ? range.from * pow_portable(range.to / range.from, share)
                                 : range.from + (range.to - range.from) * share;
  return range.whole ? std::floor(value + 0.5) : neat(value);
}

}  // namespace

std::vector<double> range_values(const AxisRange& range) {
  std::vector<double> values;
  for (int i = 0; i < range.count; ++i) {
    values.push_back(at_share(range, static_cast<double>(i) / (range.count - 1)));
  }
  if (!range.whole) values.front() = range.from, values.back() = range.to;
  return values;
}

std::vector<double> latin_values(const AxisRange& range, int samples, std::uint64_t seed,
                                 int axis) {
  std::vector<int> parts(static_cast<std::size_t>(samples));
  std::iota(parts.begin(), parts.end(), 0);
  const auto draw = [&](std::size_t i, std::uint32_t use) {
    return uniform({seed, Stream::latin, axis, static_cast<std::uint32_t>(i), use});
  };
  for (std::size_t i = parts.size(); i > 1; --i) {  // every order alike [Fisher and Yates]
    const auto other = static_cast<std::size_t>(draw(i, 0) * static_cast<double>(i));
    std::swap(parts[i - 1], parts[other]);
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    values.push_back(at_share(range, (parts[i] + draw(i, 1)) / samples));
  }
  return values;
}

}  // namespace lilytank
