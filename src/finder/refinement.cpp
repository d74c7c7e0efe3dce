// From residuals to a selected model: curves compete with named effects, and fingerprints are
// measured again at the estimated strength.
#include <algorithm>
#include <cmath>

#include "finder/refinement.hpp"
#include "finder/scan.hpp"
#include "scores/scores.hpp"
#include "statistics/largest_first.hpp"

namespace lilytank {
namespace {

using Vector = Eigen::VectorXd;

constexpr double kLeastAmplitude = 0.2, kFirstRival = 0.35, kRival = 0.5, kNearGain = 0.85;
constexpr double kUsable = 2;  // sizes up to which a fingerprint is as good as it was learned
constexpr int kRivals = 3, kMostRefined = 6;
constexpr int kMostMoved = 3;       // times that one fingerprint follows the amplitudes it finds
constexpr double kClearGain = 100;  // twice a log-likelihood: amplitudes that the filter knows well

bool is_clear(const Effect& effect, const JointAmplitudes& own) {
  return own.gain > kClearGain && (effect.two_sided || own.estimate.minCoeff() > 0);
}

// Whether something is found, and none of it pushes or turns modules on average.
bool only_noise(const ScorePlan& plan, const std::vector<EffectFit>& found) {
  return !found.empty() && std::ranges::none_of(found, [&](const EffectFit& f) {
    return f.effect < 0 || effect_in(plan, f).mean_force;
  });
}

// Distance between parameter values; ranges on a log scale.
double far_apart(const std::vector<HeldParameter>& a, const std::vector<HeldParameter>& b) {
  if (a.size() == 1) return std::fabs(std::log(a[0].value / b[0].value));
  return std::hypot(a[0].value - b[0].value, a[1].value - b[1].value);
}

// Whether one effect of a measured size explains the whole mismatch, without a remainder or a
// competitor.
bool is_plain(const ScorePlan& plan, const ModelSelection& selection, const SelectedModel& e,
              const Vector& residual) {
  const EffectFit& f = e.found.front();
  if (e.found.size() > 1 || selection.leaves_residual(e)) return false;
  if (f.effect < 0 || f.amplitudes.cwiseAbs().maxCoeff() > kUsable) return false;
  const std::vector<EffectFit> leading = selection.leading(residual, kRivals + 3);
  return std::none_of(leading.begin(), leading.end(), [&](const EffectFit& other) {
    const bool named = other.effect >= 0;
    if (named && effect_in(plan, other).family == effect_in(plan, f).family) return false;
    // By simulations alone a fault of the control is known less well than a force.
    const bool control =
        effect_in(plan, f).control() || (named && effect_in(plan, other).control());
    return other.gain > (control ? kRival : kNearGain) * leading.front().gain;
  });
}

}  // namespace

Refinement::Refinement(const RefinementInput& input, const RefinedSelection& start)
    : ensemble_(input.ensemble),
      plan_(input.ensemble.plan()),
      sensitivity_(input.sensitivity),
      residual_(input.residual),
      calibrated_(input.ensemble.calibrated(input.observed.summary)),
      scan_model_(input.calibrated),
      baseline_misfit_(input.baseline_misfit),
      threads_(input.threads),
      state_{start.selection, start.details, {}, {}} {
  find_homes();
}

// A scanned effect starts with the slopes of its nearest known fingerprint.
void Refinement::find_homes() {
  std::map<int, double> least;
  const std::vector<Effect>& effects = plan_.effects;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const auto direct = scanned(effects[e], state_.details);
    if (!direct) continue;
    const double off = far_apart(effects[e].held, direct->held);
    const auto [at, first] = least.emplace(effects[e].family, off);
    if (!first && off >= at->second) continue;
    at->second = off, state_.home[effects[e].family] = static_cast<int>(e);
  }
}

RefinedSelection Refinement::run(const std::optional<PlaceFinding>& by_place) {
  if (by_place) {
    for (const ClearPlace& one : by_place->clear) refine_fingerprint(fit_at_place(one.fit));
  }
  const std::vector<EffectFit> leading = state_.selection.leading(residual_, kRivals);
  for (const EffectFit& f : leading) {
    if (needs_relinearization(f) && f.gain > kFirstRival * leading[0].gain) refine_fingerprint(f);
  }
  for (const EffectFit& f : clearest()) {
    if (needs_relinearization(f)) refine_fingerprint(f);
  }
  SelectedModel m = settled(selected());
  if (rescan(m)) m = settled(selected());
  if (refine_ranges(m)) m = settled(selected());
  if (close_call() || close_faults() || made_sure(m)) m = settled(selected());
  m = with_interactions(std::move(m));
  std::optional<PlaceFinding> only;
  if (by_place) {
    only = likeliest_first(*by_place);
    const EffectFit likeliest = fit_at_place(only->clear.front().fit);
    if (only_noise(plan_, m.found)) {
      SelectedModel with = state_.selection.select(residual_, {likeliest});
      if (with.found.size() == 1) m = std::move(with);
    }
    if (shows_only(m, likeliest)) {
      m.found = {likeliest};
    } else {
      only.reset();
    }
  }
  std::vector<EffectFit> alike = alike_faults(m);
  return {std::move(m), std::move(state_.selection), std::move(state_.details), std::move(only),
          std::move(alike)};
}

EffectFit Refinement::fit_at_place(const EffectFit& clear) {
  const Id id = id_of(clear);
  EffectFit out = fit_with(id, scanned(effect(id), state_.details)->amplitudes->estimate);
  out.z = clear.z, out.gain = clear.gain;
  if (const RefinedCandidate* known = refined(out)) {
    out.about = known->fingerprint.experiments;
    out.moved = known->fingerprint.moved(out.amplitudes);
  }
  return out;
}

bool Refinement::shows_only(const SelectedModel& m, const EffectFit& f) const {
  if (m.found.empty()) return true;
  return m.found.size() == 1 && id_of(m.found[0]) == id_of(f) &&
         m.found[0].z < state_.selection.effect_threshold();
}

PlaceFinding Refinement::likeliest_first(PlaceFinding of) const {
  std::ranges::stable_sort(of.clear, std::ranges::greater{}, [this](const ClearPlace& one) {
    return scanned(effect(id_of(one.fit)), state_.details)->amplitudes->gain;
  });
  return of;
}

Refinement::Id Refinement::id_of(const EffectFit& f) const {
  if (f.effect < 0) return {f.effect, f.shape};
  const auto home = state_.home.find(effect_in(plan_, f).family);
  return {home == state_.home.end() ? f.effect : home->second, f.shape};
}

EffectFit Refinement::fit_with(const Id& id, const Vector& amplitudes) {
  EffectFit out;
  out.effect = id.first, out.shape = id.second;
  out.amplitudes = amplitudes;
  return out;
}

const RefinedCandidate* Refinement::refined(const EffectFit& f) const {
  const auto found = state_.refined.find(id_of(f));
  return found == state_.refined.end() ? nullptr : &found->second;
}

Fingerprint Refinement::fingerprint(const EffectFit& f) {
  if (const RefinedCandidate* known = refined(f)) return known->fingerprint;
  if (f.effect < 0)
    return sensitivity_.aligned(ensemble_.shape_fingerprint(f.shape), found_effect(f));
  const auto e = static_cast<std::size_t>(f.effect);
  return sensitivity_.aligned(ensemble_.fingerprints()[e], plan_.effects[e]);
}

void Refinement::forget(int family) {
  const auto concerns = [&](const Id& id) { return id.first >= 0 && effect(id).family == family; };
  std::erase_if(filtered_, [&](const auto& one) { return concerns(one.first); });
  for (auto known = state_.refined.begin(); known != state_.refined.end();) {
    if (!concerns(known->first)) {
      ++known;
      continue;
    }
    const EffectFit f = fit_with({known->first.first, -1}, {});
    known = state_.refined.erase(known);
    state_.selection.set_fingerprint(f, fingerprint(f));
  }
}

void Refinement::refine_fingerprint(EffectFit f, int experiments) {
  if (refined(f) == nullptr) f = first_guess(f);
  const Fingerprint from = fingerprint(f);
  f.amplitudes = halfway(f, from);
  const Effect effect = found_effect(f);
  const Fingerprint about = ensemble_.fingerprint_about(f.amplitudes, from, effect, calibrated_,
                                                        stage_name(f), learned_, experiments);
  RefinedCandidate& own = state_.refined[id_of(f)];
  own.fingerprint = sensitivity_.aligned(about, effect);
  state_.selection.set_fingerprint(f, own.fingerprint);
  own.alone = state_.selection.fit_alone(residual_, f.effect, f.shape);
}

// Halves a step that reverses the last one: two places may point to each other.
Vector Refinement::halfway(const EffectFit& f, const Fingerprint& from) {
  const auto own = state_.refined.find(id_of(f));
  if (own == state_.refined.end()) return f.amplitudes;
  Vector step = f.amplitudes - from.about;
  Vector& last = own->second.step;
  if (last.size() > 0 && step.dot(last) < 0) step *= 0.5;
  last = step;
  return from.about + step;
}

SelectedModel Refinement::settled(SelectedModel m) {
  for (int more = 0; more < kMostRefined; ++more) {
    const std::optional<EffectFit> next = next_after(m);
    if (!next) break;
    refine_fingerprint(*next);
    state_.refined.at(id_of(*next)).moves += 1;
    m = selected();
  }
  return m;
}

EffectFit Refinement::first_guess(EffectFit f) {
  f.effect = id_of(f).first;
  const Effect effect = found_effect(f);
  if (!effect.mean_force) return f;
  const JointAmplitudes& own = filtered(f, effect);
  if (is_clear(effect, own)) f.amplitudes = own.estimate;
  return f;
}

const JointAmplitudes& Refinement::filtered(const EffectFit& f, const Effect& effect) {
  const auto known = filtered_.find(id_of(f));
  if (known != filtered_.end()) return known->second;
  auto linear = joint_amplitudes(plan_, sensitivity_.recordings(), {effect});
  return filtered_[id_of(f)] = scanned_or(std::move(linear.front()), effect);
}

JointAmplitudes Refinement::scanned_or(JointAmplitudes linear, const Effect& effect) const {
  const auto direct = scanned(effect, state_.details);
  return direct && direct->amplitudes ? *direct->amplitudes : std::move(linear);
}

// Far beyond the measured sizes the fingerprints are unreliable; the filter's ranking is used.
std::vector<EffectFit> Refinement::clearest() {
  std::map<Id, Effect> of;
  const std::vector<Effect>& effects = plan_.effects;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    if (!effects[e].mean_force) continue;
    const Id id = id_of(fit_with({static_cast<int>(e), -1}, {}));
    of.emplace(id, found_effect(fit_with(id, {})));
  }
  std::vector<Effect> tried;
  for (const auto& [id, effect] : of) tried.push_back(effect);
  const auto linear = joint_amplitudes(plan_, sensitivity_.recordings(), tried);
  std::vector<EffectFit> out;
  for (const auto& [id, effect] : of) {
    const JointAmplitudes& one = filtered_[id] = scanned_or(linear[out.size()], effect);
    EffectFit f = fit_with(id, one.estimate);
    f.gain = is_clear(effect, one) ? one.gain : 0;
    out.push_back(std::move(f));
  }
  largest_first(out, &EffectFit::gain);
  if (out.size() > kRivals) out.resize(kRivals);
  const double least = std::max(kClearGain, kRival * out.front().gain);
  std::erase_if(out, [&](const EffectFit& f) { return f.gain < least; });
  return out;
}

bool Refinement::needs_relinearization(const EffectFit& f) const {
  if (!(f.amplitudes.norm() > kLeastAmplitude)) return false;
  const RefinedCandidate* known = refined(f);
  return known == nullptr || (f.at_bound && off_centre(f) && known->moves < kMostMoved);
}

bool Refinement::off_centre(const EffectFit& f, double far) const {
  const RefinedCandidate* known = refined(f);
  if (known == nullptr) return false;
  const Vector& about = known->fingerprint.about;
  return (f.amplitudes - about).cwiseQuotient(apart(found_effect(f), about)).cwiseAbs().maxCoeff() >
         far;
}

std::optional<EffectFit> Refinement::next_after(const SelectedModel& m) {
  // Candidates already measured so are not counted again.
  std::vector<EffectFit> next =
      state_.selection.leading(residual_, kRivals + static_cast<int>(state_.refined.size()));
  next.erase(std::remove_if(next.begin() + 1, next.end(),
                            [&](const EffectFit& f) { return f.gain < kRival * next[0].gain; }),
             next.end());
  const std::vector<EffectFit> rivals =
      state_.selection.rivals(residual_, m.found, kRival, kRivals);
  next.insert(next.end(), rivals.begin(), rivals.end());
  for (const EffectFit& f : next) {
    if (needs_relinearization(f)) return f;
  }
  for (const EffectFit& f : m.found) {
    if (!off_centre(f) || refined(f)->centred) continue;
    state_.refined.at(id_of(f)).centred = true;  // once is enough
    return f;
  }
  return std::nullopt;
}

RefinedSelection refined_selection(const RefinementInput& input, RefinedSelection start) {
  const ScorePlan& plan = input.ensemble.plan();
  const std::vector<Recording>& recordings = input.sensitivity.recordings();
  std::optional<PlaceFinding> by_place;
  // A stream between the places of the plan may look like noise that modules share.
  if (start.model.found.empty() || only_noise(plan, start.model.found)) {
    by_place = find_clear_place(input.ensemble, recordings, start.selection.effect_threshold(),
                                kOfPlaces * input.false_alarms);
    if (!by_place && start.model.found.empty()) return start;
  }
  ScorePlan scan = plan;
  scan.model = input.calibrated;
  start.details.scans = scans_of(scan, recordings, input.threads);
  if (!by_place && is_plain(plan, start.selection, start.model, input.residual)) return start;
  return Refinement(input, start).run(by_place);
}

}  // namespace lilytank
