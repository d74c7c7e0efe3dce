// From residuals to an explanation: curves beside the names, and fingerprints at the strength that
// was found.
#include <algorithm>
#include <cmath>

#include "finder/scan.hpp"
#include "finder/scores.hpp"
#include "finder/sharpening.hpp"

namespace lilytank {
namespace {

using Vector = Eigen::VectorXd;

constexpr double kLeastAmplitude = 0.2, kFirstRival = 0.35, kRival = 0.5, kNearGain = 0.85;
constexpr double kUsable = 2;  // sizes up to which a fingerprint is as good as it was learned
constexpr int kRivals = 3, kMostSharpened = 6;
constexpr int kMostMoved = 3;       // times that one fingerprint follows the amplitudes it finds
constexpr double kClearGain = 100;  // twice a log-likelihood: amplitudes that the filter tells well

bool tells(const Effect& effect, const JointAmplitudes& own) {
  return own.gain > kClearGain && (effect.two_sided || own.estimate.minCoeff() > 0);
}

// A distance between places, ranges by their logarithms.
double far_apart(const std::vector<HeldParameter>& a, const std::vector<HeldParameter>& b) {
  if (a.size() == 1) return std::fabs(std::log(a[0].value / b[0].value));
  return std::hypot(a[0].value - b[0].value, a[1].value - b[1].value);
}

}  // namespace

// Named effects first; a shape competes with them where they leave something.
SelectedModel Diagnoser::explained(ModelSelection& selection, Alignment& alignment,
                                   const Vector& residual) {
  SelectedModel e = selection.select(residual);
  const std::vector<EffectFit> shapes = selection.shapes(residual);
  std::vector<int> asked;
  if (shapes[0].z > selection.shape_threshold() &&
      (e.found.empty() || shapes[0].z > e.found[0].z)) {
    asked.push_back(shapes[0].shape);
  }
  double largest = 0;
  for (const EffectFit& f : e.found) largest = std::max(largest, f.z);
  if (e.left_shape.z > std::max(selection.shape_threshold(), 0.15 * largest)) {
    if (asked.empty() || asked[0] != e.left_shape.shape) asked.push_back(e.left_shape.shape);
  }
  // What leaves much may be a law of the same variable.
  if (!e.found.empty() && e.found[0].effect >= 0 && e.misfit > selection.misfit_threshold()) {
    const std::string& variable = effect(e.found[0]).variable;
    const auto same = std::find_if(shapes.begin(), shapes.end(), [&](const EffectFit& f) {
      return atlas_->plan().shapes[static_cast<std::size_t>(f.shape)].variable == variable;
    });
    if (same != shapes.end() && std::find(asked.begin(), asked.end(), same->shape) == asked.end()) {
      asked.push_back(same->shape);
    }
  }
  for (const int s : asked) {
    const Effect curve = effect_of(atlas_->plan().shapes[static_cast<std::size_t>(s)]);
    selection.add_shape(s, alignment.aligned(shape_fingerprint(s), curve));
  }
  return asked.empty() ? e : selection.select(residual);
}

// One effect of a size like those that were simulated explains all there is, leaves nothing, and
// nothing else comes near.
bool Diagnoser::plain(const ModelSelection& selection, const SelectedModel& e,
                      const Vector& residual) const {
  const EffectFit& f = e.found.front();
  if (e.found.size() > 1 || selection.leaves_residual(e)) return false;
  if (f.effect < 0 || f.amplitudes.cwiseAbs().maxCoeff() > kUsable) return false;
  const std::vector<EffectFit> leading = selection.leading(residual, kRivals + 3);
  return std::none_of(leading.begin(), leading.end(), [&](const EffectFit& other) {
    const bool same = other.effect >= 0 && effect(other).family == effect(f).family;
    return !same && other.gain > kNearGain * leading.front().gain;
  });
}

Diagnoser::Sharpening::Sharpening(Diagnoser& diagnoser, ModelSelection& selection,
                                  Alignment& alignment, Judged& judged, const Vector& residual)
    : of_(diagnoser),
      selection_(selection),
      alignment_(alignment),
      judged_(judged),
      residual_(residual),
      nothing_(diagnoser.selection_->baseline_misfit(residual)) {
  find_homes();
}

// What is scanned has one home, the nearest one that is known: its slopes begin as that one's.
void Diagnoser::Sharpening::find_homes() {
  std::map<int, double> least;
  const std::vector<Effect>& effects = of_.atlas_->plan().effects;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const auto told = of_.scanned(effects[e], judged_.details);
    if (!told) continue;
    const double off = far_apart(effects[e].held, told->held);
    const auto [at, first] = least.emplace(effects[e].family, off);
    if (!first && off >= at->second) continue;
    at->second = off, home_[effects[e].family] = static_cast<int>(e);
  }
}

SelectedModel Diagnoser::Sharpening::run() {
  const std::vector<EffectFit> leading = selection_.leading(residual_, kRivals);
  for (const EffectFit& f : leading) {
    if (blunt(f) && f.gain > kFirstRival * leading[0].gain) sharpen(f);
  }
  for (const EffectFit& f : clearest()) {
    if (blunt(f)) sharpen(f);
  }
  SelectedModel e = explained();
  e = settled(std::move(e));
  if (rescan(e)) e = settled(explained());
  if (refine(e)) e = settled(explained());
  if (close_call() || made_sure(e)) e = settled(explained());
  return met(std::move(e));
}

Diagnoser::Sharpening::Name Diagnoser::Sharpening::name_of(const EffectFit& f) const {
  if (f.effect < 0) return {f.effect, f.shape};
  const auto home = home_.find(of_.effect(f).family);
  return {home == home_.end() ? f.effect : home->second, f.shape};
}

Fingerprint Diagnoser::Sharpening::fingerprint(const EffectFit& f) {
  const auto sharp = known_.find(name_of(f));
  if (sharp != known_.end()) return sharp->second;
  if (f.effect < 0) {
    return alignment_.aligned(of_.shape_fingerprint(f.shape), of_.found_effect(f, judged_.details));
  }
  const auto e = static_cast<std::size_t>(f.effect);
  return alignment_.aligned(of_.atlas_->fingerprints()[e], of_.atlas_->plan().effects[e]);
}

void Diagnoser::Sharpening::forget(int family) {
  const std::vector<Effect>& effects = of_.atlas_->plan().effects;
  const auto concerns = [&](const Name& one) {
    return one.first >= 0 && effects[static_cast<std::size_t>(one.first)].family == family;
  };
  std::erase_if(own_, [&](const auto& one) { return concerns(one.first); });
  for (auto known = known_.begin(); known != known_.end();) {
    if (!concerns(known->first)) {
      ++known;
      continue;
    }
    alone_.erase(known->first), centred_.erase(known->first);
    moved_.erase(known->first), step_.erase(known->first);
    EffectFit f;
    f.effect = known->first.first;
    known = known_.erase(known);
    selection_.set_fingerprint(f, fingerprint(f));
  }
}

void Diagnoser::Sharpening::sharpen(EffectFit f, int experiments) {
  if (known_.count(name_of(f)) == 0) f = begun(f);
  const Fingerprint from = fingerprint(f);
  f.amplitudes = halfway(f, from);
  const Fingerprint to =
      alignment_.aligned(of_.fingerprint_near(f, from, judged_, learned_, experiments),
                         of_.found_effect(f, judged_.details));
  known_[name_of(f)] = to;
  selection_.set_fingerprint(f, to);
  alone_[name_of(f)] = selection_.fit_alone(residual_, f.effect, f.shape);
}

// Two places may each point to the other: a step back is half as long.
Vector Diagnoser::Sharpening::halfway(const EffectFit& f, const Fingerprint& from) {
  if (known_.count(name_of(f)) == 0) return f.amplitudes;
  Vector step = f.amplitudes - from.about;
  const auto last = step_.find(name_of(f));
  if (last != step_.end() && step.dot(last->second) < 0) step *= 0.5;
  step_[name_of(f)] = step;
  return from.about + step;
}

SelectedModel Diagnoser::Sharpening::settled(SelectedModel e) {
  for (int more = 0; more < kMostSharpened; ++more) {
    const std::optional<EffectFit> next = next_after(e);
    if (!next) break;
    moved_[name_of(*next)] += 1;
    sharpen(*next);
    e = explained();
  }
  return e;
}

EffectFit Diagnoser::Sharpening::begun(EffectFit f) {
  f.effect = name_of(f).first;
  const Effect effect = of_.found_effect(f, judged_.details);
  if (!effect.mean_force) return f;
  const JointAmplitudes& told = own(f, effect);
  if (tells(effect, told)) f.amplitudes = told.estimate;
  return f;
}

const JointAmplitudes& Diagnoser::Sharpening::own(const EffectFit& f, const Effect& effect) {
  const auto known = own_.find(name_of(f));
  if (known != own_.end()) return known->second;
  auto told = joint_amplitudes(of_.atlas_->plan(), alignment_.recordings(), {effect});
  return own_[name_of(f)] = scanned_or(std::move(told.front()), effect);
}

JointAmplitudes Diagnoser::Sharpening::scanned_or(JointAmplitudes linear,
                                                  const Effect& effect) const {
  const auto told = of_.scanned(effect, judged_.details);
  return told && told->amplitudes ? *told->amplitudes : std::move(linear);
}

// Far beyond the sizes that fingerprints were learned at, these lead astray; the filter does not.
std::vector<EffectFit> Diagnoser::Sharpening::clearest() {
  std::map<Name, Effect> of;
  const std::vector<Effect>& effects = of_.atlas_->plan().effects;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    if (!effects[e].mean_force) continue;
    EffectFit f;
    f.effect = static_cast<int>(e), f.effect = name_of(f).first;
    of.emplace(name_of(f), of_.found_effect(f, judged_.details));
  }
  std::vector<Effect> tried;
  for (const auto& [name, effect] : of) tried.push_back(effect);
  const auto told = joint_amplitudes(of_.atlas_->plan(), alignment_.recordings(), tried);
  std::vector<EffectFit> out;
  for (const auto& [name, effect] : of) {
    const JointAmplitudes& one = own_[name] = scanned_or(told[out.size()], effect);
    EffectFit f;
    f.effect = name.first, f.amplitudes = one.estimate;
    f.gain = tells(effect, one) ? one.gain : 0;
    out.push_back(std::move(f));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const EffectFit& a, const EffectFit& b) { return a.gain > b.gain; });
  if (out.size() > kRivals) out.resize(kRivals);
  const double least = std::max(kClearGain, kRival * out.front().gain);
  std::erase_if(out, [&](const EffectFit& f) { return f.gain < least; });
  return out;
}

bool Diagnoser::Sharpening::blunt(const EffectFit& f) const {
  if (!(f.amplitudes.norm() > kLeastAmplitude)) return false;
  if (known_.count(name_of(f)) == 0) return true;
  const auto times = moved_.find(name_of(f));
  return f.at_bound && off_centre(f) && (times == moved_.end() || times->second < kMostMoved);
}

bool Diagnoser::Sharpening::off_centre(const EffectFit& f, double far) const {
  const auto sharp = known_.find(name_of(f));
  if (sharp == known_.end()) return false;
  const Vector& about = sharp->second.about;
  return (f.amplitudes - about).cwiseQuotient(apart(about)).cwiseAbs().maxCoeff() > far;
}

std::optional<EffectFit> Diagnoser::Sharpening::next_after(const SelectedModel& e) {
  // Those that were judged so already take no other's place.
  std::vector<EffectFit> next =
      selection_.leading(residual_, kRivals + static_cast<int>(known_.size()));
  next.erase(std::remove_if(next.begin() + 1, next.end(),
                            [&](const EffectFit& f) { return f.gain < kRival * next[0].gain; }),
             next.end());
  const std::vector<EffectFit> rivals = selection_.rivals(residual_, e.found, kRival, kRivals);
  next.insert(next.end(), rivals.begin(), rivals.end());
  for (const EffectFit& f : next) {
    if (blunt(f)) return f;
  }
  for (const EffectFit& f : e.found) {
    if (off_centre(f) && centred_.insert(name_of(f)).second) return f;  // once is enough
  }
  return std::nullopt;
}

SelectedModel Diagnoser::sharpened(ModelSelection& selection, Alignment& alignment, SelectedModel e,
                                   Judged& judged, const Vector& residual) {
  if (e.found.empty()) return e;
  judged.details.scans = scans_of(atlas_->plan(), alignment.recordings(), options_.threads);
  if (plain(selection, e, residual)) return e;
  return Sharpening(*this, selection, alignment, judged, residual).run();
}

}  // namespace lilytank
