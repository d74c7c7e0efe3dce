// An effect at the direct estimates of its parameters, at which its experiments are simulated.
#include <algorithm>
#include <cmath>
#include <optional>

#include "finder/prepared_tank.hpp"
#include "lilytank/random.hpp"
#include "statistics/linear.hpp"
#include "statistics/text_table.hpp"

namespace lilytank {
namespace {

using Vector = Eigen::VectorXd;

}  // namespace

const Effect& Diagnoser::effect(const EffectFit& f) const {
  return ensemble_->plan().effects[static_cast<std::size_t>(f.effect)];
}

std::optional<Diagnoser::Scanned> Diagnoser::scanned(const Effect& effect,
                                                     const ScoreDetails& details) const {
  if (effect.estimated == Estimated::place) {
    const StreamPlace& s = details.scans.stream;
    return Scanned{stream_effect(setup_.model, s.x, s.y, s.width).held,
                   JointAmplitudes{Eigen::Vector2d(s.speed_x, s.speed_y), s.gain}};
  }
  if (effect.estimated == Estimated::slip_and_frequency && details.swinging > 0) {
    return Scanned{{{effect.held[0].of, details.swinging}}, std::nullopt};
  }
  const bool negative = effect.negative_of != nullptr;
  const auto scan = details.scans.values.find(negative ? effect.negative_of : effect.term);
  if (scan == details.scans.values.end()) return std::nullopt;
  const double amplitude = negative ? -scan->second.amplitude : scan->second.amplitude;
  if (!effect.two_sided && !(amplitude > 0)) return std::nullopt;
  return Scanned{{{effect.held[0].of, scan->second.value}}, std::nullopt};
}

Effect Diagnoser::found_effect(const EffectFit& f, const ScoreDetails& details) const {
  if (f.effect < 0) return effect_of(ensemble_->plan().shapes[static_cast<std::size_t>(f.shape)]);
  Effect out = effect(f);
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

// Nearly equal pulsation frequencies share their experiments.
std::string Diagnoser::stage_name(const EffectFit& f, const ScoreDetails& details) const {
  if (f.effect < 0) return "shape " + std::to_string(f.shape);
  const std::string out = "effect " + std::to_string(f.effect);
  if (effect(f).estimated == Estimated::gain_and_frequency) {
    return out + " at " + fixed(details.pulsation, 1) + " Hz";
  }
  const auto held = found_effect(f, details).held;
  const bool own = std::any_of(held.begin(), held.end(), [&](const HeldParameter& one) {
    return details.refined.count(one.of.path()) > 0;
  });
  if (!own && !scanned(effect(f), details)) return out;
  std::string place = effect(f).name;
  for (const auto& [of, value] : held) place += " " + fixed(value, 4);
  return place;
}

const Fingerprint& Diagnoser::shape_fingerprint(int s) {
  const auto known = shape_fingerprints_.find(s);
  if (known != shape_fingerprints_.end()) return known->second;
  const Effect shape = effect_of(ensemble_->plan().shapes[static_cast<std::size_t>(s)]);
  const std::uint64_t seed = derived_seed(options_.seed, 500 + static_cast<std::uint64_t>(s));
  return shape_fingerprints_[s] = ensemble_->fingerprint(shape, "shape " + std::to_string(s), seed);
}

}  // namespace lilytank
