// The catalogue of effects: those of the force terms (lilytank/effect.hpp), of the camera and of
// contacts.
#pragma once
#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "forces/empirical_force.hpp"
#include "lilytank/emulator.hpp"
#include "lilytank/fit_parameter.hpp"
#include "lilytank/force.hpp"
#include "lilytank/model.hpp"
#include "lilytank/model_parameter.hpp"

namespace lilytank {

/// The first parameter of that kind, if the term has one.
std::optional<ParameterRef> parameter_of(const ForceTerm& term, ParameterKind kind);

/// A parameter that an effect holds at a value.
struct HeldParameter {
  ParameterRef of;
  double value = 0;
};

/// One way in which an effect may be there: several of one name differ in range or time.
struct Effect {
  std::string name;
  int family = -1;                  ///< in a catalogue: the same number for effects of one name
  const ForceTerm* term = nullptr;  ///< null: the camera, contacts or bonds
  const ForceTerm* negative_of = nullptr;  ///< the term of the same law with the other sign
  Estimated estimated = Estimated::none;
  std::string equation;
  std::vector<std::string> paths;  ///< amplitudes, which a fit varies
  /// At which each is simulated: some ten deviations in minutes. Negative: the effect lowers it.
  std::vector<double> sizes;
  std::vector<std::string> units;  ///< of the amplitudes
  bool two_sided = false;          ///< amplitudes may be negative
  /// [amplitude] Whether it is that of the parameter's logarithm. Empty: none is.
  std::vector<bool> logarithms;
  bool logarithmic(std::size_t component) const {
    return !logarithms.empty() && logarithms[component];
  }
  /// Amplitudes, in sizes, at which a parameter of the control reaches its bounds.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  /// The nearest amplitudes that leave a tenth of the way to these.
  Eigen::VectorXd within(const Eigen::VectorXd& amplitudes) const;
  /// Other parameters of the term.
  std::vector<HeldParameter> held;
  /// Those of `held` that are refined once the effect is selected: path, unit, bounds.
  std::vector<FitParameter> refine;
  /// First value of the scan of a refined parameter; 0: no scan.
  double scanned_from = 0;
  /// Curve of an empirical force; its knots are the amplitudes.
  std::optional<ForceCurve> curve;
  std::string
      variable;  ///< variable that the mismatch depends on: position, radius, pair, slip, ...
  /// The cheapest experiment that would distinguish it from others of its kind; "" if there is
  /// none.
  std::string split;
  bool scored = true;  ///< the term gives a force to be compared with innovations
  /// It pushes modules on the average, not only now this way and now that way.
  bool mean_force = true;
  /// Power of its amplitude with which it begins to show: 2 if it is a variance's, or if a
  /// calibration takes up what is in proportion.
  double growth = 1;
  /// What it has of its own among those of its name: "strength, range = 0.004 m".
  std::string variant() const;
  /// It has the law of another effect, with whichever sign.
  bool is_of(const Effect& law) const {
    return term == law.term || (negative_of != nullptr && negative_of == law.term);
  }
  /// It is the camera's doing, not the tank's.
  bool camera() const;
  /// It is a fault of the modules' latches or radio, which shows in bonds alone.
  bool control() const { return variable == "bond"; }
  /// Value of a parameter at which the effect is absent.
  double absent(const Model& model, std::size_t component) const;
  /// Value of a parameter at an amplitude in sizes: absent() + amplitude size, or, if that is
  /// logarithmic, absent() exp(amplitude size).
  double value(const Model& model, std::size_t component, double amplitude) const;
  /// Inverse of value().
  double amplitude(const Model& model, std::size_t component, double value) const;
};

/// Several effects at once as one, their amplitudes one after the other.
Effect together(const std::vector<Effect>& effects);

/// Every effect that a simulation can have, in the order of the descriptions. `model` gives the
/// size of the tank, and whether there are latches.
std::vector<Effect> effect_catalogue(const Model& model);

/// An effect that has a place (Estimated::place), at this one, with this width, m.
Effect placed(Effect effect, double x, double y, double width);

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
/// The shape as an effect; its knots are the amplitudes.
Effect effect_of(const Shape& shape);

}  // namespace lilytank
