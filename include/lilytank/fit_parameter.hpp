// A parameter that a fit to recordings varies.
#pragma once
#include <string>

namespace lilytank {

/// A parameter that is looked for.
struct FitParameter {
  /// Dotted scenario path, or the camera's (emulator.hpp), and its SI unit.
  std::string path, unit;
  /// Bounds, inclusive: simulations within them are stable.
  double low = 0, high = 1;
  /// Whether fitted on a logarithmic scale; then low > 0.
  bool logarithmic = false;
  /// Nuisance parameter: fitted with the others but not reported, such as the camera's noise.
  bool nuisance = false;
  /// From the parameter's unit to the fitted scale: the logarithm, or the value itself.
  double to_scale(double value) const;
  /// Inverse of to_scale().
  double from_scale(double value) const;
};

}  // namespace lilytank
