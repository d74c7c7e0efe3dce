#include "recording/report.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "text/number.hpp"

namespace lilytank {

Treatment Report::add(Check check, SourcePlace place, std::int64_t frame, std::int64_t id,
                      std::string what) {
  const Treatment treatment = rules_[check];
  add(check, treatment, std::move(place), frame, id, std::move(what));
  return treatment;
}

void Report::add(Check check, Treatment treatment, SourcePlace place, std::int64_t frame,
                 std::int64_t id, std::string what) {
  refused_ = refused_ || treatment == Treatment::refuse;
  findings_.push_back({check, treatment, std::move(place), frame, id, std::move(what)});
}

std::vector<Finding> Report::take() {
  std::stable_sort(findings_.begin(), findings_.end(), [](const Finding& a, const Finding& b) {
    return std::pair(a.frame, a.id) < std::pair(b.frame, b.id);
  });
  return std::move(findings_);
}

std::string brief(double value) {
  return significant(value, 3);
}

std::string length_text(double metres) {
  return std::fabs(metres) < 1 ? brief(1000 * metres) + " mm" : brief(metres) + " m";
}

std::string time_text(double seconds) {
  return std::fabs(seconds) < 1 ? brief(1000 * seconds) + " ms" : brief(seconds) + " s";
}

CheckRules::CheckRules() {
  using enum Treatment;
  treatments.fill(split);
  for (const Check check : {Check::gap, Check::spike, Check::outside, Check::repeat}) {
    (*this)[check] = mark;
  }
  (*this)[Check::columns] = keep;
  for (const Check check : {Check::duplicate, Check::clock, Check::units}) {
    (*this)[check] = refuse;
  }
}

std::string Finding::text() const {
  static constexpr const char* done[] = {"kept", "marked", "track cut", "refused"};
  std::string out = place.text() + ": ";
  if (frame >= 0) out += "frame " + std::to_string(frame) + ", ";
  if (id >= 0) out += "id " + (name.empty() ? std::to_string(id) : name) + ", ";
  return out + check_word(check) + ": " + what + " (" + done[static_cast<std::size_t>(treatment)] +
         ")";
}

std::vector<std::string> finding_texts(const std::vector<Finding>& findings, int most) {
  std::map<std::pair<std::string, Check>, int> count;
  std::vector<std::string> out;
  for (const Finding& f : findings) {
    if (++count[{f.place.file, f.check}] <= most) out.push_back(f.text());
  }
  for (const auto& [of, n] : count) {
    if (n <= most) continue;
    out.push_back(of.first + ": " + check_word(of.second) + ": " + std::to_string(n - most) +
                  " more findings");
  }
  return out;
}

}  // namespace lilytank
