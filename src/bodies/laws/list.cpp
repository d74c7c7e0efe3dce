#include "bodies/laws/list.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace lilytank::bodies {

std::span<const Law* const> law_library() {
  static const std::array<const Law*, 20> laws{
      &gravity(),        &pendulum(),          &constant_force(),   &linear_drag(),
      &quadratic_drag(), &dry_friction(),      &linear_spring(),    &cubic_spring(),
      &pair_power_law(), &pair_dipoles(),      &pair_exponential(), &pair_spring(),
      &coriolis(),       &rotation(),          &tide_turning(),     &driver_force(),
      &curve_of_slip(),  &curve_of_position(), &curve_of_gap(),     &curve_of_time()};
  return laws;
}

const Law* find_law(std::string_view name) {
  for (const Law* law : law_library()) {
    if (law->name() == name) return law;
  }
  return nullptr;
}

double inertial_turning(double latitude) {
  constexpr double kEarth = 7.292115e-5;  // rad/s, a turn in a sidereal day
  return 2 * kEarth * std::sin(latitude * std::numbers::pi / 180);
}

}  // namespace lilytank::bodies
