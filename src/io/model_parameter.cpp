#include "lilytank/model_parameter.hpp"

#include <algorithm>
#include <array>

#include "io/scenario_keys.hpp"
#include "io/scenario_values.hpp"
#include "lilytank/error.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

bool may_vary(const ScenarioKey& key) {
  if (!std::holds_alternative<double*>(key.target) || key.whole) return false;
  if (key.path == "flow.K_v" || key.path == "flow.rho") return true;
  constexpr std::array<const char*, 4> tables{"module.", "ball.", "contact.", "forces."};
  return std::any_of(tables.begin(), tables.end(),
                     [&](const char* table) { return key.path.starts_with(table); });
}

// A model opened up as a draft, whose keys reach its numbers.
class OpenModel {
 public:
  explicit OpenModel(const Model& model) {
    draft_.scenario.model = model;
    for (ForceDraft& force : draft_.forces) {
      force.on = false;
      for (const ActiveForce& active : model.forces) {
        if (active.term == force.term) force.on = true, force.p = active.p;
      }
    }
    keys_ = scenario_keys(draft_);
  }

  ScenarioKey& find(const std::string& path) {
    const auto found = std::find_if(keys_.begin(), keys_.end(), [&](const ScenarioKey& key) {
      return key.path == path && may_vary(key);
    });
    if (found != keys_.end()) return *found;
    std::vector<std::string> names;
    bool known = false;
    for (const ScenarioKey& key : keys_) {
      if (may_vary(key)) names.push_back(key.path);
      known = known || key.path == path;
    }
    throw InputError("'" + path + "' " +
                     (known ? "is not a number that can be varied in recordings of one tank"
                            : "is not a parameter of the model") +
                     did_you_mean(path, names));
  }

  void set(const std::string& path, double value) {
    const ScenarioKey& key = find(path);
    if (!(value >= key.low && value <= key.high)) {
      throw InputError(path + " = " + shortest(value) + " is outside " + bounds_text(key));
    }
    *std::get<double*>(key.target) = value;
    for (ForceDraft& force : draft_.forces) {
      if (path.starts_with("forces." + std::string(force.term->name()) + ".")) force.on = true;
    }
  }

  double get(const std::string& path) { return *std::get<double*>(find(path).target); }

  Model close() {
    Model& model = draft_.scenario.model;
    model.forces.clear();
    for (const ForceDraft& force : draft_.forces) {
      if (force.on) model.forces.push_back({force.term, force.p});
    }
    return std::move(model);
  }

 private:
  ScenarioDraft draft_;
  std::vector<ScenarioKey> keys_;
};

}  // namespace

ModelParameter model_parameter(const std::string& path) {
  OpenModel open(Model{});
  const ScenarioKey& key = open.find(path);
  return {key.path, key.unit, key.low, key.high, key.meaning};
}

double parameter_value(const Model& model, const std::string& path) {
  return OpenModel(model).get(path);
}

Model with_parameters(const Model& model, std::span<const std::string> paths,
                      std::span<const double> values) {
  OpenModel open(model);
  for (std::size_t i = 0; i < paths.size(); ++i) open.set(paths[i], values[i]);
  return open.close();
}

}  // namespace lilytank
