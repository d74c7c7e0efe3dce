// Quantities with units: "30 cm", "12.68 mN", "25 ms", "15 deg", "69 %".
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lilytank/error.hpp"

namespace lilytank {

/// A unit of measurement: powers of metre, kilogram, second and radian, and its size in SI units,
/// scale * 10^ten. Powers of ten are kept apart so that "7 cm" is the double nearest to 0.07.
struct Unit {
  std::array<int, 4> powers{};  ///< of m, kg, s, rad
  int ten = 0;
  double scale = 1;
  bool same_dimension(const Unit& other) const { return powers == other.powers; }
};

/// Reads a product of units such as "N m", "kg/m^3", "kg/(m s)", "1/s", "%", "1"; nothing if a part
/// of it is unknown. Prefixes n, u, m, c, d, k, M go with m, g, s, N, Hz, rad, l, Pa, J, W. Letters
/// as people type them are read as well: both micro signs, blanks that do not break, raised
/// powers, a degree sign, the dot of a product.
std::optional<Unit> parse_unit(std::string_view text);

/// The names with the dimension of a unit, prefixes included: "m", "mm", "cm" of "m"; none of a
/// product such as "kg/m^3".
std::vector<std::string> units_like(std::string_view unit);

/// What is measured in a unit: "a length in m", "a number without a unit".
std::string described(std::string_view unit);

/// The value of a number followed by a unit, in `unit`. Throws InputError at `place` if the text is
/// not that, is not finite, or has another dimension; `path` is the value's name for the message.
double read_quantity(std::string_view text, std::string_view unit, std::string_view path,
                     const SourcePlace& place);

/// For a value that is out of bounds when taken in `unit`: the common unit that the user may have
/// meant, as ` - if this is in mm, write "300 mm"`, or the empty string.
std::string unit_hint(double value, std::string_view unit, double low, double high);

}  // namespace lilytank
