#include "lilytank/model.hpp"

namespace lilytank {

const Command& command_at(const Model& model, int index) {
  const int timed = static_cast<int>(model.commands.size());
  return index < timed ? model.commands[index] : model.feedback[index - timed];
}

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
