// Numbers of a Model by their dotted scenario paths: the parameters of calibration, diagnosis and
// other analyses of how a result depends on a number. A path is looked up once; the parameter then
// reads and writes models without text.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "lilytank/model.hpp"

namespace lilytank {

/// A parameter of a force term, which lives as long as the program.
struct ParameterRef {
  const ForceTerm* term = nullptr;
  std::size_t index = 0;  ///< into term->parameters()
  const Parameter* operator->() const { return &term->parameters()[index]; }
  /// "forces.<term>.<parameter>", as scenario files have it.
  std::string path() const;
  /// Its value; of a force that is off, the default.
  double get(const Model& model) const;
  /// The number itself. A force that is off is switched on, its other parameters at their defaults.
  double& in(Model& model) const;
};

/// Where a number is within any Model: a member of one of its parts, or a parameter of a force
/// term.
class ModelNumber {
 public:
  template <class Part>
  ModelNumber(Part Model::*part, double Part::*number) : at_(Member<Part>{part, number}) {}
  ModelNumber(const ParameterRef& of) : at_(of) {}

  /// As those of ParameterRef.
  double get(const Model& model) const;
  double& in(Model& model) const;

 private:
  template <class Part>
  struct Member {
    Part Model::*part;
    double Part::*number;
    double get(const Model& model) const { return model.*part.*number; }
    double& in(Model& model) const { return model.*part.*number; }
  };
  std::variant<ParameterRef, Member<ModuleParameters>, Member<BallParameters>,
               Member<ContactParameters>, Member<FlowParameters>, Member<ControlParameters>>
      at_;
};

/// Name, unit and bounds of a number that may vary.
struct ParameterInfo {
  std::string path;          ///< dotted path: "forces.face_drag.K_F"
  std::string unit;          ///< SI; "1" if dimensionless
  double low = 0, high = 0;  ///< bounds, inclusive
  std::string meaning;       ///< one sentence from the table of keys
};

/// A number of a Model, as the table of scenario keys has it.
struct ModelParameter : ParameterInfo {
  ModelNumber number;
  double get(const Model& model) const { return number.get(model); }
  /// Switches a force on that is off. Throws InputError on a value out of bounds.
  void set(Model& model, double value) const;
};

/// The parameter of that path: K_v and rho of the flow, rates and probabilities of the control, and
/// every real number of module, ball, contact and forces. Throws InputError, with the nearest right
/// path, on any other.
ModelParameter model_parameter(const std::string& path);

/// Its value in a model. Of a force that is off, the value that it would have.
double parameter_value(const Model& model, const std::string& path);

/// A copy of the model with other values of some parameters. Forces that are off go on if one of
/// their parameters is named. Throws InputError on an unknown path or a value out of bounds.
Model with_parameters(const Model& model, std::span<const std::string> paths,
                      std::span<const double> values);

}  // namespace lilytank
