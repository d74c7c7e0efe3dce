// Numbers of a Model by their dotted scenario paths: what calibration varies, and whatever else
// asks how a result depends on a number.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "lilytank/model.hpp"

namespace lilytank {

/// A number of a Model, as the table of scenario keys has it.
struct ModelParameter {
  /// Dotted path: "forces.face_drag.K_F".
  std::string path;
  /// SI; "1" if dimensionless.
  std::string unit;
  /// Bounds, inclusive.
  double low = 0, high = 0;
  /// One sentence from the table of keys.
  std::string meaning;
};

/// The parameter of that path: K_v and rho of the flow, and every real number of module, ball,
/// contact and forces. Throws InputError, with the nearest right path, on any other.
ModelParameter model_parameter(const std::string& path);

/// Its value in a model. Of a force that is off, the value that it would have.
double parameter_value(const Model& model, const std::string& path);

/// A copy of the model with other values of some parameters. Forces that are off go on if one of
/// their parameters is named. Throws InputError on an unknown path or a value out of bounds.
Model with_parameters(const Model& model, std::span<const std::string> paths,
                      std::span<const double> values);

}  // namespace lilytank
