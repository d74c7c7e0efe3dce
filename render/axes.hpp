// Axes of plots: ranges, round tick values and their labels.
#pragma once
#include <string>
#include <vector>

namespace lilytank {

/// A mark on an axis; minor ticks have no label.
struct AxisTick {
  double value = 0;
  std::string label;
  bool major = true;
};

/// The range of finite numbers seen so far.
class Range {
 public:
  /// Takes in a value; ignores those that are not finite and, for log axes, those <= 0.
  void add(double value, bool log);
  bool empty() const { return !(low_ <= high_); }
  double low() const { return low_; }
  double high() const { return high_; }
  /// Whether every value was a whole number.
  bool whole() const { return whole_; }

 private:
  double low_ = 1e300, high_ = -1e300;
  bool whole_ = true;
};

/// An axis from `low` to `high` with ticks at round values.
struct Axis {
  double low = 0, high = 1;
  bool log = false;
  std::vector<AxisTick> ticks;  ///< rising
  /// What labels leave out: "×10⁻³" or "+1.25×10⁴" or both; empty where they are complete.
  std::string note;

  /// Place of a value, 0 at `low` and 1 at `high`; NaN for values that a log axis cannot show.
  double share(double value) const;
};

/// An axis over [low, high] with about `wanted` labelled ticks (at least 2). `whole`: no
/// ticks between whole numbers. Ranges that are empty, reversed, not finite, or (log) not positive
/// are put right, so that every call gives a usable axis.
Axis make_axis(double low, double high, bool log, int wanted, bool whole);

/// A number as a label with a true minus sign, `decimals` digits after the point.
std::string number(double value, int decimals);
/// "10⁻³".
std::string power_of_ten(int exponent);
/// "m/s²" of "m/s^2".
std::string with_superscripts(const std::string& text);

}  // namespace lilytank
