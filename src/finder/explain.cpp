// The search for the effects that explain an experiment: one at a time, all amplitudes fitted
// together, every member chosen again beside the others.
#include <algorithm>
#include <cmath>

#include "finder/naming.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::size_t kMostEffects = 3;
constexpr std::size_t kFittedTogether = 8;  // candidates that are fitted together with those before
constexpr int kMostPasses = 4;
// Share of what was found that a remainder may be: fingerprints are known to some per cent only,
// those about found amplitudes better; of a curve six straight pieces are off by more.
constexpr double kInexact = 0.12, kInexactAbout = 0.08, kRough = 0.2;
constexpr double kBeyondCurve = 0.3;  // share of an effect that a found curve must leave
// Share of a curve's gain that does not count: it may bend to what names leave, the less the better
// both are known.
constexpr double kBent = 0.15, kBentAbout = 0.5;  // the second: by one experiment
// Shares of a distance that an explanation may not leave: where something is left, and where that
// is as many times what nulls have.
constexpr double kMostLeft = 0.5, kMuchLeft = 0.25, kFarBeyond = 2;

}  // namespace

std::vector<EffectFit> Naming::leading(const Vector& residual, int count) const {
  const Vector all = whitened(residual - centre_);
  std::vector<EffectFit> out;
  for (const Known& k : known_) out.push_back(fitted(k, k.all, all));
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
    const Matrix& basis = known_[place_of(-1, f.shape)].basis;
    Matrix normal = basis.transpose() * basis;
    normal.diagonal().array() += 1e-6 * (1 + normal.diagonal().maxCoeff());
    const Matrix& own = of.basis;
    const Matrix left = own - basis * solve_symmetric(normal, Matrix(basis.transpose() * own));
    if (left.squaredNorm() < kBeyondCurve * own.squaredNorm()) return true;
  }
  return false;
}

// Below this z a remainder may be what fingerprints are wrong by.
double Naming::floor_beside(const std::vector<EffectFit>& found) const {
  double floor = 0;
  for (const EffectFit& f : found) {
    floor = std::max(floor, (f.shape >= 0 ? kRough : f.about > 0 ? kInexactAbout : kInexact) * f.z);
  }
  return floor;
}

// From where each member's amplitudes are. Tells every member's z and gain beside the others.
void Naming::fit_together(const Vector& all, Together& set) const {
  std::vector<const Answer*> answers;
  std::vector<double> start;
  for (std::size_t i = 0; i < set.of.size(); ++i) {
    answers.push_back(&known_[set.of[i]].all);
    start.insert(start.end(), set.fits[i].amplitudes.begin(), set.fits[i].amplitudes.end());
  }
  AnswerFit fit =
      fit_answers(answers, meetings_.empty() ? all : Vector(all - meeting(set)),
                  Eigen::Map<const Vector>(start.data(), static_cast<Eigen::Index>(start.size())));
  set.left = std::move(fit.left);
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < set.of.size(); ++i) {
    const Known& of = known_[set.of[i]];
    EffectFit& f = set.fits[i];
    f.amplitudes = fit.amplitudes.segment(at, f.amplitudes.size());
    f.at_reach = of.all.at_reach(f.amplitudes);
    f.moved = of.source.moved(f.amplitudes);
    at += f.amplitudes.size();
    const Vector own = set.left + of.all.at(f.amplitudes);
    f.gain = own.squaredNorm() - set.left.squaredNorm();
    f.z = this->fit(of, own).z;
    const EffectFit shape = strongest_shape(own);
    if (f.shape >= 0 && shape.shape == f.shape) f.z = std::max(f.z, shape.z);
  }
}

// What members do to each other, as far as it was simulated.
Vector Naming::meeting(const Together& set) const {
  Vector out = Vector::Zero(centre_.size());
  for (const Meeting& m : meetings_) {
    const bool there = std::all_of(m.of.begin(), m.of.end(), [&](std::size_t k) {
      return std::find(set.of.begin(), set.of.end(), k) != set.of.end();
    });
    if (there) out += m.more;
  }
  return whitened(out);
}

// Candidates that are significant in what a set leaves, by how much of it they explain.
std::vector<Naming::Candidate> Naming::candidates(const Together& set, EffectFit& strongest) const {
  const EffectFit shape = strongest_shape(set.left);
  const double floor = floor_beside(set.fits);
  std::vector<Candidate> out;
  strongest = EffectFit{};
  for (std::size_t k = 0; k < known_.size(); ++k) {
    const EffectFit one = fit(known_[k], set.left);
    if (one.z > strongest.z) strongest = one;
    if (told_already(one, set.fits) || within_curve(known_[k], set.fits)) continue;
    // A curve speaks by its own knots as well.
    const bool own =
        one.shape >= 0 && one.shape == shape.shape && shape.z > std::max(shape_threshold_, floor);
    if (one.z <= std::max(effect_threshold_, floor) && !own) continue;
    EffectFit whole = fitted(known_[k], known_[k].all, set.left);
    const double worth = worth_of(whole.gain, whole);
    if (worth > 0) out.push_back({k, std::move(whole), worth});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Candidate& a, const Candidate& b) { return a.worth > b.worth; });
  return out;
}

double Naming::worth_of(double gain, const EffectFit& of) const {
  const double bent = of.about > 0 ? kBentAbout / of.about : kBent;
  const double share = of.shape < 0 ? 1 : 1 - bent;
  return share * gain - kAmplitudePrice * static_cast<double>(of.amplitudes.size());
}

// What a set leaves, and what its members cost.
double Naming::cost(const Together& set) const {
  double out = set.left.squaredNorm();
  for (const EffectFit& f : set.fits) out += f.gain - worth_of(f.gain, f);
  return out;
}

// The set with the candidate that leaves least once everything is fitted together; the set as it
// is if there is none.
Naming::Together Naming::extended(const Vector& all, const Together& set) const {
  EffectFit strongest;
  std::vector<Candidate> next = candidates(set, strongest);
  if (next.size() > kFittedTogether) next.resize(kFittedTogether);
  Together best = set;
  for (Candidate& c : next) {
    Together with = set;
    with.of.push_back(c.known), with.fits.push_back(c.fit);
    fit_together(all, with);
    if (cost(with) < cost(best)) best = std::move(with);
  }
  return best;
}

// Pairs of known effects by how much they explain together, in first order; at most
// `kFittedTogether`.
std::vector<std::pair<std::size_t, std::size_t>> Naming::leading_pairs(const Vector& all) const {
  std::vector<Eigen::Index> first{0};
  for (const Known& k : known_) {
    first.push_back(first.back() + (k.source.local() ? 1 : k.all.first.cols()));
  }
  Matrix basis(all.size(), first.back());
  for (std::size_t k = 0; k < known_.size(); ++k) {
    const Answer& of = known_[k].all;
    basis.middleCols(first[k], first[k + 1] - first[k]) = of.local() ? Matrix(of.base) : of.first;
  }
  const Matrix gram = basis.transpose() * basis;
  const Vector seen = basis.transpose() * all;
  const auto possible = [&](std::size_t k, const Vector& amplitudes) {
    return known_[k].all.two_sided || amplitudes.minCoeff() > 0;
  };
  std::vector<std::pair<double, std::pair<std::size_t, std::size_t>>> ranked;  // by -gain
  for (std::size_t a = 0; a < known_.size(); ++a) {
    for (std::size_t b = a + 1; b < known_.size(); ++b) {
      const auto of_a = Eigen::seq(first[a], first[a + 1] - 1);
      const auto of_b = Eigen::seq(first[b], first[b + 1] - 1);
      Matrix normal(of_a.size() + of_b.size(), of_a.size() + of_b.size());
      normal << gram(of_a, of_a), gram(of_a, of_b), gram(of_b, of_a), gram(of_b, of_b);
      normal.diagonal().array() += 1e-6 + 1e-3 * normal.diagonal().maxCoeff();
      Vector both(of_a.size() + of_b.size());
      both << seen(of_a), seen(of_b);
      const Vector amplitudes = solve_symmetric(normal, both);
      if (possible(a, amplitudes.head(of_a.size())) && possible(b, amplitudes.tail(of_b.size()))) {
        ranked.push_back({-both.dot(amplitudes), {a, b}});
      }
    }
  }
  const auto count = static_cast<std::ptrdiff_t>(std::min(ranked.size(), kFittedTogether));
  std::partial_sort(ranked.begin(), ranked.begin() + count, ranked.end());
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (auto pair = ranked.begin(); pair != ranked.begin() + count; ++pair) {
    out.push_back(pair->second);
  }
  return out;
}

// Pairs of effects that together leave least, though neither may stand out alone.
std::vector<Naming::Together> Naming::pairs(const Vector& all) const {
  std::vector<Together> out;
  for (const auto& [a, b] : leading_pairs(all)) {
    Together set;
    for (const std::size_t k : {a, b}) {
      set.of.push_back(k), set.fits.push_back(fitted(known_[k], known_[k].all, all));
    }
    if (told_already(set.fits[0], {set.fits[1]})) continue;
    fit_together(all, set);
    out.push_back(std::move(set));
  }
  return out;
}

// Every member is beyond what the others' fingerprints may be wrong by.
bool Naming::each_speaks(const Together& set) const {
  for (std::size_t m = 0; m < set.of.size(); ++m) {
    std::vector<EffectFit> others = set.fits;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(m));
    if (set.fits[m].z <= std::max(effect_threshold_, floor_beside(others))) return false;
    if (within_curve(known_[set.of[m]], others)) return false;
  }
  return true;
}

Naming::Together Naming::without(const Vector& all, const Together& set, std::size_t member) const {
  Together out = set;
  out.of.erase(out.of.begin() + static_cast<std::ptrdiff_t>(member));
  out.fits.erase(out.fits.begin() + static_cast<std::ptrdiff_t>(member));
  out.left = all;
  if (!out.of.empty()) fit_together(all, out);
  return out;
}

// Every member is chosen again beside the others, until none changes.
void Naming::exchange(const Vector& all, Together& set) const {
  for (int pass = 0; pass < kMostPasses; ++pass) {
    bool changed = false;
    for (std::size_t m = 0; m < set.of.size(); ++m) {
      Together other = extended(all, without(all, set, m));
      if (other.of.size() < set.of.size() || cost(other) > cost(set) - kAmplitudePrice) continue;
      set = std::move(other), changed = true;
    }
    if (!changed) return;
  }
}

// The best set with one effect more, the members before not bound to stay; the set as it is if
// every other leaves no less than its own fingerprints may be wrong by.
Naming::Together Naming::larger(const Vector& all, const Together& set) const {
  Together best = extended(all, set);
  if (set.of.size() == 1) {
    for (Together& pair : pairs(all)) {
      const bool first = best.of.size() == 1 || cost(pair) < cost(best);
      if (first && each_speaks(pair)) best = std::move(pair);
    }
  }
  if (best.of.size() == set.of.size()) return set;
  if (best.of.size() > 1) {
    exchange(all, best);
    if (!set.of.empty() && !each_speaks(best)) return set;
  }
  const double least = std::max(effect_threshold_, floor_beside(set.fits));
  return cost(best) < cost(set) - least * least || set.of.empty() ? best : set;
}

// Variance that the errors of the members' fingerprints add to every number, which has one.
double Naming::noise_of(const Together& set) const {
  double out = 0;
  for (std::size_t m = 0; m < set.of.size(); ++m) {
    out += known_[set.of[m]].source.noise_at(set.fits[m].amplitudes);
  }
  return out;
}

Explanation Naming::explain(const Vector& residual, const std::vector<EffectFit>& begun) const {
  const Vector all = whitened(residual - centre_);
  Explanation out;
  Together set = set_of(all, begun);
  while (set.of.size() < kMostEffects) {
    Together more = larger(all, set);
    if (more.of.size() == set.of.size()) break;
    set = std::move(more);
  }
  candidates(set, out.left_effect);
  out.left_shape = strongest_shape(set.left);
  out.misfit = set.left.head(named_).squaredNorm() / (1 + noise_of(set));
  out.share_left = set.left.head(named_).squaredNorm() / all.head(named_).squaredNorm();
  Eigen::Index amplitudes = 0;
  for (const EffectFit& f : set.fits) amplitudes += f.amplitudes.size();
  out.doubt = doubt(set.left.head(named_).squaredNorm(), whitener_, amplitudes);
  out.found = set.fits;
  std::stable_sort(out.found.begin(), out.found.end(),
                   [](const EffectFit& a, const EffectFit& b) { return a.z > b.z; });
  return out;
}

bool Naming::fails(const Explanation& e) const {
  const double far = e.misfit / misfit_threshold_;
  return (far > 1 && e.share_left > kMostLeft) || (far > kFarBeyond && e.share_left > kMuchLeft);
}

Naming::Together Naming::set_of(const Vector& all, const std::vector<EffectFit>& found) const {
  Together set;
  for (const EffectFit& f : found) {
    set.of.push_back(place_of(f.effect, f.shape)), set.fits.push_back(f);
  }
  set.left = all;
  if (!set.of.empty()) fit_together(all, set);
  return set;
}

std::vector<EffectFit> Naming::rivals(const Vector& residual, const std::vector<EffectFit>& found,
                                      double nearly, std::size_t count) const {
  const Vector all = whitened(residual - centre_);
  const Together set = set_of(all, found);
  std::vector<EffectFit> out;
  for (std::size_t m = 0; m < set.of.size(); ++m) {
    const Together rest = without(all, set, m);
    std::vector<EffectFit> own;
    for (std::size_t k = 0; k < known_.size(); ++k) {
      const EffectFit f = fitted(known_[k], known_[k].all, rest.left);
      const double least = nearly * set.fits[m].gain;
      if (k != set.of[m] && f.gain > least && !told_already(f, rest.fits)) own.push_back(f);
    }
    std::stable_sort(own.begin(), own.end(),
                     [](const EffectFit& a, const EffectFit& b) { return a.gain > b.gain; });
    own.insert(own.begin(), set.fits[m]);
    own.resize(std::min(own.size(), count));
    out.insert(out.end(), own.begin(), own.end());
  }
  return out;
}

void Naming::add_meeting(const std::vector<EffectFit>& of, const Vector& residual,
                         int experiments) {
  Meeting m;
  Vector more = residual;
  double error = 1.0 / experiments;
  for (const EffectFit& f : of) {
    m.of.push_back(place_of(f.effect, f.shape));
    const Fingerprint& own = known_[m.of.back()].source;
    more -= own.at(f.amplitudes), error += 1.0 / std::max(1, own.experiments);
  }
  const double noise = kNoisy * std::sqrt(error);
  m.more = more.unaryExpr([=](double v) { return std::fabs(v) < noise ? 0.0 : v; });
  std::sort(m.of.begin(), m.of.end());
  std::erase_if(meetings_, [&](const Meeting& other) { return other.of == m.of; });
  meetings_.push_back(std::move(m));
}

}  // namespace lilytank
