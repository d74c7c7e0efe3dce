#include "bodies/law.hpp"

namespace lilytank::bodies {

std::vector<std::vector<double>> Law::starts(const Typical& t) const {
  std::vector<std::vector<double>> out(1);
  for (const LawParameter& p : parameters(t)) {
    for (std::size_t k = 0, sets = out.size(); k < sets; ++k) {
      if (!std::isnan(p.other)) out.push_back(out[k]), out.back().push_back(p.other);
      out[k].push_back(p.start);
    }
  }
  return out;
}

const Law* find_law(std::string_view name) {
  for (const Law& law : law_library()) {
    if (law.name == name) return &law;
  }
  return nullptr;
}

VariableRange range_of(std::string_view variable, const Typical& t) {
  if (variable == "slip" || variable == "medium slip" || variable == "turn") return {0, t.fastest};
  if (variable == "pair") return {t.nearest, t.middle};
  if (variable == "time") return {0, t.duration};
  return {t.low, t.high};
}

std::string unit_of(std::string_view variable, const std::string& unit) {
  if (variable == "time") return "s";
  return variable == "slip" || variable == "medium slip" || variable == "turn" ? unit + "/s" : unit;
}

// The parameters after the coefficient are the wind fraction and the numbers of the drivers.
double velocity_of_medium(const Scene& s, std::span<const double> p, int axis) {
  const auto number = [&](int kind) {
    return static_cast<int>(p[static_cast<std::size_t>(2 + 2 * kind + axis)]);
  };
  const int current = number(0), wind = number(1);
  return (current < 0 ? 0 : s.drivers[current]) + (wind < 0 ? 0 : p[1] * s.drivers[wind]);
}

double inertial_turning(double latitude) {
  constexpr double kEarth = 7.292115e-5;  // rad/s, a turn in a sidereal day
  return 2 * kEarth * std::sin(latitude * std::numbers::pi / 180);
}

}  // namespace lilytank::bodies
