#include "effects/bond_effects.hpp"

#include <limits>

#include "lilytank/model_parameter.hpp"

namespace lilytank {
namespace {

// Logarithms of rates over the model's: changes that minutes of recordings show. Around 0.1 to 0.15
// exchanges begun a tick, firmware evaluates bonds most often, and half of that makes hardly a
// difference.
constexpr double kOtherRate = 0.7, kFewerBegun = -1.1;
constexpr double kFaulty = 0.25;  // probability of a fault, likewise
constexpr double kReach = 2e-3;   // m

// Of a probability or a length; `size` is that of its change.
Effect of_control(const Model& model, const char* name, const std::string& parameter, double size,
                  const char* equation) {
  Effect e;
  e.name = name, e.paths = {"control." + parameter}, e.sizes = {size};
  const ModelParameter of = model_parameter(e.paths[0]);
  const double value = parameter_value(model, e.paths[0]);
  e.units = {of.unit}, e.low = (of.low - value) / size, e.high = (of.high - value) / size;
  e.variable = "bond", e.equation = equation, e.split = split_by::kEventLog;
  e.scored = e.mean_force = false;
  return e;
}

// A rate, by its logarithm.
void in_proportion(Effect& rate) {
  rate.logarithms = {true};
  rate.low = -std::numeric_limits<double>::infinity(), rate.high = -rate.low;
}

}  // namespace

std::vector<Effect> bond_effects(const Model& model) {
  if (!model.control.latches) return {};
  std::vector<Effect> out;
  const auto add = [&](const char* name, const char* parameter, double size,
                       const char* equation) -> Effect& {
    return out.emplace_back(of_control(model, name, parameter, size, equation));
  };
  if (!model.rulesets.empty()) {
    if (model.control.clock == Clock::events) {
      Effect& rate = add("evaluation_rate", "evaluation_rate", kOtherRate,
                         "bonds are evaluated at another rate than the model's");
      rate.two_sided = true, in_proportion(rate);
    } else {
      Effect& rate = add("evaluation_rate", "initiative", kFewerBegun,
                         "modules begin exchanges less often, and bonds are evaluated less often");
      in_proportion(rate);
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
      "faces latch from another distance than the model's")
      .two_sided = true;
  add("latch_failure", "latch_failure", kFaulty,
      "faces that meet fail to hold each other with this probability");
  return out;
}

}  // namespace lilytank
