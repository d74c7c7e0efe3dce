// Tables and numbers for readers.
#pragma once
#include <string>
#include <vector>

#include "lilytank/statistics.hpp"

namespace lilytank {

/// Rows of cells as aligned lines of text; the first row is the head.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> head) : rows_{std::move(head)} {}
  /// As many cells as the head has.
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  bool empty() const { return rows_.size() < 2; }
  /// Columns two blanks apart, indented by two; those of numbers only are aligned to the right.
  std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// "12.50"; "-" for NaN, "inf" beyond bounds.
std::string fixed(double value, int decimals);
/// "2.13 [1.80, 2.47]", with two digits of the interval's half width, but `most_decimals` at most;
/// no interval where it is unbounded on both sides. All numbers are divided by `unit`.
std::string with_interval(const Estimate& estimate, double unit = 1, int most_decimals = 9);
/// Two digits: "0.031", "4.2e-05"; "-" for NaN.
std::string p_text(double p);

/// A unit of time that suits a length in seconds.
struct TimeScale {
  double seconds = 1;
  std::string name = "s";
};
TimeScale time_scale(double length);

}  // namespace lilytank
