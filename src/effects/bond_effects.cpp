#include "effects/bond_effects.hpp"

#include "lilytank/model_parameter.hpp"

namespace lilytank {
namespace {

// Of the model's rate: changes that minutes of recordings show. Around 0.1 to 0.15 exchanges begun
// a tick, firmware evaluates bonds most often, and 0.05 makes hardly a difference.
constexpr double kOtherRate = 0.5, kFewerBegun = 0.6;
constexpr double kFaulty = 0.25;  // probability of a fault, likewise
constexpr double kReach = 2e-3;   // m

enum class Sides { one, both };

// `size` < 0: it lowers the parameter.
Effect of_control(const Model& model, const char* name, const std::string& path, double size,
                  const char* equation, Sides sides = Sides::one) {
  const ModelParameter of = model_parameter(path);
  const double value = parameter_value(model, path);
  Effect e;
  e.name = name, e.paths = {path}, e.sizes = {size};
  e.units = {of.unit}, e.two_sided = sides == Sides::both;
  e.high = ((size > 0 ? of.high : of.low) - value) / size;
  e.low = ((size > 0 ? of.low : of.high) - value) / size;
  e.variable = "bond", e.equation = equation, e.split = split_by::kEventLog;
  e.scored = e.mean_force = false;
  return e;
}

}  // namespace

std::vector<Effect> bond_effects(const Model& model) {
  if (!model.control.latches) return {};
  std::vector<Effect> out;
  const auto add = [&](const char* name, const char* parameter, double size, const char* equation,
                       Sides sides = Sides::one) {
    out.push_back(
        of_control(model, name, std::string("control.") + parameter, size, equation, sides));
  };
  const ControlParameters& control = model.control;
  if (!model.rulesets.empty()) {
    if (control.clock == Clock::events) {
      add("evaluation_rate", "evaluation_rate", kOtherRate * control.evaluation_rate,
          "bonds are evaluated at another rate than the model's", Sides::both);
    } else {
      if (control.initiative > 0) {
        add("evaluation_rate", "initiative", -kFewerBegun * control.initiative,
            "modules begin exchanges less often, and bonds are evaluated less often");
      }
      // Of random evaluations, a lost message makes one less.
      add("message_loss", "message_loss", kFaulty,
          "messages to a neighbour are lost with this probability");
    }
    add("answer_loss", "answer_loss", kFaulty,
        "answers to the initiator are lost with this probability");
    add("release_failure", "release_failure", kFaulty,
        "latches fail to release with this probability");
  }
  add("capture_distance", "capture_distance", kReach,
      "faces latch from another distance than the model's", Sides::both);
  add("latch_failure", "latch_failure", kFaulty,
      "faces that meet fail to hold each other with this probability");
  return out;
}

}  // namespace lilytank
