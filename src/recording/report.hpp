// What the checks of one recording find.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "lilytank/recording_io.hpp"

namespace lilytank {

class Report {
 public:
  explicit Report(const CheckRules& rules) : rules_(rules) {}
  const CheckRules& rules() const { return rules_; }

  /// Notes a finding; returns what is to be done about it.
  Treatment add(Check check, SourcePlace place, std::int64_t frame, std::int64_t id,
                std::string what);
  /// The same with another treatment than the rules' one.
  void add(Check check, Treatment treatment, SourcePlace place, std::int64_t frame, std::int64_t id,
           std::string what);
  bool refused() const { return refused_; }
  /// Findings in the order of files and lines.
  std::vector<Finding> take();

 private:
  CheckRules rules_;
  std::vector<Finding> findings_;
  bool refused_ = false;
};

/// "0.0123" with three significant digits.
std::string brief(double value);
/// "12.3 mm" or "1.23 m"; "33.3 ms" or "2.5 s".
std::string length_text(double metres);
std::string time_text(double seconds);

}  // namespace lilytank
