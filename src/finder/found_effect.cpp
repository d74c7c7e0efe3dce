#include "finder/found_effect.hpp"

#include <algorithm>
#include <cmath>

#include "statistics/text_table.hpp"

namespace lilytank {

const Effect& effect_in(const ScorePlan& plan, const EffectFit& f) {
  return plan.effects[static_cast<std::size_t>(f.effect)];
}

std::optional<ScannedEffect> scanned(const Effect& effect, const ScoreDetails& details) {
  if (effect.estimated == Estimated::place) {
    const auto scan = details.scans.places.find(effect.term);
    if (scan == details.scans.places.end()) return std::nullopt;
    const FoundPlace& at = scan->second.best;
    const auto size = static_cast<Eigen::Index>(at.amplitudes.size());
    return ScannedEffect{
        placed(effect, at.x, at.y, at.width).held,
        JointAmplitudes{Eigen::VectorXd::Map(at.amplitudes.data(), size), at.gain}};
  }
  if (effect.estimated == Estimated::slip_and_frequency && details.swinging > 0) {
    return ScannedEffect{{{effect.held[0].of, details.swinging}}, std::nullopt};
  }
  const bool negative = effect.negative_of != nullptr;
  const auto scan = details.scans.values.find(negative ? effect.negative_of : effect.term);
  if (scan == details.scans.values.end()) return std::nullopt;
  const double amplitude = negative ? -scan->second.amplitude : scan->second.amplitude;
  if (!effect.two_sided && !(amplitude > 0)) return std::nullopt;
  return ScannedEffect{{{effect.held[0].of, scan->second.value}}, std::nullopt};
}

Effect found_effect(const ScorePlan& plan, const EffectFit& f, const ScoreDetails& details) {
  if (f.effect < 0) return effect_of(plan.shapes[static_cast<std::size_t>(f.shape)]);
  Effect out = effect_in(plan, f);
  if (out.estimated == Estimated::gain_and_frequency) out.held[0].value = details.pulsation;
  if (const auto scan = scanned(out, details)) out.held = scan->held;
  for (auto& [of, value] : out.held) {
    const auto better = details.refined.find(of.path());
    if (better != details.refined.end()) value = better->second;
  }
  if (out.estimated == Estimated::module) {
    out.held = {
        {*parameter_of(*out.term, ParameterKind::module), static_cast<double>(details.heaviest)}};
  }
  return out;
}

std::string stage_name(const ScorePlan& plan, const EffectFit& f, const ScoreDetails& details) {
  if (f.effect < 0) return "shape " + std::to_string(f.shape);
  const std::string out = "effect " + std::to_string(f.effect);
  if (effect_in(plan, f).estimated == Estimated::gain_and_frequency) {
    return out + " at " + fixed(details.pulsation, 1) + " Hz";
  }
  const auto held = found_effect(plan, f, details).held;
  const bool own = std::any_of(held.begin(), held.end(), [&](const HeldParameter& one) {
    return details.refined.count(one.of.path()) > 0;
  });
  if (!own && !scanned(effect_in(plan, f), details)) return out;
  std::string place = effect_in(plan, f).name;
  for (const auto& [of, value] : held) place += " " + fixed(value, 4);
  return place;
}

}  // namespace lilytank
