// Laws of forces by what was recorded beside the bodies: of all drivers together, and of one alone.
#pragma once
#include <string>

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
                                  .parameters = of_drivers,
                                  .add = by_drivers,
                                  .possible = has_drivers};

/// Of the driver `number`, a coefficient an axis.
template <int number>
Parameters of_driver(const Typical& t) {
  Parameters out{{"ax", "N"}};
  if (t.dimensions == 2) out.push_back({"ay", "N"});
  out.push_back({"driver", "1", Kind::driver, number});
  return out;
}

/// Adds `size(driver)` times each axis' coefficient.
template <auto size>
void by_driver(const Scene& s, Values p, double* force) {
  const double by = size(s.drivers[static_cast<int>(p.back())]);
  for (int i = 0; i < s.bodies * s.dimensions; ++i) {
    force[i] += p[static_cast<std::size_t>(i % s.dimensions)] * by;
  }
}

/// Whether there is such a driver, and it is none of the latitude, the current or the wind.
template <int number>
bool has_driver(const Typical& t) {
  for (const int other : {t.latitude, t.current[0], t.current[1], t.wind[0], t.wind[1]}) {
    if (other == number) return false;
  }
  return t.drivers > number;
}

/// The force by a driver's value, or by its square.
template <int number, bool squared>
constexpr Law driver_law(std::string_view name) {
  return {.name = name,
          .equation = squared ? "F = a driver^2" : "F = a driver",
          .variable = "driver",
          .split = kMoreDrivers,
          .parameters = of_driver<number>,
          .add = by_driver<[](double d) { return squared ? d * d : d; }>,
          // Of a single driver the first is the driver force.
          .possible = [](const Typical& t) {
            return has_driver<number>(t) && (squared || t.drivers > (t.latitude >= 0 ? 2 : 1));
          }};
}

}  // namespace lilytank::bodies
