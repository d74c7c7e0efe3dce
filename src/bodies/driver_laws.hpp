// Laws of forces by what was recorded beside the bodies: of all drivers together, and of one alone.
#pragma once
#include <string>
#include <utility>

#include "bodies/driver_history.hpp"
#include "bodies/law_forces.hpp"

namespace lilytank::bodies {

using Parameters = std::vector<LawParameter>;

inline constexpr std::string_view kMoreDrivers = "a recording in which the drivers change more";

// Of all drivers together, each with a coefficient an axis.
inline Parameters of_drivers(const Typical& t) {
  Parameters out;
  for (int i = 0; i < t.drivers; ++i) {
    const bool known = i == t.latitude;
    for (int d = 0; d < t.dimensions; ++d) {
      out.push_back({"a" + std::to_string(i + 1) + (d == 0 ? "x" : "y"), "N",
                     known ? Kind::fixed : Kind::amplitude, known ? 0.0 : NAN});
    }
  }
  return out;
}

inline void by_drivers(const Scene& s, Values p, double* force) {
  for (int i = 0; i < s.bodies * s.dimensions; ++i) {
    for (std::size_t k = static_cast<std::size_t>(i % s.dimensions), j = 0; k < p.size();
         k += static_cast<std::size_t>(s.dimensions), ++j) {
      force[i] += p[k] * s.drivers[j];
    }
  }
}

inline bool has_drivers(const Typical& t) {
  return t.drivers > (t.latitude >= 0 ? 1 : 0);
}

inline constexpr Law kDriverForce{.name = "driver_force",
                                  .equation = "F = sum of a_i driver_i",
                                  .variable = "driver",
                                  .split = kMoreDrivers,
                                  .special = {"driver_1", "driver_2", "driver_3", "driver_4"},
                                  .parameters = of_drivers,
                                  .add = by_drivers,
                                  .possible = has_drivers};

/// How a force depends on one driver.
struct Driven {
  std::string_view equation;
  /// Parameters beside the coefficients.
  Parameters (*own)(double period) = [](double) { return Parameters{}; };
  /// What the coefficients multiply, by these parameters.
  double (*value)(const Scene& s, int driver, Values own);
  /// The driver must oscillate.
  bool periodic = false;
};

/// Whether a driver is none of the latitude, the current or the wind.
inline bool has_driver(const Typical& t, int number) {
  for (const int other : {t.latitude, t.current[0], t.current[1], t.wind[0], t.wind[1]}) {
    if (other == number) return false;
  }
  return t.drivers > number;
}

inline constexpr Driven kProportional{
    .equation = "F = a driver",
    .value = [](const Scene& s, int driver, Values) { return s.drivers[driver]; }};

inline constexpr Driven kSquared{.equation = "F = a driver^2",
                                 .value = [](const Scene& s, int driver, Values) {
                                   return s.drivers[driver] * s.drivers[driver];
                                 }};

inline constexpr Driven kLagged{
    .equation = "F(t) = a driver(t - lag)",
    .own = [](double period) -> Parameters {
      return {{"lag", "s", Kind::positive, period / 8, period * 3 / 8}};
    },
    .value = [](const Scene& s, int driver,
                Values own) { return driver_at(*s.run, driver, s.time - own[0]); },
    .periodic = true};

inline constexpr Driven kEnvelope{
    .equation = "F = a times the amplitude of the driver over the last two periods",
    .own = [](double period) -> Parameters {
      return {{"window", "s", Kind::fixed, 2 * period}};
    },
    .value = [](const Scene& s, int driver,
                Values own) { return amplitude_at(*s.run, driver, s.time, own[0]); },
    .periodic = true};

/// The numbers: a coefficient an axis, those of `how`, the driver.
template <const Driven& how, int number>
Parameters of_driver(const Typical& t) {
  Parameters out{{"ax", "N"}};
  if (t.dimensions == 2) out.push_back({"ay", "N"});
  for (LawParameter& p : how.own(t.period[number])) out.push_back(std::move(p));
  out.push_back({"driver", "1", Kind::driver, number});
  return out;
}

template <const Driven& how>
void by_driver(const Scene& s, Values p, double* force) {
  const auto axes = static_cast<std::size_t>(s.dimensions);
  const double by = how.value(s, static_cast<int>(p.back()), p.subspan(axes, p.size() - axes - 1));
  for (int i = 0; i < s.bodies * s.dimensions; ++i) {
    force[i] += p[static_cast<std::size_t>(i % s.dimensions)] * by;
  }
}

template <const Driven& how, int number>
bool is_driven(const Typical& t) {
  // Of a single driver, proportionality is the driver force.
  const bool other = &how != &kProportional || t.drivers > (t.latitude >= 0 ? 2 : 1);
  return other && has_driver(t, number) && (!how.periodic || t.period[number] > 0);
}

/// A law of the driver `number`; `plain` is the proportional law, where that is a special case.
template <const Driven& how, int number>
constexpr Law driver_law(std::string_view name, std::string_view plain = "") {
  Law law{.name = name,
          .equation = how.equation,
          .variable = "driver",
          .split = kMoreDrivers,
          .parameters = of_driver<how, number>,
          .add = by_driver<how>,
          .possible = is_driven<how, number>};
  if (!plain.empty()) law.special = {plain, kDriverForce.name};
  return law;
}

}  // namespace lilytank::bodies
