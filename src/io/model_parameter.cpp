#include "lilytank/model_parameter.hpp"

#include <algorithm>

#include "io/scenario_keys.hpp"
#include "io/scenario_values.hpp"
#include "lilytank/error.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

// Works for constant lists as well.
template <class Forces>
auto find_active(Forces& forces, const ForceTerm* term) {
  return std::find_if(forces.begin(), forces.end(),
                      [&](const ActiveForce& active) { return active.term == term; });
}

// Forces stand in the order of the library.
std::vector<ActiveForce>::iterator switch_on(std::vector<ActiveForce>& forces,
                                             const ForceTerm* term) {
  auto at = forces.begin();
  for (const ForceTerm* before : force_library()) {
    if (before == term) break;
    if (at != forces.end() && at->term == before) ++at;
  }
  return forces.insert(at, with_defaults(*term));
}

// The whole table, once. Its targets are the members of a draft that is not used otherwise.
const std::vector<ScenarioKey>& key_table() {
  static ScenarioDraft draft;
  static const std::vector<ScenarioKey> keys = scenario_keys(draft);
  return keys;
}

bool may_vary(const ScenarioKey& key) {
  return key.number.has_value() && !key.whole;
}

InputError not_varied(const std::string& path) {
  std::vector<std::string> names;
  bool known = false;
  for (const ScenarioKey& key : key_table()) {
    if (may_vary(key)) names.push_back(key.path);
    known = known || key.path == path;
  }
  return InputError("'" + path + "' " +
                    (known ? "is not a number that can be varied in recordings of one tank"
                           : "is not a parameter of the model") +
                    did_you_mean(path, names));
}

}  // namespace

std::string ParameterRef::path() const {
  return "forces." + std::string(term->name()) + "." + std::string((*this)->name);
}

double ParameterRef::get(const Model& model) const {
  const auto active = find_active(model.forces, term);
  return active != model.forces.end() ? active->p[index] : (*this)->standard;
}

double& ParameterRef::in(Model& model) const {
  auto active = find_active(model.forces, term);
  if (active == model.forces.end()) active = switch_on(model.forces, term);
  return active->p[index];
}

double ModelNumber::get(const Model& model) const {
  return std::visit([&](const auto& at) { return at.get(model); }, at_);
}

double& ModelNumber::in(Model& model) const {
  return std::visit([&](const auto& at) -> double& { return at.in(model); }, at_);
}

void ModelParameter::set(Model& model, double value) const {
  if (!(value >= low && value <= high)) {
    throw InputError(path + " = " + shortest(value) + " is outside " + shortest(low) + " .. " +
                     shortest(high));
  }
  number.in(model) = value;
}

ModelParameter model_parameter(const std::string& path) {
  for (const ScenarioKey& key : key_table()) {
    if (key.path != path || !may_vary(key)) continue;
    return {{key.path, key.unit, key.low, key.high, key.meaning}, *key.number};
  }
  throw not_varied(path);
}

double parameter_value(const Model& model, const std::string& path) {
  return model_parameter(path).get(model);
}

Model with_parameters(const Model& model, std::span<const std::string> paths,
                      std::span<const double> values) {
  Model out = model;
  for (std::size_t i = 0; i < paths.size(); ++i) model_parameter(paths[i]).set(out, values[i]);
  return out;
}

}  // namespace lilytank
