// Laws of force between and on point bodies: one small file each in bodies/laws, one line each in
// laws/list.cpp. The same function integrates and is fitted.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

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
};

/// Sizes that occur in the recordings: where starts and fixed numbers of laws come from.
struct Typical {
  int dimensions = 1, bodies = 1, drivers = 0;
  double speed = 1, fastest = 1;  ///< rms, largest
  double low = 0, high = 1;       ///< of positions
  double centre[2] = {0, 0};
  double nearest = 1, middle = 1;  ///< gap: smallest, median
  double duration = 1, mass = 1;
  double turning = 0;  ///< a known constant f, 1/s
  int latitude = -1;
};

enum class Kind {
  amplitude,  ///< the force is proportional to it; 0: no force
  positive,   ///< fitted as its logarithm
  place,      ///< any number
  fixed,      ///< not fitted
};

struct LawParameter {
  std::string name, unit;  ///< in units of "m" for a position and "N" for a force
  Kind kind = Kind::amplitude;
};

class Law {
 public:
  virtual ~Law() = default;
  virtual std::string_view name() const = 0;
  virtual std::string_view equation() const = 0;
  /// Of what the force is a function: slip, position, pair, time, turn, driver, or "" (constant).
  virtual std::string_view variable() const = 0;
  /// The experiment that would distinguish it from others of its kind.
  virtual std::string_view split() const { return "a longer recording"; }
  virtual std::vector<LawParameter> parameters(const Typical& t) const = 0;
  /// From where fits start; amplitudes are 1, to be scaled by who fits.
  virtual std::vector<std::vector<double>> starts(const Typical& t) const = 0;
  /// Whether the recordings can have it at all.
  virtual bool possible(const Typical& t) const = 0;
  /// Fastest rate (rad/s) at which velocities turn with these numbers; 0 for laws that do not turn
  /// them. Samples far apart are integrated in steps that follow it.
  virtual double turning_rate(std::span<const double>) const { return 0; }
  /// Of a flexible curve that stands for no known law.
  virtual bool curve() const { return false; }
  /// Adds its forces (N; m/s^2 where masses are 1) at [body][dimension].
  virtual void add(const Scene& s, std::span<const double> p, double* force) const = 0;
};

/// All laws: those with a name first, then the curves.
std::span<const Law* const> law_library();
/// The law of a name; null if there is none.
const Law* find_law(std::string_view name);

/// Radians per second at which free motion turns clockwise at a latitude in degrees.
double inertial_turning(double latitude);

}  // namespace lilytank::bodies
