// What is suspected: an effect as recordings tell it directly, where its experiments are to be.
#include <algorithm>
#include <cmath>
#include <optional>

#include "diagnose/diagnoser.hpp"
#include "lilytank/random.hpp"
#include "statistics/linear.hpp"
#include "statistics/text_table.hpp"

namespace lilytank {
namespace {

using Vector = Eigen::VectorXd;

}  // namespace

const Effect& Diagnoser::effect(const EffectFit& f) const {
  return atlas_->plan().effects[static_cast<std::size_t>(f.effect)];
}

std::optional<Diagnoser::Scanned> Diagnoser::scanned(const Effect& effect,
                                                     const ScoreDetails& details) const {
  if (effect.name == "local_flow") {
    const StreamPlace& s = details.scans.stream;
    return Scanned{stream_effect(setup_.model, s.x, s.y, s.width).shape,
                   JointAmplitudes{Eigen::Vector2d(s.speed_x, s.speed_y), s.gain}};
  }
  if (effect.name == "vortex_shedding" && details.swinging > 0) {
    return Scanned{{{effect.shape[0].first, details.swinging}}, std::nullopt};
  }
  const bool repels = effect.name == "pair_repulsion";
  const auto told = details.scans.values.find(repels ? "pair_attraction" : effect.name);
  if (told == details.scans.values.end()) return std::nullopt;
  const double amplitude = repels ? -told->second.amplitude : told->second.amplitude;
  if (!effect.two_sided && !(amplitude > 0)) return std::nullopt;
  return Scanned{{{effect.shape[0].first, told->second.value}}, std::nullopt};
}

Effect Diagnoser::found_effect(const EffectFit& f, const ScoreDetails& details) const {
  if (f.effect < 0) return effect_of(atlas_->plan().shapes[static_cast<std::size_t>(f.shape)]);
  Effect out = effect(f);
  if (out.name == "flow_pulsation") {
    out.shape = {{"forces.flow_pulsation.frequency", details.pulsation}};
  }
  if (const auto told = scanned(out, details)) out.shape = told->shape;
  for (auto& [path, value] : out.shape) {
    const auto better = details.refined.find(path);
    if (better != details.refined.end()) value = better->second;
  }
  if (out.name == "heterogeneous_module") {
    out.shape = {{"forces.heterogeneous_module.module", static_cast<double>(details.heaviest)}};
  }
  return out;
}

// Experiments with pumps of nearly one frequency serve each other.
std::string Diagnoser::stage_name(const EffectFit& f, const ScoreDetails& details) const {
  if (f.effect < 0) return "shape " + std::to_string(f.shape);
  const std::string out = "effect " + std::to_string(f.effect);
  const std::string& name = effect(f).name;
  if (name == "flow_pulsation") return out + " at " + fixed(details.pulsation, 1) + " Hz";
  const auto shape = found_effect(f, details).shape;
  const bool own = std::any_of(shape.begin(), shape.end(), [&](const auto& one) {
    return details.refined.count(one.first) > 0;
  });
  if (!own && !scanned(effect(f), details)) return out;
  std::string place = name;
  for (const auto& [path, value] : shape) place += " " + fixed(value, 4);
  return place;
}

const Fingerprint& Diagnoser::shape_fingerprint(int s) {
  const auto known = shape_fingerprints_.find(s);
  if (known != shape_fingerprints_.end()) return known->second;
  const Effect shape = effect_of(atlas_->plan().shapes[static_cast<std::size_t>(s)]);
  const std::uint64_t seed = derived_seed(options_.seed, 500 + static_cast<std::uint64_t>(s));
  return shape_fingerprints_[s] = atlas_->fingerprint(shape, "shape " + std::to_string(s), seed);
}

// The fingerprint about the amplitudes that were found, in the place of the one before.
Fingerprint Diagnoser::fingerprint_near(const EffectFit& f, const Fingerprint& before,
                                        const Judged& judged, LearnedFingerprints& learned,
                                        int experiments) {
  return atlas_->fingerprint_about(f.amplitudes, before, found_effect(f, judged.details),
                                   atlas_->calibrated(judged.observed.summary),
                                   stage_name(f, judged.details), learned, experiments);
}

}  // namespace lilytank
