#include "finder/model_selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "statistics/largest_first.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// Smallest amplitude tested, relative to the size of the fingerprint's experiments; smaller ones
// would be an extrapolation by more than ten.
constexpr double kLeastTried = 0.1, kTriedStep = 1.03;
// Largest unexplained share of the mismatch: where a remainder is significant, and where it exceeds
// kFarBeyond times that of nulls.
constexpr double kMostLeft = 0.5, kMuchLeft = 0.25, kFarBeyond = 2;

// Recomputes every candidate after a change of the whitening.
void whiten_by(Whitening whitening, SelectionState& state) {
  state.whitening = std::move(whitening);
  for (EffectCandidate& c : state.candidates) c = renewed(c, state.whitening, c.source);
}

// Length of a residual relative to that of nulls and of the fingerprint's noise; nulls are whitened
// by a covariance estimated without them.
double length(const SelectionState& s, const EffectCandidate& of, const Vector& residual,
              double noise) {
  const double square = (s.whitening.whitener * residual.head(s.whitening.named)).squaredNorm();
  return std::sqrt(std::max(0.0, square - s.thresholds.mean_misfit * noise) / of.scale);
}

}  // namespace

double penalized_deviance(double squared, const Matrix& whitener, Eigen::Index amplitudes) {
  return squared - 2 * whitener.diagonal().array().log().sum() +
         kAmplitudePrice * static_cast<double>(amplitudes);
}

ModelSelection::ModelSelection(const Matrix& nulls, const Matrix& expected_correlation,
                               const std::vector<Effect>& effects,
                               const std::vector<Fingerprint>& fingerprints, std::size_t curves,
                               double false_alarms) {
  SelectionState& s = state_;
  s.whitening = whitening_by_nulls(nulls, expected_correlation, curves);
  for (std::size_t e = 0; e < effects.size(); ++e) {
    s.terms.push_back(effects[e].paths[0]);
    s.between_modules.push_back(effects[e].variable == "pair");
    s.candidates.push_back(candidate_of(s.whitening, fingerprints[e], static_cast<int>(e), -1));
  }
  NullCalibration nothing = calibrate_on_nulls(nulls, s.whitening, s.candidates, false_alarms);
  for (std::size_t k = 0; k < s.candidates.size(); ++k) {
    s.candidates[k].scale = nothing.scale[k], s.candidates[k].scale_all = nothing.scale_all[k];
  }
  s.shape_scale = std::move(nothing.shape_scale);
  s.thresholds = nothing.thresholds;
}

void ModelSelection::inflate_covariance(const Vector& variance) {
  whiten_by(with_variance(state_.whitening, variance), state_);
}

void ModelSelection::inflate_by_scatter(const Matrix& scatter) {
  whiten_by(with_scatter(state_.whitening, scatter), state_);
}

SingleFit ModelSelection::fit_alone(const Vector& residual, int effect, int shape) const {
  const Whitening& w = state_.whitening;
  const EffectCandidate& of = state_.candidates[place_of(state_.candidates, effect, shape)];
  const Matrix whitener = w.whitener_by(of.source.scatter);
  const Matrix change = whitener * lower_inverse(w.whitener);
  ResponseModel own = of.named;
  own.base = change * own.base, own.first = change * own.first, own.second = change * own.second;
  ResponseFit fit = fit_response(own, whitener * (residual - w.centre).head(w.named));
  const double squared = fit.left.squaredNorm();
  const Eigen::Index amplitudes = fit.amplitudes.size();
  return {std::move(fit.amplitudes), penalized_deviance(squared, whitener, amplitudes)};
}

std::vector<EffectFit> ModelSelection::effects(const Vector& residual) const {
  const Vector all = state_.whitening.of(residual);
  std::vector<EffectFit> out;
  for (const EffectCandidate& c : state_.candidates) out.push_back(fit_of(c, all));
  largest_first(out, &EffectFit::z);
  return out;
}

std::vector<EffectFit> ModelSelection::shapes(const Vector& residual) const {
  const Whitening& w = state_.whitening;
  std::vector<EffectFit> out(w.curves());
  for (std::size_t s = 0; s < w.curves(); ++s) {
    out[s].shape = static_cast<int>(s);
    out[s].amplitudes = (residual - w.centre).segment(w.first_knot(s), kKnots);
    out[s].gain = (w.knot_whitener[s] * out[s].amplitudes).squaredNorm();
    out[s].z = z_of_gain(out[s].gain, state_.shape_scale[s], kKnots);
  }
  largest_first(out, &EffectFit::z);
  return out;
}

void ModelSelection::add_shape(int shape, const Fingerprint& fingerprint) {
  state_.candidates.push_back(candidate_of(state_.whitening, fingerprint, -1, shape));
}

void ModelSelection::set_fingerprint(const EffectFit& fit, const Fingerprint& fingerprint) {
  const std::size_t place = place_of(state_.candidates, fit.effect, fit.shape);
  if (place == state_.candidates.size()) return;
  EffectCandidate& own = state_.candidates[place];
  own = renewed(own, state_.whitening, fingerprint);
}

double ModelSelection::confidence(const EffectFit& fit) const {
  const NullThresholds& t = state_.thresholds;
  return 1 - (fit.effect >= 0 ? t.largest_effect : t.largest_shape).chance_beyond(fit.z);
}

bool ModelSelection::fails(const SelectedModel& m) const {
  const double far = m.misfit / misfit_threshold();
  return (far > 1 && m.share_left > kMostLeft) || (far > kFarBeyond && m.share_left > kMuchLeft);
}

double ModelSelection::baseline_misfit(const Vector& residual) const {
  return state_.whitening.misfit(residual);
}

// The noise of a fingerprint reduces the detectable share of its effect. Below the sizes at which
// it was measured it scales with the same power.
double ModelSelection::smallest_detectable(int effect) const {
  const EffectCandidate& of = state_.candidates[place_of(state_.candidates, effect, -1)];
  const auto least = [&](const Vector& one) {
    const double z = expected_z(effect, one);
    const double noise = state_.thresholds.mean_misfit * of.source.noise_at(one) / of.scale;
    for (double size = kLeastTried; size < kLearnedSize; size *= kTriedStep) {
      const double own = z * std::pow(size, of.source.growth);
      if (own * own > effect_threshold() * std::sqrt(own * own + noise * size * size)) return size;
    }
    return std::numeric_limits<double>::infinity();
  };
  double out = 0;
  for (Eigen::Index c = 0; c < of.named.about.size(); ++c) {
    const Vector one = Vector::Unit(of.named.about.size(), c);
    out = std::max(out, least(one));
    if (of.named.two_sided) out = std::max(out, least(-one));
  }
  return out;
}

double ModelSelection::expected_z(int effect, const Vector& amplitudes) const {
  const EffectCandidate& of = state_.candidates[place_of(state_.candidates, effect, -1)];
  // Second-order terms hold within the measured sizes; beyond, they grow linearly.
  const double beyond = std::max(1.0, amplitudes.cwiseAbs().maxCoeff() / kLearnedSize);
  const Vector within = amplitudes / beyond;
  return beyond * length(state_, of, of.source.at(within), of.source.noise_at(within));
}

double ModelSelection::expected_z(int effect, const Vector& change, int experiments) const {
  if (effect < 0) return shapes(state_.whitening.centre + change).front().z;
  const EffectCandidate& of = state_.candidates[place_of(state_.candidates, effect, -1)];
  return length(state_, of, change, 1.0 / experiments);
}

}  // namespace lilytank
