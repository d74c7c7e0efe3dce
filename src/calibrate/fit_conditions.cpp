#include "calibrate/fit_conditions.hpp"

#include <algorithm>

#include "lilytank/model_parameter.hpp"
#include "text/number.hpp"

namespace lilytank {

std::string fit_conditions(const Model& model, BodyKind body,
                           const std::vector<std::string>& fitted) {
  std::vector<std::string> paths{"module.side", "module.mass", "module.draught"};
  if (body == BodyKind::ball) paths = {"ball.radius", "ball.mass", "ball.drag_area"};
  paths.insert(paths.end(), {"flow.rho", "contact.friction", "contact.restitution",
                             "contact.restitution_speed"});
  std::string out = "tank.radius = " + shortest(model.tank.radius) + "\n";
  for (const std::string& path : paths) {
    if (std::find(fitted.begin(), fitted.end(), path) != fitted.end()) continue;
    out += path + " = " + shortest(parameter_value(model, path)) + "\n";
  }
  return out + "run.dt = " + shortest(model.dt) + "\n";
}

}  // namespace lilytank
