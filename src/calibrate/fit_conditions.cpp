#include "calibrate/fit_conditions.hpp"

#include <algorithm>

#include "lilytank/model_parameter.hpp"

namespace lilytank {

FitConditions fit_conditions(const Model& model, BodyKind body,
                             const std::vector<std::string>& fitted) {
  std::vector<std::string> paths{"module.side", "module.mass", "module.draught"};
  if (body == BodyKind::ball) paths = {"ball.radius", "ball.mass", "ball.drag_area"};
  paths.insert(paths.end(), {"flow.rho", "contact.friction", "contact.restitution",
                             "contact.restitution_speed"});
  FitConditions out{{"tank.radius", model.tank.radius}};
  for (const std::string& path : paths) {
    if (std::find(fitted.begin(), fitted.end(), path) != fitted.end()) continue;
    out.emplace_back(path, parameter_value(model, path));
  }
  out.emplace_back("run.dt", model.dt);
  return out;
}

ScenarioText begun_overlay(const std::string& comment, const FitConditions& conditions, bool flow) {
  ScenarioText out;
  out.comment(comment);
  for (const auto& [path, value] : conditions) out.number(path, value);
  if (flow) out.quoted("flow.file", "flow.csv");
  return out;
}

}  // namespace lilytank
