#include "finder/place_test.hpp"

#include "finder/null_thresholds.hpp"
#include "finder/scan.hpp"
#include "scores/scores.hpp"
#include "statistics/largest_first.hpp"

namespace lilytank {
namespace {

constexpr int kNullScans = 60;  // that the threshold rests on

// The effect and place of the grid with the largest z.
EffectFit clearest_place(const ScorePlan& plan, const std::vector<Recording>& recordings) {
  EffectFit out;
  for (const LinearPlaces& one : linear_places(plan, recordings)) {
    const auto components = static_cast<Eigen::Index>(one.effect->paths.size());
    for (const FoundPlace& place : one.places) {
      const double z = z_of_gain(place.gain, 1, components);
      if (out.effect >= 0 && z <= out.z) continue;
      out.effect = static_cast<int>(one.effect - plan.effects.data());
      out.amplitudes = Eigen::VectorXd::Map(place.amplitudes.data(), components);
      out.gain = place.gain, out.z = z;
    }
  }
  return out;
}

std::vector<EffectFit> effects_without_place(const ScorePlan& plan,
                                             const std::vector<Recording>& recordings) {
  std::vector<Effect> tried;
  std::vector<EffectFit> out;
  for (std::size_t e = 0; e < plan.effects.size(); ++e) {
    const Effect& effect = plan.effects[e];
    if (!effect.mean_force || effect.estimated == Estimated::place) continue;
    tried.push_back(effect), out.emplace_back().effect = static_cast<int>(e);
  }
  const std::vector<JointAmplitudes> amplitudes = joint_amplitudes(plan, recordings, tried);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const JointAmplitudes& of = amplitudes[k];
    const bool possible = tried[k].two_sided || of.estimate.minCoeff() > 0;
    out[k].amplitudes = of.estimate, out[k].gain = possible ? of.gain : 0;
  }
  largest_first(out, &EffectFit::gain);
  return out;
}

}  // namespace

std::optional<PlaceFinding> find_clear_place(const ReferenceEnsemble& ensemble,
                                             const std::vector<Recording>& recordings,
                                             double least_z, double false_alarms) {
  const ScorePlan& plan = ensemble.plan();
  PlaceFinding out{clearest_place(plan, recordings), 0, 0, {}};
  if (!(out.fit.z > least_z)) return std::nullopt;
  out.others = effects_without_place(plan, recordings);
  if (!out.others.empty() && out.others[0].gain > out.fit.gain + kSameGain) return std::nullopt;
  const auto rows = ensemble.further_nulls("places", kNullScans, [&plan](const auto& of) {
    return std::vector<double>{clearest_place(plan, of).z};
  });
  std::vector<double> largest;
  for (const std::vector<double>& row : rows) largest.insert(largest.end(), row.begin(), row.end());
  const ExtremeLaw law(largest);
  out.threshold = law.exceeded_with(false_alarms);
  out.confidence = 1 - law.chance_beyond(out.fit.z);
  if (!(out.fit.z > out.threshold)) return std::nullopt;
  return out;
}

}  // namespace lilytank
