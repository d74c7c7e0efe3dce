// From residuals to an explanation: curves beside the names, and fingerprints at the strength that
// was found.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "diagnose/diagnoser.hpp"

namespace lilytank {
namespace {

using Vector = Eigen::VectorXd;

constexpr double kLeastAmplitude = 0.2, kFirstRival = 0.35, kRival = 0.5, kNear = 0.85;
constexpr double kUsable = 2;  // sizes up to which a fingerprint is as good as it was learned
constexpr int kRivals = 3, kMostSharpened = 6, kMostCentred = 2;
constexpr double kBeside = 0.5;  // of the spread of experiments, that the likeliest may be off
constexpr std::size_t kMostMeetings = 3;
constexpr double kFurther = 1.5;  // from one range to the next that is tried
constexpr int kMostTries = 5;
constexpr double kNamesFirst = 30;  // of a doubt
constexpr double kClose = 60;       // likewise
constexpr int kMany = 30;           // experiments that decide a close call
constexpr double kLeastFall = 4;    // of a doubt, that makes a range the better one
constexpr double kCurveLeft = 0.4;  // of what was found, that a curve may be which is left
constexpr double kLeastOwn = 1;     // z of an effect by the scatter of experiments with it

// A distance between places, ranges by their logarithms.
double far_apart(const std::vector<std::pair<std::string, double>>& a,
                 const std::vector<std::pair<std::string, double>>& b) {
  if (a.size() == 1) return std::fabs(std::log(a[0].second / b[0].second));
  return std::hypot(a[0].second - b[0].second, a[1].second - b[1].second);
}

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
    const std::string& variable = effect(e.found[0]).variable;
    const auto same = std::find_if(shapes.begin(), shapes.end(), [&](const EffectFit& f) {
      return atlas_->plan().shapes[static_cast<std::size_t>(f.shape)].variable == variable;
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
  if (f.effect < 0 || f.amplitudes.cwiseAbs().maxCoeff() > kUsable) return false;
  const std::vector<EffectFit> leading = naming.leading(residual, kRivals + 3);
  return std::none_of(leading.begin(), leading.end(), [&](const EffectFit& other) {
    const bool same = other.effect >= 0 && effect(other).name == effect(f).name;
    return !same && other.gain > kNear * leading.front().gain;
  });
}

// Fingerprints are learned at sizes that can just be seen well; what is far stronger is judged by
// experiments of its own strength.
class Diagnoser::Sharpening {
 public:
  Sharpening(Diagnoser& diagnoser, Naming& naming, Judged& judged, const Vector& residual)
      : of_(diagnoser),
        naming_(naming),
        judged_(judged),
        residual_(residual),
        nothing_(diagnoser.naming_->misfit_of_nothing(residual)) {
    // What is scanned has one home, the nearest one that is known: its slopes begin as that one's.
    std::map<std::string, double> least;
    const std::vector<Effect>& effects = of_.atlas_->plan().effects;
    for (std::size_t e = 0; e < effects.size(); ++e) {
      const auto told = of_.scanned(effects[e], judged.details);
      if (!told) continue;
      const double off = far_apart(effects[e].shape, told->shape);
      const auto [at, first] = least.emplace(effects[e].name, off);
      if (!first && off >= at->second) continue;
      at->second = off, home_[effects[e].name] = static_cast<int>(e);
    }
  }

  // First those that might be it, then whatever leads, what is found and its rivals beside the
  // others.
  Explanation run() {
    const std::vector<EffectFit> leading = naming_.leading(residual_, kRivals);
    for (const EffectFit& f : leading) {
      if (blunt(f) && f.gain > kFirstRival * leading[0].gain) sharpen(f);
    }
    Explanation e = explained();
    e = settled(std::move(e));
    if (refine(e)) e = settled(explained());
    if (close_call()) e = settled(explained());
    return met(std::move(e));
  }

 private:
  using Name = std::pair<int, int>;  // effect and shape
  using Suspect = std::pair<const Name, Naming::Alone>;
  Name name_of(const EffectFit& f) const {
    if (f.effect < 0) return {f.effect, f.shape};
    const auto home = home_.find(of_.effect(f).name);
    return {home == home_.end() ? f.effect : home->second, f.shape};
  }

  // The sharpest that there is.
  Fingerprint fingerprint(const EffectFit& f) {
    const auto sharp = known_.find(name_of(f));
    if (sharp != known_.end()) return sharp->second;
    return f.effect >= 0 ? of_.atlas_->fingerprints()[static_cast<std::size_t>(f.effect)]
                         : of_.shape_fingerprint(f.shape);
  }

  void sharpen(EffectFit f, int experiments = Atlas::kAbout) {
    if (known_.count(name_of(f)) == 0) f = begun(f);
    const Fingerprint from = fingerprint(f);
    const Fingerprint to = of_.fingerprint_near(f, from, judged_, experiments);
    known_[name_of(f)] = to;
    naming_.sharpen(f, to);
    alone_[name_of(f)] = naming_.alone(residual_, f.effect, f.shape);
  }

  Explanation settled(Explanation e) {
    for (int more = 0; more < kMostSharpened; ++more) {
      const std::optional<EffectFit> next = next_after(e);
      if (!next) break;
      sharpen(*next);
      e = explained();
    }
    return e;
  }

  // Where the likeliest name leaves something, its law may have another range, time or length than
  // the experiments with it had. Each is sought up and down until it fits no better.
  bool refine(const Explanation& e) {
    const std::optional<EffectFit> name = likeliest(true);
    const bool curve = std::any_of(e.found.begin(), e.found.end(),
                                   [](const EffectFit& f) { return f.effect < 0; });
    if (!name || !(curve || naming_.leaves_something(e))) return false;
    bool better = false;
    for (const FitParameter& p : of_.effect(*name).refine) {
      if (!p.logarithmic) continue;
      for (const double factor : {kFurther, 1 / kFurther}) {
        bool further = false;
        while (tries_ < kMostTries && fits_better(*name, p, factor)) further = true;
        better = better || further;
        if (further) break;
      }
    }
    return better;
  }

  // Where the likeliest name and the likeliest curve are about as likely, more experiments with
  // each are to tell: by ten a doubt is known to some ten only.
  bool close_call() {
    const Suspect *name = nullptr, *curve = nullptr;
    for (const Suspect& one : alone_) {
      const Suspect*& best = one.first.first < 0 ? curve : name;
      if (best == nullptr || one.second.doubt < best->second.doubt) best = &one;
    }
    if (name == nullptr || curve == nullptr) return false;
    if (std::fabs(name->second.doubt - curve->second.doubt) > kClose) return false;
    for (const Name& of : {name->first, curve->first}) {
      EffectFit f;
      std::tie(f.effect, f.shape) = of;
      f.amplitudes = alone_.at(of).amplitudes;
      sharpen(f, kMany);
    }
    return true;
  }

  bool fits_better(const EffectFit& name, const FitParameter& p, double factor) {
    tries_ += 1;
    EffectFit f = name;
    f.amplitudes = alone_.at(name_of(f)).amplitudes;
    double now = 0;
    for (const auto& [path, value] : of_.found_effect(f, judged_.details).shape) {
      if (path == p.path) now = value;
    }
    const double next = std::clamp(now * factor, p.low, p.high);
    if (next == now) return false;
    const double doubt = alone_.at(name_of(f)).doubt;
    const auto before = std::tuple(known_, alone_, home_, naming_, judged_.details.refined);
    judged_.details.refined[p.path] = next;
    home_[of_.effect(f).name] = name_of(f).first;
    sharpen(f);
    f.amplitudes = alone_.at(name_of(f)).amplitudes;
    if (off_centre(f, kBeside)) sharpen(f);
    if (alone_.at(name_of(f)).doubt < doubt - kLeastFall) return true;
    std::tie(known_, alone_, home_, naming_, judged_.details.refined) = before;
    return false;
  }

  // Where its first experiments are to be.
  EffectFit begun(EffectFit f) {
    f.effect = name_of(f).first;
    if (f.shape >= 0) {
      f.amplitudes = of_.knots_of(f.shape, fingerprint(f), residual_);
    } else if (const auto told = of_.scanned(of_.effect(f), judged_.details);
               told && told->amplitudes) {
      f.amplitudes = *told->amplitudes;
    } else if (const auto own = of_.strong_by_own_scores(f.effect, judged_)) {
      f.amplitudes = *own;
    }
    return f;
  }

  // What alone, by its own scatter, is most likely there. The scatter of ten experiments leaves a
  // doubt uncertain, and a curve has more ways to be near: names come first.
  std::optional<EffectFit> likeliest(bool effects_only = false) const {
    const auto doubt = [](const auto& one) {
      return one.second.doubt + (one.first.first < 0 ? kNamesFirst : 0);
    };
    const auto least = [&](const auto& a, const auto& b) { return doubt(a) < doubt(b); };
    std::map<Name, Naming::Alone> those = alone_;
    if (effects_only) {
      std::erase_if(those, [](const auto& one) { return one.first.first < 0; });
    }
    const auto likely = std::min_element(those.begin(), those.end(), least);
    if (likely == those.end()) return std::nullopt;
    EffectFit out;
    std::tie(out.effect, out.shape) = likely->first;
    out.amplitudes = likely->second.amplitudes;
    return out;
  }

  // Judged by the scatter of the experiments with what is likeliest. These are to be where it is,
  // and so are those of the likeliest name: off it, a curve would seem to fit better.
  Explanation explained() {
    for (int pass = 0; pass < kMostCentred; ++pass) {
      bool moved = false;
      for (const bool effects_only : {false, true}) {
        const std::optional<EffectFit> likely = likeliest(effects_only);
        if (!likely || !off_centre(*likely, kBeside)) continue;
        sharpen(*likely), moved = true;
      }
      if (!moved) break;
    }
    const std::optional<EffectFit> likely = likeliest();
    if (likely) naming_.loosen(known_[name_of(*likely)].scatter);
    return explained_by(naming_);
  }

  // What adds up from others has to be likelier than an effect that is; curves can do so much that
  // they come after names.
  Explanation explained_by(const Naming& naming) const {
    const std::optional<EffectFit> likely = likeliest();
    Explanation e = naming.explain(residual_);
    if (e.found.empty() && likely && nothing_ > naming.misfit_threshold()) {
      return something(naming, likeliest(true).value_or(*likely));
    }
    if (!likely || likely->shape >= 0 || is_found(*likely, e)) return e;
    Explanation other = naming.explain(residual_, {*likely});
    if (leaves_curve(naming, other) && !naming.leaves_something(e)) return e;
    return other.doubt < e.doubt ? other : e;
  }

  // By the wide scatter of experiments with an effect there may seem to be nothing; but without an
  // effect there is no such scatter. What hardly speaks even so is not told.
  Explanation something(const Naming& naming, const EffectFit& likely) const {
    Explanation e = naming.explain(residual_, {likely});
    if (e.found.empty() || e.found[0].z < kLeastOwn) {
      e.found.clear(), e.misfit = nothing_, e.share_left = 1;
    }
    return e;
  }

  // Whether a curve is left that is not much weaker than what was found: more than what a
  // fingerprint is wrong by.
  bool leaves_curve(const Naming& naming, const Explanation& e) const {
    double largest = 0;
    for (const EffectFit& f : e.found) largest = std::max(largest, f.z);
    return e.left_shape.z > std::max(naming.shape_threshold(), kCurveLeft * largest);
  }

  bool is_found(const EffectFit& f, const Explanation& e) const {
    return std::any_of(e.found.begin(), e.found.end(),
                       [&](const EffectFit& other) { return name_of(other) == name_of(f); });
  }

  bool blunt(const EffectFit& f) const {
    const bool told = known_.count(name_of(f)) > 0;
    return f.amplitudes.norm() > kLeastAmplitude && (!told || f.at_reach);
  }

  // What is found should be where its experiments were, not beside them. `far`: in their spread.
  bool off_centre(const EffectFit& f, double far = 1) const {
    const auto sharp = known_.find(name_of(f));
    if (sharp == known_.end() || f.shape >= 0) return false;
    const Vector& about = sharp->second.about;
    return (f.amplitudes - about).cwiseQuotient(apart(about)).cwiseAbs().maxCoeff() > far;
  }

  std::optional<EffectFit> next_after(const Explanation& e) {
    // Those that were judged so already take no other's place.
    std::vector<EffectFit> next =
        naming_.leading(residual_, kRivals + static_cast<int>(known_.size()));
    next.erase(std::remove_if(next.begin() + 1, next.end(),
                              [&](const EffectFit& f) { return f.gain < kRival * next[0].gain; }),
               next.end());
    const std::vector<EffectFit> rivals = naming_.rivals(residual_, e.found, kRival, kRivals);
    next.insert(next.end(), rivals.begin(), rivals.end());
    for (const EffectFit& f : next) {
      if (blunt(f)) return f;
    }
    for (const EffectFit& f : e.found) {
      if (off_centre(f) && centred_.insert(name_of(f)).second) return f;  // once is enough
    }
    return std::nullopt;
  }

  // Several effects need not add up: modules that one holds together another cannot move apart.
  // What they do at once is simulated as well.
  Explanation met(Explanation e) {
    std::set<std::string> told;
    while (e.found.size() > 1 && told.size() < kMostMeetings) {
      std::vector<EffectFit> found = e.found;
      std::sort(found.begin(), found.end(),
                [this](const EffectFit& a, const EffectFit& b) { return name_of(a) < name_of(b); });
      std::string name;
      for (const EffectFit& f : found) {
        name += (name.empty() ? "" : ", ") + of_.stage_name(f, judged_.details);
      }
      const bool camera = std::any_of(found.begin(), found.end(), [&](const EffectFit& f) {
        return of_.found_effect(f, judged_.details).camera();
      });
      if (camera || !told.insert(name).second) break;
      const Fingerprint at_once = simulated(found, name);
      Naming both = naming_;
      both.add_meeting(found, at_once.base, at_once.experiments);
      // Without their scatter if it does not make them likelier.
      naming_ = both;
      both.loosen(at_once.scatter);
      Explanation loose = explained_by(both);
      if (loose.doubt <= e.doubt) {
        naming_ = std::move(both), e = std::move(loose);
      } else {
        e = explained_by(naming_);
      }
    }
    return e;
  }

  // By experiments with all of them, about these amplitudes.
  Fingerprint simulated(const std::vector<EffectFit>& found, const std::string& name) {
    std::vector<Effect> effects;
    std::vector<Fingerprint> each;
    std::vector<Vector> at;
    for (const EffectFit& f : found) {
      effects.push_back(of_.found_effect(f, judged_.details)), each.push_back(fingerprint(f)),
          at.push_back(f.amplitudes);
    }
    const Fingerprint sum = together(each, at);
    Fingerprint out =
        of_.atlas_->fingerprint_about(sum.about, sum, together(effects),
                                      of_.atlas_->calibrated(judged_.observed.summary).point, name);
    out.base = out.at(sum.about), out.about = sum.about;
    return out;
  }

  Diagnoser& of_;
  Naming& naming_;
  Judged& judged_;
  const Vector& residual_;
  double nothing_;                     // squared distance of nothing, by the scatter of nulls
  std::map<std::string, int> home_;    // the effect that stands for all of a name
  std::map<Name, Fingerprint> known_;  // fingerprints about found amplitudes
  std::map<Name, Naming::Alone> alone_;
  std::set<Name> centred_;
  int tries_ = 0;
};

Explanation Diagnoser::sharpened(Naming& naming, Explanation e, Judged& judged,
                                 const Vector& residual) {
  if (e.found.empty() || plain(naming, e, residual)) return e;
  return Sharpening(*this, naming, judged, residual).run();
}

}  // namespace lilytank
