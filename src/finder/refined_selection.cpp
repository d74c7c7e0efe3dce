// Selection with the scatter of experiments that contain the best candidate.
#include <algorithm>

#include "finder/refinement.hpp"

namespace lilytank {
namespace {

constexpr int kMostCentred = 2;
constexpr double kNamesFirst = 30;  // of a penalised deviance
constexpr double kCurveLeft = 0.4;  // of what was found, that a curve may be which remains
constexpr double kLeastOwn = 1;     // z of an effect by the scatter of experiments with it

}  // namespace

std::optional<EffectFit> Refinement::likeliest(bool effects_only,
                                               const std::string& variable) const {
  std::optional<EffectFit> out;
  double least = 0;
  for (const auto& [id, one] : state_.refined) {
    const bool curve = id.first < 0;
    if (curve && effects_only) continue;
    if (!curve && !variable.empty() && effect(id).variable != variable) continue;
    const double deviance = one.alone.penalized_deviance + (curve ? kNamesFirst : 0);
    if (out && !(deviance < least)) continue;
    least = deviance;
    out = fit_with(id, one.alone.amplitudes);
  }
  return out;
}

SelectedModel Refinement::selected() {
  for (int pass = 0; pass < kMostCentred; ++pass) {
    bool moved = false;
    for (const bool effects_only : {false, true}) {
      const std::optional<EffectFit> likely = likeliest(effects_only);
      if (!likely || !off_centre(*likely, kBeside)) continue;
      refine_fingerprint(*likely, refined(*likely)->fingerprint.experiments), moved = true;
    }
    if (!moved) break;
  }
  const std::optional<EffectFit> likely = likeliest();
  if (likely) {
    state_.selection.inflate_by_scatter(refined(*likely)->fingerprint.scatter);
  }
  return selected_by(state_.selection);
}

SelectedModel Refinement::selected_by(const ModelSelection& selection) const {
  const std::optional<EffectFit> likely = likeliest();
  SelectedModel e = selection.select(residual_);
  if (e.found.empty() && likely && baseline_misfit_ > selection.misfit_threshold()) {
    return at_least(selection, likeliest(true).value_or(*likely));
  }
  if (!likely || likely->shape >= 0 || is_found(*likely, e)) return e;
  SelectedModel other = selection.select(residual_, {*likely});
  if (leaves_curve(selection, other) && !selection.leaves_residual(e)) return e;
  return other.penalized_deviance < e.penalized_deviance ? other : e;
}

SelectedModel Refinement::at_least(const ModelSelection& selection, const EffectFit& likely) const {
  SelectedModel e = selection.select(residual_, {likely});
  if (e.found.empty() || e.found[0].z < kLeastOwn) {
    e.found.clear(), e.inexact = 0, e.misfit = baseline_misfit_, e.share_left = 1;
  }
  return e;
}

bool Refinement::leaves_curve(const ModelSelection& selection, const SelectedModel& e) const {
  double largest = 0;
  for (const EffectFit& f : e.found) largest = std::max(largest, f.z);
  return e.left_shape.z > std::max(selection.shape_threshold(), kCurveLeft * largest);
}

bool Refinement::is_found(const EffectFit& f, const SelectedModel& e) const {
  return std::any_of(e.found.begin(), e.found.end(),
                     [&](const EffectFit& other) { return id_of(other) == id_of(f); });
}

}  // namespace lilytank
