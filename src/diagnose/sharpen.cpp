// From residuals to an explanation: curves beside the names, and fingerprints at the strength that
// was found.
#include <algorithm>
#include <set>

#include "analysis/linear.hpp"
#include "diagnose/diagnoser.hpp"
#include "lilytank/random.hpp"

namespace lilytank {
namespace {

using Vector = Eigen::VectorXd;

constexpr double kLeastAmplitude = 0.2, kFirstRival = 0.35, kRival = 0.5, kNear = 0.85;
constexpr double kLearned = 2;  // sizes up to which a fingerprint is as good as it was learned
constexpr double kInexact = 0.1, kUsual = 3;  // share of scores, and sizes, that a knot may have
constexpr int kRivals = 3, kMostSharpened = 6;
constexpr std::size_t kMostMeetings = 3;

}  // namespace

// Named effects first; a shape competes with them where they leave something.
Explanation Diagnoser::explained(Naming& naming, const Vector& residual) {
  Explanation e = naming.explain(residual);
  const std::vector<EffectFit> shapes = naming.shapes(residual);
  std::vector<int> asked;
  if (shapes[0].z > naming.shape_threshold() && (e.found.empty() || shapes[0].z > e.found[0].z)) {
    asked.push_back(shapes[0].shape);
  }
  double largest = 0;
  for (const EffectFit& f : e.found) largest = std::max(largest, f.z);
  if (e.left_shape.z > std::max(naming.shape_threshold(), 0.15 * largest)) {
    if (asked.empty() || asked[0] != e.left_shape.shape) asked.push_back(e.left_shape.shape);
  }
  // What leaves much may be a law of the same variable.
  if (!e.found.empty() && e.found[0].effect >= 0 && e.misfit > naming.misfit_threshold()) {
    const auto& effect = atlas_->plan().effects[static_cast<std::size_t>(e.found[0].effect)];
    const auto same = std::find_if(shapes.begin(), shapes.end(), [&](const EffectFit& f) {
      return atlas_->plan().shapes[static_cast<std::size_t>(f.shape)].variable == effect.variable;
    });
    if (same != shapes.end() && std::find(asked.begin(), asked.end(), same->shape) == asked.end()) {
      asked.push_back(same->shape);
    }
  }
  for (const int s : asked) naming.add_shape(s, shape_fingerprint(s));
  return asked.empty() ? e : naming.explain(residual);
}

// One effect of a size like those that were simulated explains all there is, leaves nothing, and
// nothing else comes near.
bool Diagnoser::plain(const Naming& naming, const Explanation& e, const Vector& residual) const {
  const EffectFit& f = e.found.front();
  if (e.found.size() > 1 || naming.leaves_something(e)) return false;
  if (f.effect < 0 || f.amplitudes.cwiseAbs().maxCoeff() > kLearned) {
    return false;
  }
  const std::vector<Effect>& effects = atlas_->plan().effects;
  const std::string& name = effects[static_cast<std::size_t>(f.effect)].name;
  const std::vector<EffectFit> leading = naming.leading(residual, kRivals + 3);
  return std::none_of(leading.begin(), leading.end(), [&](const EffectFit& other) {
    const bool same =
        other.effect >= 0 && effects[static_cast<std::size_t>(other.effect)].name == name;
    return !same && other.gain > kNear * leading.front().gain;
  });
}

// The fingerprint about the amplitudes that were found, in the place of the one before.
Fingerprint Diagnoser::fingerprint_near(const EffectFit& f, const Fingerprint& before,
                                        const Judged& judged) {
  const auto id = static_cast<std::size_t>(f.effect >= 0 ? f.effect : f.shape);
  const ScorePlan& plan = atlas_->plan();
  const Effect effect = f.effect >= 0 ? plan.effects[id] : effect_of(plan.shapes[id]);
  const std::string name = (f.effect >= 0 ? "effect " : "shape ") + std::to_string(id);
  return atlas_->fingerprint_about(f.amplitudes, before, effect,
                                   atlas_->calibrated(judged.observed.summary).point, name);
}

// A curve's values by its own scores: far beyond the sizes that a fingerprint was learned at, other
// numbers would lead astray. Knots that bodies hardly visit stay near nothing.
Vector Diagnoser::knots_of(int shape, const Fingerprint& fingerprint,
                           const Vector& residual) const {
  const Eigen::Index first = atlas_->named_numbers() + shape * kKnots;
  const Eigen::MatrixXd own = fingerprint.first.middleRows(first, kKnots);
  const Vector scores = residual.segment(first, kKnots);
  const double error = 1 + kInexact * kInexact * scores.squaredNorm() / kKnots;
  Eigen::MatrixXd normal = own.transpose() * own;
  normal.diagonal().array() += error / (kUsual * kUsual);
  return solve_symmetric(normal, Vector(own.transpose() * scores));
}

// Fingerprints are learned at sizes that can just be seen well; what is far stronger is judged by
// experiments of its own strength. First those that might be it, then whatever leads.
Explanation Diagnoser::sharpened(Naming& naming, Explanation e, const Judged& judged,
                                 const Vector& residual) {
  if (e.found.empty() || plain(naming, e, residual)) return e;
  Sharper known;
  std::map<std::pair<int, int>, double> doubts;
  const auto sharpen = [&](EffectFit f) {
    const auto before = known.find({f.effect, f.shape});
    const Fingerprint from = before != known.end() ? before->second
                             : f.effect >= 0
                                 ? atlas_->fingerprints()[static_cast<std::size_t>(f.effect)]
                                 : shape_fingerprint(f.shape);
    if (f.shape >= 0 && before == known.end()) f.amplitudes = knots_of(f.shape, from, residual);
    const Fingerprint to = fingerprint_near(f, from, judged);
    known[{f.effect, f.shape}] = to;
    naming.sharpen(f, to);
    doubts[{f.effect, f.shape}] = naming.doubt_of(residual, f.effect, f.shape, to.scatter);
  };
  // By the scatter of the experiments with what, by its own scatter, is most likely there.
  const auto loosen = [&] {
    const auto likely =
        std::min_element(doubts.begin(), doubts.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (likely != doubts.end()) naming.loosen(known[likely->first].scatter);
  };
  const auto blunt = [&](const EffectFit& f) {
    const bool told = known.count({f.effect, f.shape}) > 0;
    return f.amplitudes.norm() > kLeastAmplitude && (!told || f.at_reach);
  };
  // What is found should be where its experiments were, not beside them; once is enough.
  std::set<std::pair<int, int>> centred;
  const auto off_centre = [&](const EffectFit& f) {
    const auto sharp = known.find({f.effect, f.shape});
    if (sharp == known.end() || f.shape >= 0) return false;
    const Vector& about = sharp->second.about;
    const double off = (f.amplitudes - about).cwiseQuotient(apart(about)).cwiseAbs().maxCoeff();
    return off > 1 && centred.insert({f.effect, f.shape}).second;
  };
  const std::vector<EffectFit> leading = naming.leading(residual, kRivals);
  for (const EffectFit& f : leading) {
    if (blunt(f) && f.gain > kFirstRival * leading[0].gain) sharpen(f);
  }
  loosen();
  for (int more = 0; more < kMostSharpened; ++more) {
    e = naming.explain(residual);
    std::vector<EffectFit> next = naming.leading(residual, kRivals);
    next.erase(std::remove_if(next.begin() + 1, next.end(),
                              [&](const EffectFit& f) { return f.gain < kRival * next[0].gain; }),
               next.end());
    const std::vector<EffectFit> rivals = naming.rivals(residual, e.found, kRival, kRivals);
    next.insert(next.end(), rivals.begin(), rivals.end());
    auto first = std::find_if(next.begin(), next.end(), blunt);
    if (first == next.end()) {
      next = e.found;
      first = std::find_if(next.begin(), next.end(), off_centre);
    }
    if (first == next.end()) break;
    sharpen(*first);
    loosen();
  }
  return met(naming, known, judged, residual);
}

// Several effects need not add up: modules that one holds together another cannot move apart.
// What they do at once is simulated as well.
Explanation Diagnoser::met(Naming& naming, const Sharper& known, const Judged& judged,
                           const Vector& residual) {
  const ScorePlan& plan = atlas_->plan();
  Explanation e = naming.explain(residual);
  std::set<std::string> told;
  while (e.found.size() > 1) {
    std::vector<Effect> effects;
    std::vector<Fingerprint> each;
    std::vector<Vector> amplitudes;
    std::string name;
    std::vector<EffectFit> found = e.found;
    std::sort(found.begin(), found.end(), [](const EffectFit& a, const EffectFit& b) {
      return std::pair(a.effect, a.shape) < std::pair(b.effect, b.shape);
    });
    for (const EffectFit& f : found) {
      const auto id = static_cast<std::size_t>(f.effect >= 0 ? f.effect : f.shape);
      effects.push_back(f.effect >= 0 ? plan.effects[id] : effect_of(plan.shapes[id]));
      const auto sharp = known.find({f.effect, f.shape});
      each.push_back(sharp != known.end() ? sharp->second
                     : f.effect >= 0      ? atlas_->fingerprints()[id]
                                          : shape_fingerprint(f.shape));
      amplitudes.push_back(f.amplitudes);
      name += (name.empty() ? "" : ", ") + std::string(f.effect >= 0 ? "effect " : "shape ") +
              std::to_string(id);
    }
    const bool camera =
        std::any_of(effects.begin(), effects.end(), [](const Effect& f) { return f.camera(); });
    if (camera || told.size() == kMostMeetings || !told.insert(name).second) break;
    const Fingerprint apart = together(each, amplitudes);
    const Fingerprint at_once =
        atlas_->fingerprint_about(apart.about, apart, together(effects),
                                  atlas_->calibrated(judged.observed.summary).point, name);
    Naming both = naming;
    both.add_meeting(found, at_once.at(apart.about), at_once.experiments);
    both.loosen(at_once.scatter);
    Explanation other = both.explain(residual);
    if (other.doubt > e.doubt) {
      // Their scatter says nothing, but what they do at once is known now.
      naming.add_meeting(found, at_once.at(apart.about), at_once.experiments);
      e = naming.explain(residual);
      continue;
    }
    naming = std::move(both), e = std::move(other);
  }
  return e;
}

Fingerprint Diagnoser::shape_fingerprint(int s) {
  return atlas_->fingerprint(effect_of(atlas_->plan().shapes[static_cast<std::size_t>(s)]),
                             "shape " + std::to_string(s),
                             derived_seed(options_.seed, 500 + static_cast<std::uint64_t>(s)));
}

}  // namespace lilytank
