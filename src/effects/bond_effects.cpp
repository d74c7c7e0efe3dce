#include "effects/bond_effects.hpp"

#include "lilytank/model_parameter.hpp"

namespace lilytank {
namespace {

constexpr double kOtherRate = 0.5;  // of the model's: a change that minutes of recordings show
constexpr double kFaulty = 0.25;    // probability of a fault, likewise
constexpr double kReach = 2e-3;     // m

Effect of_control(const char* name, const std::string& path, double size, const char* equation) {
  Effect e;
  e.name = name, e.paths = {path}, e.sizes = {size};
  e.units = {model_parameter(path).unit};
  e.variable = "bond", e.equation = equation, e.split = split_by::kEventLog;
  e.scored = e.mean_force = false;
  return e;
}

}  // namespace

std::vector<Effect> bond_effects(const Model& model) {
  if (!model.control.latches) return {};
  const bool events = model.control.clock == Clock::events;
  const std::string rate = events ? "control.evaluation_rate" : "control.initiative";
  std::vector<Effect> out;
  if (!model.rulesets.empty()) {
    out.push_back(of_control("evaluation_rate", rate, kOtherRate * parameter_value(model, rate),
                             "bonds are evaluated at another rate than the model's"));
    out.back().two_sided = true;
    // Of random evaluations, a lost message makes one less.
    if (!events) {
      out.push_back(of_control("message_loss", "control.message_loss", kFaulty,
                               "messages to a neighbour are lost with this probability"));
    }
    out.push_back(of_control("answer_loss", "control.answer_loss", kFaulty,
                             "answers to the initiator are lost with this probability"));
    out.push_back(of_control("release_failure", "control.release_failure", kFaulty,
                             "latches fail to release with this probability"));
  }
  out.push_back(of_control("capture_distance", "control.capture_distance", kReach,
                           "faces latch from another distance than the model's"));
  out.back().two_sided = true;
  out.push_back(of_control("latch_failure", "control.latch_failure", kFaulty,
                           "faces that meet fail to hold each other with this probability"));
  return out;
}

}  // namespace lilytank
