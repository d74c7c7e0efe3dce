#include "lilytank/start.hpp"

namespace lilytank {

Model standard_model() {
  Model model;
  model.field = std::make_shared<const FlowField>(
      analytic_tank(AnalyticTank{.radius = model.tank.radius}, Interpolation::bilinear));
  for (const ForceTerm* term : force_library()) {
    if (term->baseline()) model.forces.push_back(with_defaults(*term));
  }
  return model;
}

}  // namespace lilytank
