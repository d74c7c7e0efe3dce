#include "axes.hpp"
#include "text/number.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace lilytank {
namespace {

constexpr double kHuge = 1e300;  // beyond, a range's length would overflow

// The round step, 1, 2 or 5 times a power of ten, that is nearest above `rough`.
double round_step(double rough) {
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double k : {1.0, 2.0, 5.0}) {
    if (k * decade >= rough * (1 - 1e-9)) return k * decade;
  }
  return 10 * decade;
}

// Minor ticks between two major ones: fifths of 1 and 5, quarters of 2.
int minor_parts(double step) {
  const double decade = std::pow(10.0, std::floor(std::log10(step) + 1e-9));
  return std::lround(step / decade) == 2 ? 4 : 5;
}

int exponent_of(double value) {
  return static_cast<int>(std::floor(std::log10(value) + 1e-12));
}

// What is taken off labels: first an offset, then a power of ten.
struct Shortening {
  double offset = 0;
  int exponent = 0;
  std::string note() const {
    std::string s;
    if (exponent != 0) s = "×" + power_of_ten(exponent);
    if (offset == 0) return s;
    std::string amount = significant(std::fabs(offset), 12);
    if (const auto e = amount.find('e'); e != std::string::npos) {
      amount = amount.substr(0, e) + "×" + power_of_ten(std::atoi(amount.c_str() + e + 1));
    }
    return s + (s.empty() ? "" : "  ") + (offset < 0 ? "−" : "+") + amount;
  }
};

Shortening shorten(double low, double high) {
  Shortening s;
  double size = std::max(std::fabs(low), std::fabs(high));
  const double span = high - low;
  if (span < 2e-4 * size) {
    // The digits that all labels share, rounded to ten times the span.
    const double unit = std::pow(10.0, exponent_of(span) + 1);
    s.offset = std::floor(low / unit) * unit;
    size = std::max(std::fabs(low - s.offset), std::fabs(high - s.offset));
  }
  if (size >= 1e5 || size < 2e-3) s.exponent = exponent_of(size);
  return s;
}

void linear_ticks(Axis& axis, int wanted, bool whole) {
  double step = round_step((axis.high - axis.low) / wanted);
  // Few whole numbers are all labelled: 0 1 2 3 rather than 0 2.
  if (whole) step = axis.high - axis.low < wanted + 2.5 ? 1 : std::max(step, 1.0);
  // One label is no scale.
  const auto labelled = [&] {
    return std::floor(axis.high / step) - std::ceil(axis.low / step) + 1;
  };
  while (!whole && labelled() < 2) step = round_step(0.39 * step);
  const Shortening cut = shorten(axis.low, axis.high);
  const double factor = std::pow(10.0, -cut.exponent);
  const int decimals = std::clamp(-exponent_of(step * factor), 0, 15);
  // Steps of one whole number have nothing between them.
  const int parts = whole && step < 1.5 ? 1 : minor_parts(step);
  const double fine = step / parts;
  const double first = std::ceil(axis.low / fine - 1e-6),
               last = std::floor(axis.high / fine + 1e-6);
  for (double k = first; k <= last; ++k) {
    const bool major = std::fabs(std::remainder(k, parts)) < 0.5;
    const double value = k * fine;
    axis.ticks.push_back(
        {value, major ? number((value - cut.offset) * factor, decimals) : "", major});
  }
  axis.note = cut.note();
}

void log_ticks(Axis& axis, int wanted) {
  const double first = std::log10(axis.low), last = std::log10(axis.high);
  const int from = static_cast<int>(std::ceil(first - 1e-9)) - 1;
  const int to = static_cast<int>(std::floor(last + 1e-9)) + 1;
  int every = std::max(1, static_cast<int>(std::ceil((last - first) / wanted)));
  // One label is no scale.
  const auto labelled = [&] { return std::floor(last / every) - std::ceil(first / every) + 1; };
  while (every > 1 && labelled() < 2) --every;
  const bool short_numbers = first >= -3.001 && last <= 4.001;
  const bool between = last - first < 2.0;  // few decades: label 2 and 5 as well
  for (int e = from; e <= to; ++e) {
    const double decade = std::pow(10.0, e);
    for (int k = 1; k <= 9; ++k) {
      const double value = k * decade, at = std::log10(value);
      if (at < first - 1e-9 || at > last + 1e-9) continue;
      // Many decades leave no room for what lies between the labels.
      if (every > 1 && k > 1) continue;
      if (every > 10 && e % every != 0) continue;
      const bool major =
          k == 1 ? ((e % every) + every) % every == 0 : between && (k == 2 || k == 5);
      std::string label;
      if (major) {
        label = short_numbers ? significant(value, 6)
                              : (k > 1 ? std::to_string(k) + "·" : "") + power_of_ten(e);
      }
      axis.ticks.push_back({value, label, major});
    }
  }
}

// Moves the ends of a linear range apart until there is something to show.
void repair_linear(double& low, double& high) {
  low = std::clamp(low, -kHuge, kHuge);
  high = std::clamp(high, -kHuge, kHuge);
  if (low > high) std::swap(low, high);
  const double size = std::max(std::fabs(low), std::fabs(high));
  if (high - low > 1e-12 * size && high - low > 1e-290) return;
  const double pad = size > 1e-290 ? 0.1 * size : 1;
  low -= pad, high += pad;
}

void repair_log(double& low, double& high) {
  constexpr double kLeast = 1e-300;
  if (low > high) std::swap(low, high);
  if (!(high > 0)) low = 0.1, high = 10;
  high = std::clamp(high, kLeast * 10, kHuge);
  low = low > 0 ? std::clamp(low, kLeast, high) : high / 1000;
  if (high / low < 1.0001) low /= 2, high *= 2;
}

}  // namespace

void Range::add(double value, bool log) {
  if (!std::isfinite(value) || (log && value <= 0)) return;
  low_ = std::min(low_, value);
  high_ = std::max(high_, value);
  whole_ = whole_ && value == std::floor(value);
}

double Axis::share(double value) const {
  if (!log) return (value - low) / (high - low);
  if (!(value > 0)) return std::numeric_limits<double>::quiet_NaN();
  // Differences of logarithms: the ratio itself may overflow.
  return (std::log(value) - std::log(low)) / (std::log(high) - std::log(low));
}

std::string number(double value, int decimals) {
  char text[400];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  std::string s = text;
  if (s.find_first_not_of("-0.") == std::string::npos && s[0] == '-') s.erase(0, 1);  // no -0
  if (s[0] == '-') s.replace(0, 1, "−");
  return s;
}

std::string power_of_ten(int exponent) {
  return with_superscripts("10^" + std::to_string(exponent));
}

std::string with_superscripts(const std::string& text) {
  static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string s;
  bool raised = false;
  for (const char c : text) {
    raised = c == '^' || (raised && (c == '-' || (c >= '0' && c <= '9')));
    if (!raised)
      s += c;
    else if (c != '^')
      s += c == '-' ? "⁻" : kDigits[c - '0'];
  }
  return s;
}

Axis make_axis(double low, double high, bool log, int wanted, bool whole) {
  wanted = std::max(2, wanted);
  if (!std::isfinite(low) || !std::isfinite(high)) low = log ? 0.1 : 0, high = log ? 10 : 1;
  if (log)
    repair_log(low, high);
  else
    repair_linear(low, high);
  Axis axis{low, high, log, {}, {}};
  // 1, 2 and 5 times powers of ten give two labels or more only from a ratio of 5 on; shorter log
  // axes get evenly spaced numbers.
  if (log && high / low > 5)
    log_ticks(axis, wanted);
  else
    linear_ticks(axis, wanted, whole && high - low >= 1);
  return axis;
}

}  // namespace lilytank
