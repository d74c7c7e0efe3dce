// A calibration, readable.
#include <algorithm>
#include <cmath>

#include "analysis/text_table.hpp"
#include "lilytank/calibration.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kWorst = 5;  // numbers that are named where the model does not fit

std::string digits(double value) {
  return std::isnan(value) ? "-" : significant(value, 4);
}

std::string head(const CalibrationResult& c) {
  std::string out =
      "calibration of " + c.name + ": " + std::to_string(c.recordings) +
      (c.recordings == 1 ? " recording" : " recordings") + " of up to " + std::to_string(c.bodies) +
      (c.body == BodyKind::lily ? " Lilies, " : " balls, ") + digits(c.seconds) + " s in all\n";
  out += "objective " + c.objective + ", flow " + c.flow + ", step " + digits(1000 * c.dt) +
         " ms; " + std::to_string(c.rounds) + " local models, " + std::to_string(c.simulations) +
         " simulated experiments\n";
  return out;
}

std::string parameters(const CalibrationResult& c) {
  TextTable table({"parameter", "unit", "before", "search", "estimate", "95 % from", "to"});
  for (const CalibratedParameter& p : c.parameters) {
    table.add({p.parameter.path, p.parameter.unit == "1" ? "" : p.parameter.unit, digits(p.start),
               p.parameter.nuisance ? "-" : digits(p.searched), digits(p.estimate), digits(p.low),
               digits(p.high)});
  }
  return "\n" + table.text();
}

std::string fits(const CalibrationResult& c) {
  if (c.msd.empty()) return "";
  TextTable table({"Eq. 9 (m^2)", "pieces", "before", "after", "noise floor", "after / floor",
                   "two simulations", "p"});
  for (const MsdFit& m : c.msd) {
    table.add({m.recordings, std::to_string(m.pieces) + " of " + digits(m.seconds) + " s",
               digits(m.before), digits(m.after), digits(m.floor), fixed(m.after / m.floor, 2),
               digits(m.equals), p_text(m.equals_p)});
  }
  return "\n" + table.text();
}

std::string explained(const CalibrationResult& c) {
  std::string out = "\nmisfit " + digits(c.misfit) + ", a larger one has probability " +
                    p_text(c.misfit_p) + " if the model is true\n";
  std::vector<const ComparedNumber*> worst;
  for (const ComparedNumber& n : c.numbers) worst.push_back(&n);
  std::stable_sort(worst.begin(), worst.end(), [](const auto* a, const auto* b) {
    return std::fabs(a->z()) > std::fabs(b->z());
  });
  if (c.misfit_p >= 0.05 || worst.empty()) return out;
  out += "farthest from what is expected:";
  for (std::size_t i = 0; i < std::min(kWorst, worst.size()); ++i) {
    out += (i == 0 ? " " : "; ") + worst[i]->entry.group + ", " + worst[i]->entry.name + " (" +
           fixed(worst[i]->z(), 1) + " deviations)";
  }
  return out + "\n";
}

}  // namespace

std::string calibration_text(const CalibrationResult& c) {
  std::string out = head(c) + parameters(c) + fits(c) + explained(c);
  for (const std::string& w : c.warnings) out += "warning: " + w + "\n";
  return out;
}

}  // namespace lilytank
