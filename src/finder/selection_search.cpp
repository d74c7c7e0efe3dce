// The search for the effects that explain an experiment: one at a time, all amplitudes fitted
// together, every member chosen again beside the others.
#include <algorithm>
#include <cmath>

#include "finder/model_selection.hpp"
#include "statistics/largest_first.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::size_t kMostEffects = 3;
constexpr std::size_t kFittedTogether = 8;  // candidates that are fitted together with those before
constexpr int kMostPasses = 4;
// Relative errors of fingerprints: measured about 0, about estimated amplitudes, of curves (six
// linear pieces), and of forces between modules, as two that hold together for minutes change
// statistics by more than the scatter of tens of experiments shows. A remainder below this share of
// the findings is not significant.
constexpr double kInexact = 0.12, kInexactAbout = 0.08, kRough = 0.2, kOfPairs = 0.25;
constexpr double kBeyondCurve = 0.3;  // share of an effect that a found curve must leave
// Share of a curve's gain that is not counted: a curve can fit the errors of named effects'
// fingerprints.
constexpr double kBent = 0.15, kBentAbout = 0.5;  // the second: by one experiment

// A set of effects: indices of candidates, their joint fits, and the whitened remainder.
struct CandidateSet {
  std::vector<std::size_t> of;
  std::vector<EffectFit> fits;
  Vector left;
};

// A candidate that may extend a set, and how much it would gain.
struct Extension {
  std::size_t candidate = 0;
  EffectFit fit;
  double worth = 0;
};

// Gain less its uncounted share and the penalty for its amplitudes.
double worth_of(double gain, const EffectFit& of) {
  const double bent = of.about > 0 ? kBentAbout / of.about : kBent;
  const double share = of.shape < 0 ? 1 : 1 - bent;
  return share * gain - kAmplitudePrice * static_cast<double>(of.amplitudes.size());
}

// Penalised deviance of a set.
double cost(const CandidateSet& set) {
  double out = set.left.squaredNorm();
  for (const EffectFit& f : set.fits) out += f.gain - worth_of(f.gain, f);
  return out;
}

// A selection for one residual.
class SelectionSearch {
 public:
  SelectionSearch(const SelectionState& state, const Vector& residual)
      : s_(state), all_(state.whitening.of(residual)) {}

  SelectedModel select(const std::vector<EffectFit>& start) const;
  std::vector<EffectFit> leading(int count) const;
  std::vector<EffectFit> rivals(const std::vector<EffectFit>& found, double nearly,
                                std::size_t count) const;

 private:
  EffectFit alone(std::size_t k, const Vector& data) const {
    return fitted(s_.candidates[k], s_.candidates[k].all, data);
  }
  EffectFit strongest_shape(const Vector& all) const;
  bool same_term(const EffectFit& fit, const std::vector<EffectFit>& found) const;
  bool within_curve(const EffectCandidate& of, const std::vector<EffectFit>& found) const;
  Vector interactions(const CandidateSet& set) const;
  CandidateSet set_of(const std::vector<EffectFit>& found) const;
  void fit_together(CandidateSet& set) const;
  std::vector<Extension> extensions(const CandidateSet& set, EffectFit& strongest) const;
  CandidateSet extended(const CandidateSet& set) const;
  CandidateSet without(const CandidateSet& set, std::size_t member) const;
  CandidateSet exchanged(CandidateSet set) const;
  CandidateSet larger(const CandidateSet& set) const;
  std::vector<CandidateSet> pairs() const;
  bool each_significant(const CandidateSet& set) const;
  double noise_of(const CandidateSet& set) const;
  double floor_beside(const std::vector<EffectFit>& found) const;
  double threshold_beside(const std::vector<EffectFit>& found) const;

  const SelectionState& s_;
  Vector all_;  // whitened
};

// z below which a remainder may be an error of the fingerprints.
double SelectionSearch::floor_beside(const std::vector<EffectFit>& found) const {
  double floor = 0;
  for (const EffectFit& f : found) {
    const bool pairs = f.effect >= 0 && s_.between_modules[static_cast<std::size_t>(f.effect)];
    const double error = f.shape >= 0  ? kRough
                         : pairs       ? kOfPairs
                         : f.about > 0 ? kInexactAbout
                                       : kInexact;
    floor = std::max(floor, error * f.z);
  }
  return floor;
}

// z beyond which an effect is significant beside others.
double SelectionSearch::threshold_beside(const std::vector<EffectFit>& found) const {
  return found.empty() ? s_.thresholds.effect
                       : std::max(s_.thresholds.further, floor_beside(found));
}

EffectFit SelectionSearch::strongest_shape(const Vector& all) const {
  EffectFit out;
  for (std::size_t s = 0; s < s_.whitening.curves(); ++s) {
    const double gain = all.segment(s_.whitening.first_knot(s), kKnots).squaredNorm();
    const double z = z_of_gain(gain, s_.shape_scale[s], kKnots);
    if (z > out.z) out.shape = static_cast<int>(s), out.gain = gain, out.z = z;
  }
  return out;
}

// Whether another variant of the same force term is in the findings already.
bool SelectionSearch::same_term(const EffectFit& fit, const std::vector<EffectFit>& found) const {
  return std::any_of(found.begin(), found.end(), [&](const EffectFit& other) {
    if (fit.effect < 0 || other.effect < 0) return fit.effect < 0 && other.effect < 0;
    return s_.terms[static_cast<std::size_t>(fit.effect)] ==
           s_.terms[static_cast<std::size_t>(other.effect)];
  });
}

// Whether a curve among the findings contains this effect, as a torque over headings contains a
// constant torque.
bool SelectionSearch::within_curve(const EffectCandidate& of,
                                   const std::vector<EffectFit>& found) const {
  for (const EffectFit& f : found) {
    if (f.shape < 0 || of.effect < 0) continue;
    const Matrix& basis = s_.candidates[place_of(s_.candidates, -1, f.shape)].basis;
    Matrix normal = basis.transpose() * basis;
    normal.diagonal().array() += 1e-6 * (1 + normal.diagonal().maxCoeff());
    const Matrix& own = of.basis;
    const Matrix left = own - basis * solve_symmetric(normal, Matrix(basis.transpose() * own));
    if (left.squaredNorm() < kBeyondCurve * own.squaredNorm()) return true;
  }
  return false;
}

// Fits all amplitudes jointly from their present values; sets every member's z and gain.
void SelectionSearch::fit_together(CandidateSet& set) const {
  std::vector<const ResponseModel*> responses;
  std::vector<double> start;
  for (std::size_t i = 0; i < set.of.size(); ++i) {
    responses.push_back(&s_.candidates[set.of[i]].all);
    start.insert(start.end(), set.fits[i].amplitudes.begin(), set.fits[i].amplitudes.end());
  }
  ResponseFit fit = fit_responses(
      responses, s_.interactions.empty() ? all_ : Vector(all_ - interactions(set)),
      Eigen::Map<const Vector>(start.data(), static_cast<Eigen::Index>(start.size())));
  set.left = std::move(fit.left);
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < set.of.size(); ++i) {
    const EffectCandidate& of = s_.candidates[set.of[i]];
    EffectFit& f = set.fits[i];
    f.amplitudes = fit.amplitudes.segment(at, f.amplitudes.size());
    f.at_bound = of.all.at_bound(f.amplitudes);
    f.moved = of.source.moved(f.amplitudes);
    at += f.amplitudes.size();
    const Vector own = set.left + of.all.at(f.amplitudes);
    f.gain = own.squaredNorm() - set.left.squaredNorm();
    f.z = fit_of(of, own).z;
    const EffectFit shape = strongest_shape(own);
    if (f.shape >= 0 && shape.shape == f.shape) f.z = std::max(f.z, shape.z);
  }
}

// Whitened interactions of the members, where they were simulated.
Vector SelectionSearch::interactions(const CandidateSet& set) const {
  Vector out = Vector::Zero(s_.whitening.centre.size());
  for (const Interaction& m : s_.interactions) {
    const bool there = std::all_of(m.of.begin(), m.of.end(), [&](std::size_t k) {
      return std::find(set.of.begin(), set.of.end(), k) != set.of.end();
    });
    if (there) out += m.more;
  }
  return s_.whitening.whitened(out);
}

// Candidates that are significant in the remainder, by descending gain.
std::vector<Extension> SelectionSearch::extensions(const CandidateSet& set,
                                                   EffectFit& strongest) const {
  const EffectFit shape = strongest_shape(set.left);
  const double floor = floor_beside(set.fits), least = threshold_beside(set.fits);
  std::vector<Extension> out;
  strongest = EffectFit{};
  for (std::size_t k = 0; k < s_.candidates.size(); ++k) {
    const EffectFit one = fit_of(s_.candidates[k], set.left);
    if (one.z > strongest.z) strongest = one;
    if (same_term(one, set.fits) || within_curve(s_.candidates[k], set.fits)) continue;
    // A curve may be significant by its own knots, too.
    const bool own = one.shape >= 0 && one.shape == shape.shape &&
                     shape.z > std::max(s_.thresholds.shape, floor);
    if (one.z <= least && !own) continue;
    EffectFit whole = alone(k, set.left);
    const double worth = worth_of(whole.gain, whole);
    if (worth > 0) out.push_back({k, std::move(whole), worth});
  }
  largest_first(out, &Extension::worth);
  return out;
}

// The set with the candidate of the least deviance after a joint fit; unchanged if there is none.
CandidateSet SelectionSearch::extended(const CandidateSet& set) const {
  EffectFit strongest;
  std::vector<Extension> next = extensions(set, strongest);
  if (next.size() > kFittedTogether) next.resize(kFittedTogether);
  CandidateSet best = set;
  for (Extension& e : next) {
    CandidateSet with = set;
    with.of.push_back(e.candidate), with.fits.push_back(e.fit);
    fit_together(with);
    if (cost(with) < cost(best)) best = std::move(with);
  }
  return best;
}

// Pairs of effects with the least joint deviance, also where neither is significant alone.
std::vector<CandidateSet> SelectionSearch::pairs() const {
  std::vector<CandidateSet> out;
  for (const auto& [a, b] : leading_pairs(s_.candidates, all_, kFittedTogether)) {
    CandidateSet set;
    for (const std::size_t k : {a, b}) set.of.push_back(k), set.fits.push_back(alone(k, all_));
    if (same_term(set.fits[0], {set.fits[1]})) continue;
    fit_together(set);
    out.push_back(std::move(set));
  }
  return out;
}

// Whether every member exceeds the errors of the others' fingerprints.
bool SelectionSearch::each_significant(const CandidateSet& set) const {
  for (std::size_t m = 0; m < set.of.size(); ++m) {
    std::vector<EffectFit> others = set.fits;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(m));
    if (set.fits[m].z <= threshold_beside(others)) return false;
    if (within_curve(s_.candidates[set.of[m]], others)) return false;
  }
  return true;
}

CandidateSet SelectionSearch::without(const CandidateSet& set, std::size_t member) const {
  CandidateSet out = set;
  out.of.erase(out.of.begin() + static_cast<std::ptrdiff_t>(member));
  out.fits.erase(out.fits.begin() + static_cast<std::ptrdiff_t>(member));
  out.left = all_;
  if (!out.of.empty()) fit_together(out);
  return out;
}

// Selects every member again given the others, until none changes.
CandidateSet SelectionSearch::exchanged(CandidateSet set) const {
  for (int pass = 0; pass < kMostPasses; ++pass) {
    bool changed = false;
    for (std::size_t m = 0; m < set.of.size(); ++m) {
      CandidateSet other = extended(without(set, m));
      if (other.of.size() < set.of.size() || cost(other) > cost(set) - kAmplitudePrice) continue;
      set = std::move(other), changed = true;
    }
    if (!changed) break;
  }
  return set;
}

// The best set with one more effect, in which earlier members may be exchanged; unchanged if no
// gain exceeds the errors of the fingerprints.
CandidateSet SelectionSearch::larger(const CandidateSet& set) const {
  CandidateSet best = extended(set);
  if (set.of.size() == 1) {
    for (CandidateSet& pair : pairs()) {
      const bool first = best.of.size() == 1 || cost(pair) < cost(best);
      if (first && each_significant(pair)) best = std::move(pair);
    }
  }
  if (best.of.size() == set.of.size()) return set;
  if (best.of.size() > 1) {
    best = exchanged(std::move(best));
    if (!set.of.empty() && !each_significant(best)) return set;
  }
  const double least = threshold_beside(set.fits);
  return cost(best) < cost(set) - least * least || set.of.empty() ? best : set;
}

// Variance of the members' fingerprints in a statistic of unit variance.
double SelectionSearch::noise_of(const CandidateSet& set) const {
  double out = 0;
  for (std::size_t m = 0; m < set.of.size(); ++m) {
    out += s_.candidates[set.of[m]].source.noise_at(set.fits[m].amplitudes);
  }
  return out;
}

CandidateSet SelectionSearch::set_of(const std::vector<EffectFit>& found) const {
  CandidateSet set;
  for (const EffectFit& f : found) {
    set.of.push_back(place_of(s_.candidates, f.effect, f.shape)), set.fits.push_back(f);
  }
  set.left = all_;
  if (!set.of.empty()) fit_together(set);
  return set;
}

SelectedModel SelectionSearch::select(const std::vector<EffectFit>& start) const {
  const Eigen::Index named = s_.whitening.named;
  SelectedModel out;
  CandidateSet set = set_of(start);
  while (set.of.size() < kMostEffects) {
    CandidateSet more = larger(set);
    if (more.of.size() == set.of.size()) break;
    set = std::move(more);
  }
  extensions(set, out.left_effect);
  out.left_shape = strongest_shape(set.left), out.inexact = floor_beside(set.fits);
  const double squared = set.left.head(named).squaredNorm();
  out.misfit = squared / (1 + noise_of(set));
  out.share_left = squared / all_.head(named).squaredNorm();
  Eigen::Index amplitudes = 0;
  for (const EffectFit& f : set.fits) amplitudes += f.amplitudes.size();
  out.penalized_deviance = penalized_deviance(squared, s_.whitening.whitener, amplitudes);
  out.found = set.fits;
  largest_first(out.found, &EffectFit::z);
  return out;
}

std::vector<EffectFit> SelectionSearch::leading(int count) const {
  std::vector<EffectFit> out;
  for (std::size_t k = 0; k < s_.candidates.size(); ++k) out.push_back(alone(k, all_));
  largest_first(out, &EffectFit::gain);
  out.resize(std::min(out.size(), static_cast<std::size_t>(count)));
  return out;
}

std::vector<EffectFit> SelectionSearch::rivals(const std::vector<EffectFit>& found, double nearly,
                                               std::size_t count) const {
  const CandidateSet set = set_of(found);
  std::vector<EffectFit> out;
  for (std::size_t m = 0; m < set.of.size(); ++m) {
    const CandidateSet rest = without(set, m);
    std::vector<EffectFit> own;
    for (std::size_t k = 0; k < s_.candidates.size(); ++k) {
      const EffectFit f = alone(k, rest.left);
      const double least = nearly * set.fits[m].gain;
      if (k != set.of[m] && f.gain > least && !same_term(f, rest.fits)) own.push_back(f);
    }
    largest_first(own, &EffectFit::gain);
    own.insert(own.begin(), set.fits[m]);
    own.resize(std::min(own.size(), count));
    out.insert(out.end(), own.begin(), own.end());
  }
  return out;
}

}  // namespace

SelectedModel ModelSelection::select(const Vector& residual,
                                     const std::vector<EffectFit>& start) const {
  return SelectionSearch(state_, residual).select(start);
}

std::vector<EffectFit> ModelSelection::leading(const Vector& residual, int count) const {
  return SelectionSearch(state_, residual).leading(count);
}

std::vector<EffectFit> ModelSelection::rivals(const Vector& residual,
                                              const std::vector<EffectFit>& found, double nearly,
                                              std::size_t count) const {
  return SelectionSearch(state_, residual).rivals(found, nearly, count);
}

void ModelSelection::add_interaction(const std::vector<EffectFit>& of, const Vector& residual,
                                     int experiments) {
  Interaction m;
  Vector more = residual;
  double error = 1.0 / experiments;
  for (const EffectFit& f : of) {
    m.of.push_back(place_of(state_.candidates, f.effect, f.shape));
    const Fingerprint& own = state_.candidates[m.of.back()].source;
    more -= own.at(f.amplitudes), error += 1.0 / std::max(1, own.experiments);
  }
  const double noise = kNoisy * std::sqrt(error);
  m.more = more.unaryExpr([=](double v) { return std::fabs(v) < noise ? 0.0 : v; });
  std::sort(m.of.begin(), m.of.end());
  std::erase_if(state_.interactions, [&](const Interaction& other) { return other.of == m.of; });
  state_.interactions.push_back(std::move(m));
}

}  // namespace lilytank
