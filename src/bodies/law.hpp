// Laws of force between and on point bodies: one row each in laws.cpp. The same function is
// integrated and fitted.
#pragma once
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lilytank {
struct BodyRun;
}

namespace lilytank::bodies {

/// Bodies at a moment. Positions and velocities are [body][dimension].
struct Scene {
  int bodies = 1, dimensions = 1;
  const double* mass = nullptr;
  const double* radius = nullptr;
  const double* drivers = nullptr;
  double time = 0;
  const double* x = nullptr;
  const double* v = nullptr;
  const BodyRun* run = nullptr;  ///< for drivers at other times (driver_history.hpp)
};

/// Drivers that have laws of their own.
inline constexpr int kSingleDrivers = 4;

/// Sizes that occur in the recordings: where starts and fixed numbers of laws come from.
struct Typical {
  int dimensions = 1, bodies = 1, drivers = 0;
  double speed = 1, fastest = 1;   ///< rms, largest
  double low = 0, high = 1;        ///< of positions
  double centre[2] = {0, 0};       ///< of positions
  double farthest = 1;             ///< largest distance from the centre
  double nearest = 1, middle = 1;  ///< gap: smallest, median
  double duration = 1;
  double rate = 0;  ///< rad/s, of the strongest line in the velocities' spectrum; 2-D: clockwise
  double mass = 1;  ///< kg, of the first body
  bool of_a_run = false;  ///< of one run alone, which has coefficients of its own
  double turning = 0;     ///< a known constant f, 1/s
  int latitude = -1;
  int current[2] = {-1, -1}, wind[2] = {-1, -1};  ///< as in BodyExperiment
  std::array<double, kSingleDrivers> period{};    ///< s, of each driver (period_of)
};

enum class Kind {
  amplitude,  ///< the force is proportional to it; 0: no force
  positive,   ///< fitted as its logarithm
  place,      ///< any number
  fixed,      ///< not fitted
  driver,     ///< the number of a driver, -1: none; not fitted, and not reported
};

struct LawParameter {
  std::string name, unit;  ///< in units of "m" for a position and "N" for a force
  Kind kind = Kind::amplitude;
  double start = NAN;  ///< where a fit starts; NaN of amplitudes: scaled by who fits
  double other = NAN;  ///< a second start, with the others at theirs; NaN: none
  double scale = NAN;  ///< of a place's number; NaN: the range of the positions
};

/// Constant and without data, as the simulator's force terms are.
struct Law {
  std::string_view name, equation = "";
  /// Of what the force is a function: slip, medium slip, position, pair, time, turn, driver, or ""
  /// (constant).
  std::string_view variable = "";
  /// The experiment that would distinguish it from others of its kind.
  std::string_view split = "a longer recording";
  /// Laws that this one is at a value of its own parameters. The best of them is reported instead
  /// where this one does not predict better.
  std::array<std::string_view, kSingleDrivers> special = {};
  /// A nonparametric force law; no known law.
  bool curve = false;
  std::vector<LawParameter> (*parameters)(const Typical& t);
  /// Adds its forces (N; m/s^2 where masses are 1) at [body][dimension].
  void (*add)(const Scene& s, std::span<const double> p, double* force);
  /// Whether the recordings can have it at all.
  bool (*possible)(const Typical& t) = [](const Typical&) { return true; };

  /// Values of the parameters from which fits start: one set, or two.
  std::vector<std::vector<double>> starts(const Typical& t) const;
};

/// All laws: those with a name first, then the curves.
std::span<const Law> law_library();
/// The law of a name; null if there is none.
const Law* find_law(std::string_view name);

/// Velocity (m/s) along an axis of the medium of a law over the medium slip, by its parameters.
double velocity_of_medium(const Scene& s, std::span<const double> p, int axis);

/// Smallest and largest value of a law's variable in the recordings.
struct VariableRange {
  double low = 0, high = 1;
};
VariableRange range_of(std::string_view variable, const Typical& t);
/// Its unit; `unit`: of a position.
std::string unit_of(std::string_view variable, const std::string& unit);

/// Of the principal lunar tide (M2), rad/s.
inline constexpr double kTideRate = 2 * std::numbers::pi / (12.4206 * 3600);
/// Radians per second at which free motion turns clockwise at a latitude in degrees.
double inertial_turning(double latitude);

}  // namespace lilytank::bodies
