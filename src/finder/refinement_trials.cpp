// Further experiments with the findings: other ranges, more replicates, several effects at once.
#include <algorithm>
#include <cmath>
#include <set>

#include "finder/refinement.hpp"
#include "finder/scan.hpp"

namespace lilytank {
namespace {

using Vector = Eigen::VectorXd;

constexpr std::size_t kMostInteractions = 3;
constexpr double kStrong = 12;       // z of an effect beside which others are looked for anew
constexpr double kElsewhere = 0.02;  // m, by which a stream or patch is another one
constexpr double kOtherRange = 1.4;  // likewise of a force between modules, a factor
constexpr double kFurther = 1.5;     // from one range to the next that is tried
constexpr int kMostTries = 7;
constexpr int kMostFollowed = 4;  // times that experiments with a fault follow its estimate
constexpr double kClose = 60;     // of a penalised deviance
constexpr int kMany = 30;         // experiments that decide a close call
// Of penalised deviances, below which two faults are alike. The means of 30 experiments leave a
// difference uncertain: sqrt(8 numbers / 30) is 5.8 for 128 numbers.
constexpr double kSameFault = 10;
constexpr double kLeastFall = 4;  // of a penalised deviance, that makes a range the better one

}  // namespace

ScorePlan Refinement::beside(const SelectedModel& m, const Effect& scanned) const {
  ScorePlan plan = plan_;
  plan.model = scan_model_;
  for (const EffectFit& f : m.found) {
    const Effect effect = found_effect(f);
    const bool own = f.effect < 0 ? effect.variable == scanned.variable : effect.is_of(scanned);
    if (f.z > kStrong && effect.mean_force && !own) plan.beside.push_back(effect);
  }
  return plan;
}

bool Refinement::rescan(const SelectedModel& m) {
  bool moved = false;
  std::set<int> done;
  for (const Effect& one : plan_.effects) {
    if (one.estimated == Estimated::place && done.insert(one.family).second) {
      moved = rescan_place(m, one) || moved;
    }
  }
  for (const Effect& one : plan_.effects) {
    if (one.scanned_from > 0 && done.insert(one.family).second) moved = rescan(m, one) || moved;
  }
  return moved;
}

bool Refinement::rescan_place(const SelectedModel& m, const Effect& effect) {
  const ScorePlan plan = beside(m, effect);
  if (plan.beside.empty()) return false;
  PlaceScan& was = state_.details.scans.places[effect.term];
  PlaceScan now = find_place(plan, effect, sensitivity_.recordings(), threads_);
  if (!(std::hypot(now.best.x - was.best.x, now.best.y - was.best.y) > kElsewhere)) return false;
  was = std::move(now);
  find_homes(), forget(effect.family);
  return true;
}

bool Refinement::rescan(const SelectedModel& m, const Effect& scanned) {
  const ScorePlan plan = beside(m, scanned);
  if (plan.beside.empty()) return false;
  const auto all = find_values(plan, sensitivity_.recordings());
  const auto now = all.find(scanned.term);
  if (now == all.end()) return false;
  ScannedValue& was = state_.details.scans.values[now->first];
  const double further = now->second.value / std::max(was.value, 1e-9);
  if (now->second.amplitude * was.amplitude > 0 && further < kOtherRange &&
      further > 1 / kOtherRange) {
    return false;
  }
  was = now->second;
  find_homes();
  std::set<int> forgotten;
  for (const Effect& one : plan_.effects) {
    if (one.is_of(scanned) && forgotten.insert(one.family).second) forget(one.family);
  }
  return true;
}

std::vector<EffectFit> Refinement::refinable(const SelectedModel& m) const {
  std::vector<EffectFit> out;
  if (const auto name = likeliest(true)) out.push_back(*name);
  for (const EffectFit& f : m.found) {
    if (f.shape < 0) continue;
    const auto shape = static_cast<std::size_t>(f.shape);
    const auto same = likeliest(true, plan_.shapes[shape].variable);
    if (same && id_of(*same) != id_of(out.front())) out.push_back(*same);
  }
  return out;
}

bool Refinement::refine_ranges(const SelectedModel& m) {
  const bool curve =
      std::any_of(m.found.begin(), m.found.end(), [](const EffectFit& f) { return f.effect < 0; });
  if (!(curve || state_.selection.leaves_residual(m))) return false;
  bool better = false;
  for (const EffectFit& name : refinable(m)) {
    for (const FitParameter& p : effect_in(plan_, name).refine) {
      if (p.logarithmic && refine_range(name, p)) better = true;
    }
  }
  return better;
}

bool Refinement::refine_range(const EffectFit& name, const FitParameter& p) {
  for (const double factor : {kFurther, 1 / kFurther}) {
    bool further = false;
    while (tries_ < kMostTries && fits_better(name, p, factor)) further = true;
    if (further) return true;
  }
  return false;
}

bool Refinement::close_call() {
  using Known = std::pair<const Id, RefinedCandidate>;
  const auto deviance = [](const Known& one) { return one.second.alone.penalized_deviance; };
  const Known *name = nullptr, *curve = nullptr;
  for (const Known& one : state_.refined) {
    const Known*& best = one.first.first < 0 ? curve : name;
    if (best == nullptr || deviance(one) < deviance(*best)) best = &one;
  }
  if (name == nullptr || curve == nullptr) return false;
  if (std::fabs(deviance(*name) - deviance(*curve)) > kClose) return false;
  const Id both[] = {name->first, curve->first};
  for (const Id& id : both) {
    refine_fingerprint(fit_with(id, state_.refined.at(id).alone.amplitudes), kMany);
  }
  return true;
}

bool Refinement::close_faults() {
  std::vector<Id> faults;
  for (const auto& [id, one] : state_.refined) {
    if (id.first >= 0 && effect(id).control()) faults.push_back(id);
  }
  if (faults.size() < 2) return false;
  const auto estimate = [&](const Id& id) {
    return fit_with(id, state_.refined.at(id).alone.amplitudes);
  };
  const auto deviance = [&](const Id& id) {
    return state_.refined.at(id).alone.penalized_deviance;
  };
  for (const Id& id : faults) {
    for (int k = 0; k < kMostFollowed && off_centre(estimate(id), kBeside); ++k) {
      refine_fingerprint(estimate(id));
    }
  }
  const Id likeliest = *std::ranges::min_element(faults, {}, deviance);
  std::erase_if(faults, [&, least = deviance(likeliest)](const Id& id) {
    return deviance(id) - least > kClose;
  });
  if (faults.size() < 2) return false;
  for (const Id& id : faults) refine_fingerprint(estimate(id), kMany);
  return true;
}

std::vector<EffectFit> Refinement::alike_faults(const SelectedModel& m) const {
  const auto decided = [this](const Id& id) {
    const auto known = state_.refined.find(id);
    return id.first >= 0 && effect(id).control() && known != state_.refined.end() &&
           known->second.fingerprint.experiments >= kMany;
  };
  if (m.found.empty() || !decided(id_of(m.found[0]))) return {};
  const Id first = id_of(m.found[0]);
  const double least = state_.refined.at(first).alone.penalized_deviance;
  std::vector<EffectFit> out;
  for (const auto& [id, one] : state_.refined) {
    if (id == first || !decided(id)) continue;
    if (one.alone.penalized_deviance - least < kSameFault) {
      out.push_back(fit_with(id, one.alone.amplitudes));
    }
  }
  return out;
}

bool Refinement::made_sure(const SelectedModel& m) {
  const std::optional<EffectFit> likely = likeliest();
  const bool left = m.found.size() > 1 || state_.selection.leaves_residual(m);
  if (!likely || !left || refined(*likely)->fingerprint.experiments >= kMany) return false;
  refine_fingerprint(*likely, kMany);
  return true;
}

bool Refinement::fits_better(const EffectFit& name, const FitParameter& p, double factor) {
  tries_ += 1;
  EffectFit f = name;
  const SingleFit alone = refined(f)->alone;
  f.amplitudes = alone.amplitudes;
  double now = 0;
  for (const auto& [of, value] : found_effect(f).held) {
    if (of.path() == p.path) now = value;
  }
  const double next = std::clamp(now * factor, p.low, p.high);
  if (next == now) return false;
  State before = state_;
  state_.details.refined[p.path] = next;
  state_.home[effect_in(plan_, f).family] = id_of(f).first;
  refine_fingerprint(f);
  f.amplitudes = refined(f)->alone.amplitudes;
  if (off_centre(f, kBeside)) refine_fingerprint(f);
  if (refined(f)->alone.penalized_deviance < alone.penalized_deviance - kLeastFall) return true;
  state_ = std::move(before);
  return false;
}

SelectedModel Refinement::with_interactions(SelectedModel m) {
  std::set<std::string> simulated_sets;
  while (m.found.size() > 1 && simulated_sets.size() < kMostInteractions) {
    std::vector<EffectFit> found = m.found;
    std::sort(found.begin(), found.end(),
              [this](const EffectFit& a, const EffectFit& b) { return id_of(a) < id_of(b); });
    std::string name;
    for (const EffectFit& f : found) {
      name += (name.empty() ? "" : ", ") + stage_name(f);
    }
    const bool camera = std::any_of(found.begin(), found.end(),
                                    [&](const EffectFit& f) { return found_effect(f).camera(); });
    if (camera || !simulated_sets.insert(name).second) break;
    const Fingerprint at_once = simulated(found, name);
    state_.selection.add_interaction(found, at_once.base, at_once.experiments);
    // The scatter is used only if it increases the likelihood.
    ModelSelection inflated = state_.selection;
    inflated.inflate_by_scatter(at_once.scatter);
    SelectedModel by_scatter = selected_by(inflated);
    if (by_scatter.penalized_deviance <= m.penalized_deviance) {
      state_.selection = std::move(inflated), m = std::move(by_scatter);
    } else {
      m = selected_by(state_.selection);
    }
  }
  return m;
}

Fingerprint Refinement::simulated(const std::vector<EffectFit>& found, const std::string& name) {
  std::vector<Effect> effects;
  std::vector<Fingerprint> each;
  std::vector<Vector> at;
  for (const EffectFit& f : found) {
    effects.push_back(found_effect(f)), each.push_back(fingerprint(f)), at.push_back(f.amplitudes);
  }
  const Fingerprint sum = together(each, at);
  Fingerprint out =
      ensemble_.fingerprint_about(sum.about, sum, together(effects), calibrated_, name, learned_);
  out.base = out.at(sum.about), out.about = sum.about;
  return out;
}

}  // namespace lilytank
