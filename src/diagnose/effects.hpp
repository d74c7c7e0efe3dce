// The catalogue of effects: which force terms stand for a name, at which size they are tried, and
// what a reader should know of each.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "forces/empirical_force.hpp"
#include "lilytank/calibration.hpp"
#include "lilytank/emulator.hpp"
#include "lilytank/model.hpp"

namespace lilytank {

/// One way in which an effect may be there: several of one name differ in range or time.
struct Effect {
  std::string name;
  std::vector<std::string> paths;  ///< amplitudes, which a fit varies
  std::vector<double> sizes;       ///< at which each is simulated: some ten deviations in minutes
  std::vector<std::string> units;  ///< of the amplitudes
  bool two_sided = false;          ///< amplitudes may be negative
  /// Other numbers of the term, which are held.
  std::vector<std::pair<std::string, double>> shape;
  /// Of those, the ones that are found along once the effect is there: path, unit, bounds.
  std::vector<FitParameter> refine;
  std::string variable;  ///< of what the mismatch is a function: position, radius, pair, slip, ...
  /// The cheapest experiment that would tell it from others of its kind; "" if there is none.
  std::string split;
  bool scored = true;  ///< the term gives a force to be compared with innovations
  /// It pushes modules on the average, not only now this way and now that way.
  bool mean_force = true;
  /// Power of its amplitude with which it begins to show: 2 if it is a variance's, or if a
  /// calibration takes up what is in proportion.
  double growth = 1;
  /// What it has of its own among those of its name: "strength, range = 0.004 m".
  std::string variant() const;
  /// It is the camera's doing, not the tank's.
  bool camera() const;
  /// Value of an amplitude at which the effect is absent.
  double absent(const Model& model, std::size_t component) const;
};

/// Several effects at once as one, their amplitudes one after the other.
Effect together(const std::vector<Effect>& effects);

/// Every effect that a simulation can have. `model` gives sizes of tank and module.
std::vector<Effect> effect_catalogue(const Model& model);

/// A stream of this width about a place, m.
Effect stream_effect(const Model& model, double x, double y, double width);

/// The model with an effect at `amplitudes` (one a path); as it is if the effect is the camera's.
Model with_effect(const Model& model, const Effect& effect, const std::vector<double>& amplitudes);

/// Shapes that are looked for without a name: a variable and a direction.
struct Shape {
  ForceCurve curve;
  std::string variable;   ///< as in a verdict: position, radius, pair, slip, heading, spin, time
  std::string direction;  ///< "along the slip"
  std::string unit;       ///< of the variable
  double size = 0;        ///< N or N m, at which it is simulated
};
/// `seconds`: of the longest recording.
std::vector<Shape> shape_catalogue(const Model& model, double seconds);
/// The shape as an effect whose amplitudes are its knots.
Effect effect_of(const Shape& shape);

}  // namespace lilytank
