#include "finder/judgement.hpp"

#include <algorithm>

#include "finder/found_effect.hpp"
#include "finder/refinement.hpp"
#include "finder/score_sensitivity.hpp"
#include "finder/selection_report.hpp"
#include "text/fnv.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

using Vector = Eigen::VectorXd;

// Share of the largest z of the named effects that a remaining curve must exceed to be tested.
constexpr double kCurveTested = 0.15;

std::uint64_t fnv_of(const Vector& numbers) {
  Fnv hash;
  hash.add(std::span(numbers.data(), static_cast<std::size_t>(numbers.size())));
  return hash.value();
}

// Named effects first; a shape is tried where they leave a significant remainder.
SelectedModel explained(ReferenceEnsemble& ensemble, ModelSelection& selection,
                        ScoreSensitivity& sensitivity, const Vector& residual) {
  const ScorePlan& plan = ensemble.plan();
  SelectedModel e = selection.select(residual);
  const std::vector<EffectFit> shapes = selection.shapes(residual);
  std::vector<int> tested;
  if (shapes[0].z > selection.shape_threshold() &&
      (e.found.empty() || shapes[0].z > e.found[0].z)) {
    tested.push_back(shapes[0].shape);
  }
  double largest = 0;
  for (const EffectFit& f : e.found) largest = std::max(largest, f.z);
  if (e.left_shape.z > std::max(selection.shape_threshold(), kCurveTested * largest)) {
    if (tested.empty() || tested[0] != e.left_shape.shape) tested.push_back(e.left_shape.shape);
  }
  // A large remainder may be another law of the same variable.
  if (!e.found.empty() && e.found[0].effect >= 0 && e.misfit > selection.misfit_threshold()) {
    const std::string& variable = effect_in(plan, e.found[0]).variable;
    const auto same = std::find_if(shapes.begin(), shapes.end(), [&](const EffectFit& f) {
      return plan.shapes[static_cast<std::size_t>(f.shape)].variable == variable;
    });
    if (same != shapes.end() &&
        std::find(tested.begin(), tested.end(), same->shape) == tested.end()) {
      tested.push_back(same->shape);
    }
  }
  for (const int s : tested) {
    const Effect curve = effect_of(plan.shapes[static_cast<std::size_t>(s)]);
    selection.add_shape(s, sensitivity.aligned(ensemble.shape_fingerprint(s), curve));
  }
  return tested.empty() ? e : selection.select(residual);
}

}  // namespace

Judged judge(PreparedTank& tank, const std::vector<Recording>& recordings, Diagnosis& out) {
  MeasuredVectors measured;
  measured.observed = tank.ensemble.vectors(recordings, &measured.details);
  return judge(tank, std::move(measured), recordings, out);
}

Judged judge(PreparedTank& tank, MeasuredVectors measured, const std::vector<Recording>& recordings,
             Diagnosis& out) {
  ReferenceEnsemble& ensemble = tank.ensemble;
  const Vector residual = ensemble.residual(measured.observed);
  ModelSelection selection = tank.selection;
  ScoreSensitivity sensitivity(ensemble, recordings);
  selection.inflate_covariance(sensitivity.further_variance());
  const std::vector<Effect>& effects = ensemble.plan().effects;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    EffectFit of;
    of.effect = static_cast<int>(e);
    selection.set_fingerprint(of, sensitivity.aligned(ensemble.fingerprints()[e], effects[e]));
  }
  SelectedModel first = explained(ensemble, selection, sensitivity, residual);
  const DiagnosisOptions& options = tank.setup.options;
  const Model calibrated = tank.baseline_at(ensemble.calibrated(measured.observed.summary));
  RefinedSelection r = refined_selection(
      {ensemble, sensitivity, measured.observed, calibrated, residual,
       tank.selection.baseline_misfit(residual), options.false_alarms, options.threads},
      {std::move(first), std::move(selection), std::move(measured.details)});
  std::vector<EffectFit> open = report_selection(ensemble, r, residual, options.false_alarms, out);
  std::string tag = hex(fnv_of(measured.observed.scores));
  return {recordings,           std::move(measured.observed),
          std::move(r.details), std::move(r.model),
          std::move(open),      std::move(tag)};
}

}  // namespace lilytank
