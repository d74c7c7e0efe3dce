#include "library.hpp"

#include <array>

#include "lilytank/model.hpp"

namespace lilytank {

std::span<const ForceTerm* const> force_library() {
  // The order of addition is part of every result: new terms go to the end.
  static const std::array<const ForceTerm*, 6> terms{
      &face_drag(), &ball_drag(),  &stochastic_force(),
      &damping(),   &body_force(), &pair_attraction(),
  };
  return terms;
}

const FlowField& water(const Model& model, const Moment& now) {
  return now.water != nullptr ? *now.water : *model.field;
}

const ForceTerm* find_force(std::string_view name) {
  for (const ForceTerm* term : force_library()) {
    if (term->name() == name) return term;
  }
  return nullptr;
}

ActiveForce with_defaults(const ForceTerm& term) {
  ActiveForce force{&term, {}};
  for (const Parameter& p : term.parameters()) force.p.push_back(p.standard);
  return force;
}

}  // namespace lilytank
