// Under which conditions fitted values hold, as the beginning of an overlay.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "io/scenario_text.hpp"
#include "lilytank/model.hpp"
#include "lilytank/recording.hpp"

namespace lilytank {

/// Scenario paths and SI values.
using FitConditions = std::vector<std::pair<std::string, double>>;

/// Tank, water, bodies of that kind, contacts and step of the model. Without the keys in `fitted`,
/// which the overlay sets to their estimates: a key must not occur twice.
FitConditions fit_conditions(const Model& model, BodyKind body,
                             const std::vector<std::string>& fitted);

/// An overlay up to the fitted values: a comment, the conditions and, if it was extracted, the flow
/// in flow.csv beside it.
ScenarioText begun_overlay(const std::string& comment, const FitConditions& conditions, bool flow);

}  // namespace lilytank
