#include "finder/fitted_model.hpp"

#include <algorithm>
#include <cmath>

#include "calibrate/fit_conditions.hpp"
#include "finder/found_effect.hpp"
#include "finder/joint.hpp"
#include "finder/show.hpp"
#include "lilytank/model_parameter.hpp"
#include "lilytank/random.hpp"
#include "statistics/undefined.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

using Vector = Eigen::VectorXd;

constexpr double kMovedError = 0.3;  // share by which such a displacement may be wrong
constexpr double kRounding = 0.1;    // nat, of predictions in single precision

// The elements of a list at ascending indices.
template <class T>
void keep_only(const std::vector<std::size_t>& kept, std::vector<T>& list) {
  std::vector<T> out;
  for (const std::size_t k : kept) out.push_back(std::move(list[k]));
  list = std::move(out);
}

// Overlay with the fitted model for the experiment's tank.
std::string overlay_of(const CalibrationSetup& setup, const std::vector<JointEffect>& found,
                       const Diagnosis& d) {
  std::vector<std::string> fitted;
  for (const DiagnosisFinding& f : d.findings) {
    for (const FoundParameter& p : f.parameters) fitted.push_back(p.path);
  }
  ScenarioText out =
      begun_overlay("Effects that the recordings of " + setup.name +
                        " support, found by lilytank diagnose. An overlay of a scenario:\n"
                        "  lilytank run scenarios/tank_lilies.toml missing.toml",
                    fit_conditions(setup.model, BodyKind::lily, fitted), setup.flow.has_value());
  for (const MovedParameter& p : d.parameters) out.number(p.path, p.with_effects);
  for (std::size_t e = 0; e < found.size(); ++e) {
    const Effect& effect = found[e].effect;
    if (effect.curve) {
      for (const auto& [of, value] : effect.held) out.number(of.path(), value);
    }
    for (const FoundParameter& p : d.findings[e].parameters) {
      out.number(p.path, p.value, shortest(p.low) + " .. " + shortest(p.high));
    }
  }
  return out.text();
}

void report_camera(const CalibrationSetup& setup, const std::vector<double>& values,
                   Diagnosis& out) {
  for (std::size_t i = setup.reported_count(); i < setup.parameters.size(); ++i) {
    out.checks.push_back(setup.parameters[i].path + " = " + significant(values[i], 3) + " " +
                         setup.parameters[i].unit + ", fitted along");
  }
}

void report_parameters(const CalibrationSetup& setup, const JointFit& fit,
                       const std::vector<JointEffect>& found, Diagnosis& out) {
  for (std::size_t i = 0; i < out.parameters.size(); ++i) {
    out.parameters[i].with_effects = fit.value[i];
    out.parameters[i].low = fit.low[i], out.parameters[i].high = fit.high[i];
  }
  std::size_t at = setup.parameters.size();
  for (std::size_t e = 0; e < found.size(); ++e) {
    const Effect& effect = found[e].effect;
    const std::size_t count = effect.paths.size() + effect.refine.size();
    for (std::size_t k = 0; k < count; ++k, ++at) {
      const FitParameter& p = fit.parameters[at];
      out.findings[e].parameters.push_back(
          {own_name(p.path), p.path, fit.value[at], fit.low[at], fit.high[at], p.unit});
    }
    for (const auto& [of, value] : effect.held) {
      const std::string path = of.path();
      const bool refined = std::any_of(effect.refine.begin(), effect.refine.end(),
                                       [&](const FitParameter& r) { return r.path == path; });
      if (refined || effect.curve) continue;
      out.findings[e].parameters.push_back({own_name(path), path, value, value, value, ""});
    }
    if (effect.curve) {
      for (int k = 0; k < kKnots; ++k) {
        out.findings[e].curve.value[static_cast<std::size_t>(k)] =
            out.findings[e].parameters[static_cast<std::size_t>(k)].value;
      }
    }
  }
  out.overlay = overlay_of(setup, found, out);
}

// Where the joint fit begins. A place is found with its amplitudes, one step ahead: those by scores
// about the places of the catalogue may be far too small.
Vector likeliest_amplitudes(const Effect& effect, const EffectFit& f, const ScoreDetails& details) {
  if (f.effect < 0) return f.amplitudes;
  const auto direct = scanned(effect, details);
  const bool clearer = direct && direct->amplitudes && direct->amplitudes->gain > f.gain;
  return clearer ? direct->amplitudes->estimate : f.amplitudes;
}

// A fitted model without what was found, its other parameters kept.
Model without_effects(const Model& fitted, const Model& baseline,
                      const std::vector<JointEffect>& found) {
  std::vector<std::string> paths;
  std::vector<double> absent;
  for (const JointEffect& one : found) {
    for (std::size_t c = 0; c < one.effect.paths.size(); ++c) {
      if (of_camera(one.effect.paths[c])) continue;
      paths.push_back(one.effect.paths[c]), absent.push_back(one.effect.absent(baseline, c));
    }
  }
  return with_parameters(fitted, paths, absent);
}

// `baseline`: its calibration to these recordings.
void show(PreparedTank& tank, const JointFit& fit, const std::vector<JointEffect>& found,
          const std::vector<double>& before, const Vector& baseline,
          const std::vector<Recording>& recordings, Diagnosis& out) {
  const CalibrationSetup& setup = tank.setup.calibration;
  const Stages& stages = tank.setup.stages;
  const ScorePlan& plan = tank.ensemble.plan();
  std::vector<RecordingShape> shapes;
  for (const Recording& one : recordings) {
    shapes.push_back(shape_of(one, setup.model.module.side));
  }
  std::vector<std::string> paths;
  for (const FitParameter& p : fit.parameters) paths.push_back(p.path);
  const Emulator with(fit.model, paths, shapes, {.moment_matched = false});
  const auto b =
      repeat(stages, tank.maps, setup.emulator(shapes, CalibrationSetup::Of::experiments), before,
             tank.setup.budget.comparisons, derived_seed(tank.setup.options.seed, 801));
  const auto a = repeat(stages, tank.maps, with, fit.value, tank.setup.budget.comparisons,
                        derived_seed(tank.setup.options.seed, 802));
  out.held_out = group_fits(setup, plan, recordings, b, a);
  msd_share(recordings, b, a, setup.piece, out);
  std::vector<std::string> kept;
  std::vector<double> values;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (of_camera(paths[i])) continue;
    kept.push_back(paths[i]), values.push_back(fit.value[i]);
  }
  const Model after = with_parameters(fit.model, kept, values);
  const auto gain_over = [&](const Model& without) {
    return step_gain(without, after, plan.predictor, recordings);
  };
  // Eddies, noise, bonds and the camera do not change what is expected one step ahead: the gain
  // would be that of the parameters fitted along.
  if (std::fabs(gain_over(without_effects(after, setup.model, found)).gain) < kRounding) {
    for (DiagnosisFinding& f : out.findings) f.gain = f.gain_low = f.gain_high = kUndefined;
    return;
  }
  // Compared with the better of two baselines: under a strong omitted effect a calibration can be
  // worse than the start.
  const StepGain by_plan = gain_over(plan.model);
  const StepGain by_own = gain_over(tank.baseline_at(baseline));
  const StepGain& gain = by_own.gain < by_plan.gain ? by_own : by_plan;
  for (DiagnosisFinding& f : out.findings) {
    f.gain = gain.gain, f.gain_low = gain.low, f.gain_high = gain.high;
  }
  if (gain.high >= 0) return;
  out.warnings.push_back(
      likelier_but_for_errors(plan, after, recordings)
          ? "one step ahead, errors of the baseline's parameters cost more than what was found "
            "gains; allowing for these, it does predict recordings that had no part in this better"
          : "one step ahead, what was found predicts recordings that had no part in this worse "
            "than nothing does: the name or its law is doubtful");
}

}  // namespace

std::vector<double> report_baseline(const PreparedTank& tank, const Judged& judged,
                                    Diagnosis& out) {
  const CalibrationSetup& setup = tank.setup.calibration;
  const Stages& stages = tank.setup.stages;
  const Vector& summary = judged.observed.summary;
  std::vector<double> alone = stages.from_scale(tank.ensemble.nearest(summary).point);
  for (std::size_t i = 0; i < setup.reported_count(); ++i) {
    MovedParameter& p = out.parameters.emplace_back();
    p.path = setup.parameters[i].path, p.unit = setup.parameters[i].unit;
    p.baseline = p.with_effects = alone[i];
    p.deviation = tank.baseline.deviation(static_cast<Eigen::Index>(i));
  }
  // Where the baseline does not explain the recordings, its bias is unknown.
  if (out.verdict != Verdict::complete) return alone;
  const FitBounds bounds = stages.bounds();
  const ParameterEstimate posterior = tank.ensemble.posterior(
      summary, {stages.to_scale(setup.start), kPrior * (bounds.high - bounds.low)});
  for (std::size_t i = 0; i < setup.reported_count(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const FitParameter& of = setup.parameters[i];
    const double middle = posterior.estimate(k), half = posterior.wide * posterior.deviation(k);
    const auto within = [&](double at) { return std::clamp(of.from_scale(at), of.low, of.high); };
    MovedParameter& p = out.parameters[i];
    p.with_effects = within(middle), p.low = within(middle - half), p.high = within(middle + half);
  }
  return alone;
}

void fit_findings(PreparedTank& tank, const Judged& judged, const std::vector<Recording>& held_out,
                  Diagnosis& out) {
  const CalibrationSetup& setup = tank.setup.calibration;
  Stages& stages = tank.setup.stages;
  const SelectedModel& e = judged.selected;
  const Vector baseline = tank.ensemble.calibrated(judged.observed.summary);
  const std::vector<double> before = report_baseline(tank, judged, out);
  if (out.verdict != Verdict::missing) {
    report_camera(setup, before, out);
    return;
  }
  std::vector<JointEffect> found;
  // The calibrated baseline less the effects' shift of it.
  Vector moved = Vector::Zero(baseline.size());
  for (const EffectFit& f : e.found) {
    moved += f.moved;
    const Effect effect = found_effect(tank.ensemble.plan(), f, judged.details);
    found.push_back({effect, likeliest_amplitudes(effect, f, judged.details), f.shape});
  }
  const FitBounds bounds = stages.bounds();
  const JointStart start{stages.to_scale(setup.start),
                         (baseline - moved).cwiseMax(bounds.low).cwiseMin(bounds.high),
                         tank.spread.diagonal().cwiseMax(kMovedError * moved.cwiseAbs())};
  const JointFit fit =
      fit_jointly(stages, tank.maps, tank.ensemble, found, judged.recordings, start,
                  {tank.setup.budget.round, tank.selection.effect_threshold(), judged.tag,
                   derived_seed(tank.setup.options.seed, 700)});
  if (!fit.settled) {
    out.warnings.push_back("the joint fit had not settled: its intervals may be too short");
  }
  keep_only(fit.kept, out.findings), keep_only(fit.kept, found);
  report_camera(setup, fit.value, out);
  report_parameters(setup, fit, found, out);
  show(tank, fit, found, before, baseline.cwiseMax(bounds.low).cwiseMin(bounds.high), held_out,
       out);
}

}  // namespace lilytank
