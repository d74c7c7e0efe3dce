// The search for the effects that explain an experiment.
#include <algorithm>
#include <cmath>

#include "analysis/linear.hpp"
#include "diagnose/naming.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kMostEffects = 3;
constexpr double kInexact = 0.12;  // share of what was found that a remainder may be: fingerprints
                                   // are known to some per cent only
constexpr double kRough = 0.2;     // the same of a curve: six straight pieces are off by more
constexpr double kBeyondCurve = 0.3;  // share of an effect that a found curve must leave
constexpr double kCurve = 0.85;       // of a curve's gain: it may bend to what names leave
constexpr double kPrice = 4;          // of an amplitude, in squared distance

}  // namespace

std::vector<EffectFit> Naming::leading(const Vector& residual, int count) const {
  const Vector all = whitened(residual - centre_);
  std::vector<EffectFit> out;
  for (const Known& k : known_) out.push_back(fit_all(k, all));
  std::stable_sort(out.begin(), out.end(),
                   [](const EffectFit& a, const EffectFit& b) { return a.gain > b.gain; });
  out.resize(std::min(out.size(), static_cast<std::size_t>(count)));
  return out;
}

EffectFit Naming::strongest_shape(const Vector& all) const {
  EffectFit out;
  for (std::size_t s = 0; s < root_.size(); ++s) {
    const Eigen::Index first = named_ + static_cast<Eigen::Index>(s) * kKnots;
    const double gain = all.segment(first, kKnots).squaredNorm();
    const double z = z_of(gain, shape_scale_[s], kKnots);
    if (z > out.z) out.shape = static_cast<int>(s), out.gain = gain, out.z = z;
  }
  return out;
}

// One term has one strength: another variant of what was found is no other finding.
bool Naming::told_already(const EffectFit& fit, const std::vector<EffectFit>& found) const {
  return std::any_of(found.begin(), found.end(), [&](const EffectFit& other) {
    if (fit.effect < 0 || other.effect < 0) return fit.effect < 0 && other.effect < 0;
    return terms_[static_cast<std::size_t>(fit.effect)] ==
           terms_[static_cast<std::size_t>(other.effect)];
  });
}

// Whether a curve that was found can do what this effect does: a constant torque beside a torque
// over headings would only share out the curve's mean.
bool Naming::within_curve(const Known& of, const std::vector<EffectFit>& found) const {
  for (const EffectFit& f : found) {
    if (f.shape < 0 || of.effect < 0) continue;
    const auto curve = std::find_if(known_.begin(), known_.end(),
                                    [&](const Known& k) { return k.shape == f.shape; });
    if (curve == known_.end()) continue;
    const Matrix& basis = curve->all.first;
    Matrix normal = basis.transpose() * basis;
    normal.diagonal().array() += 1e-6 * (1 + normal.diagonal().maxCoeff());
    const Matrix& own = of.all.first;
    const Matrix left = own - basis * solve_symmetric(normal, Matrix(basis.transpose() * own));
    if (left.squaredNorm() < kBeyondCurve * own.squaredNorm()) return true;
  }
  return false;
}

// Of the candidates that are significant, the one that leaves least.
std::size_t Naming::best(const Vector& all, double floor, const std::vector<EffectFit>& found,
                         EffectFit& out, EffectFit& strongest) const {
  const Vector named = all.head(named_);
  const EffectFit shape = strongest_shape(all);
  std::size_t index = known_.size();
  double most = 0;
  strongest = EffectFit{};
  for (std::size_t k = 0; k < known_.size(); ++k) {
    const EffectFit one = fit(known_[k], named);
    if (one.z > strongest.z) strongest = one;
    if (told_already(one, found) || within_curve(known_[k], found)) continue;
    // A curve speaks by its own knots as well.
    const bool own =
        one.shape >= 0 && one.shape == shape.shape && shape.z > std::max(shape_threshold_, floor);
    if (one.z <= std::max(effect_threshold_, floor) && !own) continue;
    EffectFit whole = fit_all(known_[k], all);
    double gain = whole.gain - kPrice * static_cast<double>(whole.amplitudes.size());
    if (whole.shape >= 0) gain *= kCurve;
    if (gain <= most) continue;
    whole.z = own ? std::max(one.z, shape.z) : one.z;
    most = gain, index = k, out = whole;
  }
  return index;
}

Explanation Naming::explain(const Vector& residual) const {
  Explanation out;
  Vector all = whitened(residual - centre_);
  double floor = 0;
  for (int round = 0;; ++round) {
    EffectFit chosen;
    const std::size_t k = best(all, floor, out.found, chosen, out.left_effect);
    out.left_shape = strongest_shape(all);
    if (round == 0) out.strongest = std::max(out.left_effect.z, out.left_shape.z);
    if (k == known_.size() || round == kMostEffects) break;
    const Known& of = known_[k];
    all -= of.all.at(chosen.amplitudes);
    chosen.moved = of.source.moved(chosen.amplitudes);
    floor = std::max(floor, (chosen.shape >= 0 ? kRough : kInexact) * chosen.z);
    out.found.push_back(chosen);
  }
  return out;
}

}  // namespace lilytank
