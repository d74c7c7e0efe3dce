#include "finder/clear_place.hpp"

#include "finder/null_thresholds.hpp"
#include "finder/scan.hpp"
#include "scores/scores.hpp"
#include "statistics/largest_first.hpp"

namespace lilytank {
namespace {

using Vector = Eigen::VectorXd;

constexpr int kNullScans = 40;  // that the threshold rests on

// Every effect that has a place at every place of the grid.
struct ScannedPlaces {
  std::vector<EffectFit> fits;  // without z
  Vector gains, freedom;

  ScannedPlaces(const ScorePlan& plan, const std::vector<Recording>& recordings) {
    for (const LinearPlaces& one : linear_places(plan, recordings)) {
      for (const FoundPlace& place : one.places) {
        const auto size = static_cast<Eigen::Index>(place.amplitudes.size());
        EffectFit& fit = fits.emplace_back();
        fit.effect = static_cast<int>(one.effect - plan.effects.data());
        fit.amplitudes = Vector::Map(place.amplitudes.data(), size), fit.gain = place.gain;
      }
    }
    gains.resize(std::ssize(fits)), freedom.resize(std::ssize(fits));
    for (Eigen::Index k = 0; k < gains.size(); ++k) {
      const EffectFit& fit = fits[static_cast<std::size_t>(k)];
      gains(k) = fit.gain, freedom(k) = static_cast<double>(fit.amplitudes.size());
    }
  }

  // The place with the largest z of these gains, of every effect in turn. `mean`: of gains in
  // nulls. Errors of the flow that are rougher than the balls show raise all gains, most where
  // balls rarely were.
  std::vector<EffectFit> clearest(const Vector& of, const Vector& mean) const {
    std::vector<EffectFit> out;
    for (Eigen::Index k = 0; k < of.size(); ++k) {
      const EffectFit& fit = fits[static_cast<std::size_t>(k)];
      const double scale = std::max(kLeastScale, mean(k) / freedom(k));
      const double z = z_of_gain(of(k), scale, fit.amplitudes.size());
      if (out.empty() || out.back().effect != fit.effect) out.push_back(fit), out.back().z = z;
      if (z > out.back().z) out.back() = fit, out.back().z = z;
    }
    return out;
  }
};

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
  const ScannedPlaces seen(plan, recordings);
  if (seen.fits.empty()) return std::nullopt;
  const auto by_chi_squared = seen.clearest(seen.gains, seen.freedom);
  if (!(std::ranges::max(by_chi_squared, {}, &EffectFit::z).z > least_z)) return std::nullopt;
  const Eigen::MatrixXd nulls =
      ensemble.further_nulls("places", kNullScans, [&plan](const auto& of_null) {
        const Vector gains = ScannedPlaces(plan, of_null).gains;
        return std::vector<double>(gains.begin(), gains.end());
      });
  const Vector sum = nulls.colwise().sum();
  const auto n = static_cast<double>(nulls.rows());
  const std::vector<EffectFit> found = seen.clearest(seen.gains, sum / n);
  std::vector<std::vector<double>> largest(found.size());
  for (Eigen::Index i = 0; i < nulls.rows(); ++i) {
    const Vector own = nulls.row(i).transpose();
    const std::vector<EffectFit> of_null = seen.clearest(own, (sum - own) / (n - 1));
    for (std::size_t e = 0; e < found.size(); ++e) largest[e].push_back(of_null[e].z);
  }
  PlaceFinding out;
  double gain = 0;
  // Errors of the flow imitate streams far more than patches: each has a threshold of its own.
  for (std::size_t e = 0; e < found.size(); ++e) {
    const ExtremeLaw law(largest[e]);
    const double threshold = law.exceeded_with(false_alarms / static_cast<double>(found.size()));
    if (!(found[e].z > threshold)) continue;
    out.clear.push_back({found[e], threshold, 1 - law.chance_beyond(found[e].z)});
    gain = std::max(gain, found[e].gain);
  }
  if (out.clear.empty()) return std::nullopt;
  out.others = effects_without_place(plan, recordings);
  if (!out.others.empty() && out.others[0].gain > gain + kSameGain) return std::nullopt;
  return out;
}

}  // namespace lilytank
