// The calibrated parameters and their bounds.
#include <algorithm>

#include "lilytank/calibration.hpp"
#include "lilytank/model_parameter.hpp"

namespace lilytank {
namespace {

template <std::size_t n>
std::size_t index_of(const std::string& word, const std::string (&words)[n], const char* what) {
  for (std::size_t i = 0; i < n; ++i) {
    if (word == words[i]) return i;
  }
  std::string all;
  for (const std::string& w : words) all += (all.empty() ? "" : ", ") + w;
  throw InputError(std::string(what) + " '" + word + "' is none of " + all +
                   did_you_mean(word, words));
}

const std::string kObjectives[]{"summary", "prediction", "msd-weighted", "msd"};
const std::string kFlows[]{"smooth", "paper", "scenario"};

// The ranges that are searched are narrower than the bounds of the keys: within them a step of 25
// ms takes less than a third of a body's speed relative to the water, for any speed of the water in
// such a tank, and a logarithmic scale begins above 0.
FitParameter by_factors(const std::string& path, double low, double high) {
  return {path, model_parameter(path).unit, low, high, true};
}
FitParameter linear(const std::string& path, double high) {
  const ModelParameter of = model_parameter(path);
  return {path, of.unit, of.low, high, false};
}

}  // namespace

std::vector<FitParameter> standard_parameters(BodyKind body) {
  if (body == BodyKind::ball) {
    return {by_factors("flow.K_v", 0.4, 2.5), by_factors("forces.ball_drag.C", 0.05, 5),
            by_factors("forces.stochastic.sigma_stoch", 5e-4, 0.04),
            linear("forces.damping.D_linear", 0.8)};
  }
  return {by_factors("flow.K_v", 0.4, 2.5), by_factors("forces.face_drag.K_F", 0.05, 3),
          by_factors("forces.stochastic.sigma_stoch", 1e-3, 0.04),
          linear("forces.damping.D_linear", 0.8), linear("forces.damping.D_angular", 0.8)};
}

CalibrationObjective objective_named(const std::string& word) {
  return static_cast<CalibrationObjective>(index_of(word, kObjectives, "objective"));
}
std::string name_of(CalibrationObjective objective) {
  return kObjectives[static_cast<std::size_t>(objective)];
}
CalibrationObjective default_objective(const Experiment& experiment, BodyKind body,
                                       const std::vector<FitParameter>& parameters) {
  const std::vector<FitParameter> five = standard_parameters(BodyKind::lily);
  const bool others = !std::ranges::all_of(parameters, [&](const FitParameter& p) {
    return std::ranges::any_of(five, [&](const FitParameter& one) { return one.path == p.path; });
  });
  const bool headings = std::ranges::all_of(experiment.recordings, [](const Recording& one) {
    return one.body != BodyKind::lily || one.has_heading();
  });
  return body == BodyKind::lily && headings && !others ? CalibrationObjective::prediction
                                                       : CalibrationObjective::summary;
}

CalibrationFlow flow_named(const std::string& word) {
  return static_cast<CalibrationFlow>(index_of(word, kFlows, "flow"));
}
std::string name_of(CalibrationFlow flow) {
  return kFlows[static_cast<std::size_t>(flow)];
}

}  // namespace lilytank
