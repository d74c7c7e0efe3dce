#include "finder/naming.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "calibrate/design.hpp"
#include "statistics/linear.hpp"
#include "statistics/quantiles.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kNullFolds = 20;
constexpr double kLeastShrinkage = 0.02;
constexpr Eigen::Index kLeastScatter = 4;
constexpr double kExcessAside = 0.1;  // of an excess, that is not along what few experiments show
constexpr double kByChance = 2;  // deviations of a variance that few experiments show of nothing
constexpr double kEulerGamma = 0.57721566490153286;
// Of an effect's sizes: what is claimed of less than a tenth of what was learned would be a guess.
constexpr double kLeastTried = 0.1, kTriedStep = 1.03;

// Shrunk correlations of columns, times deviations.
Matrix shrunk_covariance(const Matrix& off, const Vector& deviation) {
  const Vector own = (off.colwise().squaredNorm() / static_cast<double>(off.rows()))
                         .cwiseSqrt()
                         .cwiseMax(1e-9)
                         .transpose();
  const Matrix z = off * own.cwiseInverse().asDiagonal();
  return deviation.asDiagonal() * shrunk_correlations(z, kLeastShrinkage) * deviation.asDiagonal();
}

Matrix inverse_root(const Matrix& covariance) {
  return lower_inverse(lower_root(covariance));
}

// A covariance with the scatter of few experiments as far as it is more than these show of nothing.
Matrix loosened_by(const Matrix& own, const Matrix& off) {
  const auto n = static_cast<double>(off.rows());
  const double chance = 1 + kByChance * std::sqrt(2 / n);
  const Vector square = off.colwise().squaredNorm().transpose() / n;
  const Vector excess = (square - chance * own.diagonal()).cwiseMax(0).cwiseSqrt();
  // Most of it is along the few directions of parameters, which the experiments themselves show.
  const Vector share = excess.cwiseQuotient(square.cwiseSqrt().cwiseMax(1e-9));
  const Matrix along = off * share.asDiagonal();
  const Vector aside = std::sqrt(kExcessAside) * excess;
  return own + (1 + 1 / n) / n * (along.transpose() * along) +
         Matrix(aside.cwiseAbs2().asDiagonal());
}

}  // namespace

ExtremeLaw::ExtremeLaw(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double square = 0;
  for (const double v : values) mean_ += v / n;
  for (const double v : values) square += (v - mean_) * (v - mean_) / (n - 1);
  scale_ = std::sqrt(6 * square) / kPi;
}

double ExtremeLaw::exceeded_with(double probability) const {
  return mean_ + scale_ * (-std::log(-std::log(1 - probability)) - kEulerGamma);
}

double ExtremeLaw::chance_beyond(double value) const {
  if (!(scale_ > 0)) return value < mean_ ? 1 : 0;
  return -std::expm1(-std::exp(-((value - mean_) / scale_ + kEulerGamma)));
}

Naming::Naming(const Matrix& nulls, const Matrix& alike, const std::vector<Effect>& effects,
               const std::vector<Fingerprint>& fingerprints, std::size_t curves,
               double false_alarms)
    : named_(nulls.cols() - static_cast<Eigen::Index>(curves) * kKnots) {
  alike_ = Matrix::Identity(named_, named_);
  Matrix expected = alike;
  expected.diagonal().array() += kUnalike;
  if (alike.size() > 0) alike_.topLeftCorner(alike.rows(), alike.rows()) = lower_root(expected);
  centre_ = nulls.colwise().mean().transpose();
  covariance_ = covariance_of(nulls.leftCols(named_));
  whitener_ = inverse_root(covariance_);
  const auto n = static_cast<double>(nulls.rows());
  for (std::size_t s = 0; s < curves; ++s) {
    const Eigen::Index first = named_ + static_cast<Eigen::Index>(s) * kKnots;
    const Matrix block =
        nulls.middleCols(first, kKnots).rowwise() - centre_.segment(first, kKnots).transpose();
    knots_.emplace_back(block.transpose() * block / (n - 1));
    // Knots that are hardly ever visited are given too much deviation, not too little.
    knots_.back().diagonal() = knots_.back().diagonal().cwiseMax(1.0);
    root_.push_back(inverse_root(knots_.back()));
    shape_scale_.push_back(1);
  }
  for (std::size_t e = 0; e < effects.size(); ++e) {
    terms_.push_back(effects[e].paths[0]);
    known_.push_back(known(fingerprints[e], static_cast<int>(e), -1));
  }
  calibrate(nulls, false_alarms);
}

// Correlations of few experiments are drawn towards the expected ones: to none once these are taken
// out.
Matrix Naming::covariance_of(const Matrix& rows) const {
  const Matrix off = rows.rowwise() - rows.colwise().mean();
  const Matrix plain = off * lower_inverse(alike_).transpose();
  const Vector deviation = (plain.colwise().squaredNorm() / static_cast<double>(rows.rows()))
                               .cwiseSqrt()
                               .cwiseMax(1e-9)
                               .transpose();
  return alike_ * shrunk_covariance(plain, deviation) * alike_.transpose();
}

Naming::Known Naming::known(const Fingerprint& fingerprint, int effect, int shape) const {
  Known out;
  out.effect = effect, out.shape = shape, out.source = fingerprint;
  // A residual has deviation one; fingerprints about found amplitudes are known with a slope as
  // well, and their base is a mean.
  const auto n = static_cast<double>(std::max(1, fingerprint.experiments));
  const auto kept = [&](const Matrix& of, double e) {
    Matrix clear = of.unaryExpr([=](double v) { return std::fabs(v) < kNoisy * e ? 0.0 : v; });
    clear.topRows(fingerprint.exact) = of.topRows(fingerprint.exact);
    return clear;
  };
  const double error = fingerprint.local() ? 0 : 1 / std::sqrt(kLearnedSquare * n);
  out.learned = kept(fingerprint.first, error);
  out.all = {fingerprint.about, whitened(kept(fingerprint.base, 1 / std::sqrt(n))),
             whitened(out.learned), whitened(kept(fingerprint.second, error)),
             fingerprint.two_sided};
  out.named = out.all.top(named_);
  out.basis = out.all.first;
  return out;
}

// What is known of an effect in the place of what was, by the whitener that is now.
void Naming::renew(Known& of, const Fingerprint& fingerprint) const {
  const Matrix learned = of.learned;
  const double scale = of.scale, scale_all = of.scale_all;
  of = known(fingerprint, of.effect, of.shape);
  of.learned = learned, of.basis = whitened(learned);
  of.scale = scale, of.scale_all = scale_all;
}

// Columns of residuals, the named numbers and every shape's knots each by their covariance.
Matrix Naming::whitened(const Matrix& residuals) const {
  Matrix out(residuals.rows(), residuals.cols());
  out.topRows(named_) = whitener_ * residuals.topRows(named_);
  for (std::size_t s = 0; s < root_.size(); ++s) {
    const Eigen::Index first = named_ + static_cast<Eigen::Index>(s) * kKnots;
    out.middleRows(first, kKnots) = root_[s] * residuals.middleRows(first, kKnots);
  }
  return out;
}

double Naming::z_of(double gain, double scale, Eigen::Index freedom) const {
  return chi_squared_z(std::max(0.0, gain) / std::max(scale, 1e-9), static_cast<int>(freedom));
}

// Of the last one if there are several.
std::size_t Naming::place_of(int effect, int shape) const {
  std::size_t place = known_.size();
  for (std::size_t k = 0; k < known_.size(); ++k) {
    if (known_[k].effect == effect && known_[k].shape == shape) place = k;
  }
  return place;
}

EffectFit Naming::fitted(const Known& of, const Answer& answer, const Vector& data) {
  AnswerFit fit = fit_answer(answer, data);
  EffectFit out;
  out.effect = of.effect, out.shape = of.shape,
  out.about = of.source.local() ? of.source.experiments : 0;
  out.gain = data.squaredNorm() - fit.left.squaredNorm();
  out.at_reach = out.gain > 0 && answer.at_reach(fit.amplitudes);
  out.amplitudes = std::move(fit.amplitudes);
  return out;
}

// By the named numbers; how surely, by these or by all, whichever tell more. A curve's other knots
// overlap with its own.
EffectFit Naming::fit(const Known& of, const Vector& all) const {
  EffectFit out = fitted(of, of.named, all.head(named_));
  const Eigen::Index m = out.amplitudes.size();
  out.z = z_of(out.gain, of.scale, m);
  if (of.effect >= 0) {
    out.z = std::max(out.z, z_of(fitted(of, of.all, all).gain, of.scale_all, m));
  }
  return out;
}

EffectFit Naming::fit_shape(int shape, const Vector& knots) const {
  const auto s = static_cast<std::size_t>(shape);
  EffectFit out;
  out.shape = shape, out.amplitudes = knots;
  out.gain = (root_[s] * knots).squaredNorm();
  out.z = z_of(out.gain, shape_scale_[s], kKnots);
  return out;
}

// What effects and knots gain in each null, by the covariance of nulls that it had no part in.
Naming::NullGains Naming::gains_of(const Matrix& nulls) {
  const Eigen::Index n = nulls.rows();
  const Matrix whitener = whitener_;
  NullGains out;
  out.effects.resize(known_.size());
  out.knots.resize(n, static_cast<Eigen::Index>(root_.size()));
  for (int fold = 0; fold < kNullFolds; ++fold) {
    Matrix others(n - (n - fold + kNullFolds - 1) / kNullFolds, nulls.cols());
    Eigen::Index at = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (i % kNullFolds != fold) others.row(at++) = nulls.row(i);
    }
    whitener_ = inverse_root(covariance_of(others.leftCols(named_)));
    std::vector<Known> known = known_;
    for (Known& k : known) renew(k, Fingerprint(k.source));
    for (Eigen::Index i = fold; i < n; i += kNullFolds) {
      const Vector all = whitened(nulls.row(i).transpose() - centre_);
      out.misfits.push_back(all.head(named_).squaredNorm());
      for (std::size_t k = 0; k < known.size(); ++k) {
        out.effects[k].push_back({fitted(known[k], known[k].named, all.head(named_)).gain,
                                  fitted(known[k], known[k].all, all).gain});
      }
      for (Eigen::Index s = 0; s < out.knots.cols(); ++s) {
        out.knots(i, s) = all.segment(named_ + s * kKnots, kKnots).squaredNorm();
      }
    }
  }
  whitener_ = whitener;
  return out;
}

// Scales and thresholds by what nulls gain.
void Naming::calibrate(const Matrix& nulls, double false_alarms) {
  const Eigen::Index n = nulls.rows();
  const NullGains gains = gains_of(nulls);
  std::vector<double> largest_effect(static_cast<std::size_t>(n)), largest_shape = largest_effect;
  for (std::size_t k = 0; k < known_.size(); ++k) {
    Gains mean;
    for (const Gains& g : gains.effects[k]) {
      mean.named += g.named / static_cast<double>(n), mean.all += g.all / static_cast<double>(n);
    }
    const Eigen::Index m = known_[k].named.first.cols();
    // Of what cannot be negative half of the nulls gain nothing.
    const double freedom = static_cast<double>(m) * (known_[k].named.two_sided ? 1 : 0.5);
    known_[k].scale = std::max(0.5, mean.named / freedom);
    known_[k].scale_all = std::max(0.5, mean.all / freedom);
    for (std::size_t i = 0; i < gains.effects[k].size(); ++i) {
      const Gains& g = gains.effects[k][i];
      largest_effect[i] = std::max({largest_effect[i], z_of(g.named, known_[k].scale, m),
                                    z_of(g.all, known_[k].scale_all, m)});
    }
  }
  for (std::size_t s = 0; s < shape_scale_.size(); ++s) {
    const auto of = gains.knots.col(static_cast<Eigen::Index>(s));
    shape_scale_[s] = std::max(0.5, of.mean() / kKnots);
    for (std::size_t i = 0; i < largest_shape.size(); ++i) {
      largest_shape[i] = std::max(largest_shape[i],
                                  z_of(of(static_cast<Eigen::Index>(i)), shape_scale_[s], kKnots));
    }
  }
  const std::vector<double>& misfits = gains.misfits;
  largest_effect_ = ExtremeLaw(largest_effect), largest_shape_ = ExtremeLaw(largest_shape);
  effect_threshold_ = largest_effect_.exceeded_with(0.5 * false_alarms);
  shape_threshold_ = largest_shape_.exceeded_with(0.3 * false_alarms);
  misfit_threshold_ = ExtremeLaw(misfits).exceeded_with(0.2 * false_alarms);
  null_misfit_ = std::accumulate(misfits.begin(), misfits.end(), 0.0) / static_cast<double>(n);
}

Matrix Naming::whitener_by(const Matrix& scatter) const {
  if (scatter.rows() < kLeastScatter) return inverse_root(covariance_);
  const Matrix plain = lower_inverse(alike_);
  const Matrix own = plain * covariance_ * plain.transpose();
  return inverse_root(loosened_by(own, scatter.leftCols(named_) * plain.transpose())) * plain;
}

void Naming::widen(const Vector& variance) {
  covariance_.diagonal() += variance;
  whitener_ = inverse_root(covariance_);
  for (Known& k : known_) renew(k, Fingerprint(k.source));
}

void Naming::loosen(const Matrix& scatter) {
  if (scatter.rows() < kLeastScatter) return;
  whitener_ = whitener_by(scatter);
  for (std::size_t s = 0; s < root_.size(); ++s) {
    const Eigen::Index first = named_ + static_cast<Eigen::Index>(s) * kKnots;
    root_[s] = inverse_root(loosened_by(knots_[s], scatter.middleCols(first, kKnots)));
  }
  for (Known& k : known_) renew(k, Fingerprint(k.source));
}

Naming::Alone Naming::alone(const Vector& residual, int effect, int shape) const {
  const Known& of = known_[place_of(effect, shape)];
  const Matrix whitener = whitener_by(of.source.scatter);
  const Matrix change = whitener * lower_inverse(whitener_);
  const Answer own{of.named.about, change * of.named.base, change * of.named.first,
                   change * of.named.second, of.named.two_sided};
  AnswerFit fit = fit_answer(own, whitener * (residual - centre_).head(named_));
  const double left = fit.left.squaredNorm();
  const Eigen::Index amplitudes = fit.amplitudes.size();
  return {std::move(fit.amplitudes), doubt(left, whitener, amplitudes)};
}

// What scatters widely explains anything, and pays for it by the determinant of its covariance.
double Naming::doubt(double left, const Matrix& whitener, Eigen::Index amplitudes) {
  return left - 2 * whitener.diagonal().array().log().sum() +
         kAmplitudePrice * static_cast<double>(amplitudes);
}

std::vector<EffectFit> Naming::effects(const Vector& residual) const {
  const Vector all = whitened(residual - centre_);
  std::vector<EffectFit> out;
  for (const Known& k : known_) out.push_back(fit(k, all));
  std::stable_sort(out.begin(), out.end(),
                   [](const EffectFit& a, const EffectFit& b) { return a.z > b.z; });
  return out;
}

std::vector<EffectFit> Naming::shapes(const Vector& residual) const {
  std::vector<EffectFit> out;
  for (std::size_t s = 0; s < root_.size(); ++s) {
    const Eigen::Index first = named_ + static_cast<Eigen::Index>(s) * kKnots;
    out.push_back(fit_shape(static_cast<int>(s), (residual - centre_).segment(first, kKnots)));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const EffectFit& a, const EffectFit& b) { return a.z > b.z; });
  return out;
}

void Naming::add_shape(int shape, const Fingerprint& fingerprint) {
  known_.push_back(known(fingerprint, -1, shape));
}

void Naming::sharpen(const EffectFit& fit, const Fingerprint& fingerprint) {
  const std::size_t place = place_of(fit.effect, fit.shape);
  if (place < known_.size()) renew(known_[place], fingerprint);
}

// An effect is sought by its fingerprint, whose own noise hides some of it. Below the sizes at
// which it was learned it vanishes as it grew.
double Naming::smallest_seen(int effect) const {
  const Known& of = known_[place_of(effect, -1)];
  const auto least = [&](const Vector& one) {
    const double z = expected_z(effect, one);
    const double noise = null_misfit_ * of.source.noise_at(one) / of.scale;
    for (double size = kLeastTried; size < kLearnedSize; size *= kTriedStep) {
      const double own = z * std::pow(size, of.source.growth);
      if (own * own > effect_threshold_ * std::sqrt(own * own + noise * size * size)) return size;
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

double Naming::misfit_of_nothing(const Vector& residual) const {
  return (whitener_ * (residual - centre_).head(named_)).squaredNorm();
}

double Naming::expected_z(int effect, const Vector& amplitudes) const {
  const Known& of = known_[place_of(effect, -1)];
  // Second orders hold as far as they were learned, beyond that in proportion.
  const double beyond = std::max(1.0, amplitudes.cwiseAbs().maxCoeff() / kLearnedSize);
  const Vector within = amplitudes / beyond;
  return beyond * length(of, of.source.at(within), of.source.noise_at(within));
}

double Naming::expected_z(int effect, const Vector& mean, int experiments) const {
  return length(known_[place_of(effect, -1)], mean - centre_, 1.0 / experiments);
}

// The fingerprint's own noise has a length as well: that of nulls, by a covariance that did not
// know them.
double Naming::length(const Known& of, const Vector& residual, double noise) const {
  const double square = (whitener_ * residual.head(named_)).squaredNorm();
  return std::sqrt(std::max(0.0, square - null_misfit_ * noise) / of.scale);
}

}  // namespace lilytank
