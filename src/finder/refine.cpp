// Further experiments with what was found: other ranges, more of them, several effects at once.
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "finder/scan.hpp"
#include "finder/sharpening.hpp"

namespace lilytank {
namespace {

using Vector = Eigen::VectorXd;

constexpr std::size_t kMostMeetings = 3;
constexpr double kStrong = 12;       // z of an effect beside which others are looked for anew
constexpr double kElsewhere = 0.02;  // m, by which a stream is another one
constexpr double kOtherRange = 1.4;  // likewise of a force between modules, a factor
constexpr double kFurther = 1.5;     // from one range to the next that is tried
constexpr int kMostTries = 7;
constexpr double kClose = 60;     // of a doubt
constexpr int kMany = 30;         // experiments that decide a close call
constexpr double kLeastFall = 4;  // of a doubt, that makes a range the better one

}  // namespace

ScorePlan Diagnoser::Sharpening::beside(const SelectedModel& e, const Effect& scanned) const {
  ScorePlan plan = of_.atlas_->plan();
  for (const EffectFit& f : e.found) {
    const Effect effect = of_.found_effect(f, judged_.details);
    const bool own = f.effect < 0 ? effect.variable == scanned.variable : effect.is_of(scanned);
    if (f.z > kStrong && effect.mean_force && !own) plan.beside.push_back(effect);
  }
  return plan;
}

bool Diagnoser::Sharpening::rescan(const SelectedModel& e) {
  bool moved = false;
  std::set<int> done;
  for (const Effect& one : of_.atlas_->plan().effects) {
    if (one.estimated == Estimated::place && done.insert(one.family).second) {
      moved = rescan_stream(e, one) || moved;
    }
  }
  for (const Effect& one : of_.atlas_->plan().effects) {
    if (one.scanned_from > 0 && done.insert(one.family).second) moved = rescan(e, one) || moved;
  }
  return moved;
}

bool Diagnoser::Sharpening::rescan_stream(const SelectedModel& e, const Effect& stream) {
  const ScorePlan plan = beside(e, stream);
  if (plan.beside.empty()) return false;
  StreamPlace& was = judged_.details.scans.stream;
  const StreamPlace now = find_stream(plan, alignment_.recordings(), of_.options_.threads);
  if (!(std::hypot(now.x - was.x, now.y - was.y) > kElsewhere)) return false;
  was = now;
  find_homes(), forget(stream.family);
  return true;
}

bool Diagnoser::Sharpening::rescan(const SelectedModel& e, const Effect& scanned) {
  const ScorePlan plan = beside(e, scanned);
  if (plan.beside.empty()) return false;
  const auto all = find_values(plan, alignment_.recordings());
  const auto now = all.find(scanned.term);
  if (now == all.end()) return false;
  ScannedValue& was = judged_.details.scans.values[now->first];
  const double further = now->second.value / std::max(was.value, 1e-9);
  if (now->second.amplitude * was.amplitude > 0 && further < kOtherRange &&
      further > 1 / kOtherRange) {
    return false;
  }
  was = now->second;
  find_homes();
  std::set<int> forgotten;
  for (const Effect& one : of_.atlas_->plan().effects) {
    if (one.is_of(scanned) && forgotten.insert(one.family).second) forget(one.family);
  }
  return true;
}

std::vector<EffectFit> Diagnoser::Sharpening::refinable(const SelectedModel& e) const {
  std::vector<EffectFit> out;
  if (const auto name = likeliest(true)) out.push_back(*name);
  for (const EffectFit& f : e.found) {
    if (f.shape < 0) continue;
    const auto shape = static_cast<std::size_t>(f.shape);
    const auto same = likeliest(true, of_.atlas_->plan().shapes[shape].variable);
    if (same && name_of(*same) != name_of(out.front())) out.push_back(*same);
  }
  return out;
}

bool Diagnoser::Sharpening::refine(const SelectedModel& e) {
  const bool curve =
      std::any_of(e.found.begin(), e.found.end(), [](const EffectFit& f) { return f.effect < 0; });
  if (!(curve || selection_.leaves_residual(e))) return false;
  bool better = false;
  for (const EffectFit& name : refinable(e)) {
    for (const FitParameter& p : of_.effect(name).refine) {
      if (p.logarithmic && refined(name, p)) better = true;
    }
  }
  return better;
}

bool Diagnoser::Sharpening::refined(const EffectFit& name, const FitParameter& p) {
  for (const double factor : {kFurther, 1 / kFurther}) {
    bool further = false;
    while (tries_ < kMostTries && fits_better(name, p, factor)) further = true;
    if (further) return true;
  }
  return false;
}

bool Diagnoser::Sharpening::close_call() {
  const Suspect *name = nullptr, *curve = nullptr;
  for (const Suspect& one : alone_) {
    const Suspect*& best = one.first.first < 0 ? curve : name;
    if (best == nullptr || one.second.penalized_deviance < best->second.penalized_deviance)
      best = &one;
  }
  if (name == nullptr || curve == nullptr) return false;
  if (std::fabs(name->second.penalized_deviance - curve->second.penalized_deviance) > kClose)
    return false;
  for (const Name& of : {name->first, curve->first}) {
    EffectFit f;
    std::tie(f.effect, f.shape) = of;
    f.amplitudes = alone_.at(of).amplitudes;
    sharpen(f, kMany);
  }
  return true;
}

bool Diagnoser::Sharpening::made_sure(const SelectedModel& e) {
  const std::optional<EffectFit> likely = likeliest();
  const bool left = e.found.size() > 1 || selection_.leaves_residual(e);
  if (!likely || !left || known_.at(name_of(*likely)).experiments >= kMany) return false;
  sharpen(*likely, kMany);
  return true;
}

bool Diagnoser::Sharpening::fits_better(const EffectFit& name, const FitParameter& p,
                                        double factor) {
  tries_ += 1;
  EffectFit f = name;
  f.amplitudes = alone_.at(name_of(f)).amplitudes;
  double now = 0;
  for (const auto& [of, value] : of_.found_effect(f, judged_.details).held) {
    if (of.path() == p.path) now = value;
  }
  const double next = std::clamp(now * factor, p.low, p.high);
  if (next == now) return false;
  const double doubt = alone_.at(name_of(f)).penalized_deviance;
  const auto before = std::tuple(known_, alone_, home_, step_, selection_, judged_.details.refined);
  judged_.details.refined[p.path] = next;
  home_[of_.effect(f).family] = name_of(f).first;
  sharpen(f);
  f.amplitudes = alone_.at(name_of(f)).amplitudes;
  if (off_centre(f, kBeside)) sharpen(f);
  if (alone_.at(name_of(f)).penalized_deviance < doubt - kLeastFall) return true;
  std::tie(known_, alone_, home_, step_, selection_, judged_.details.refined) = before;
  return false;
}

SelectedModel Diagnoser::Sharpening::met(SelectedModel e) {
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
    ModelSelection both = selection_;
    both.add_interaction(found, at_once.base, at_once.experiments);
    // Without their scatter if it does not make them likelier.
    selection_ = both;
    both.inflate_by_scatter(at_once.scatter);
    SelectedModel loose = explained_by(both);
    if (loose.penalized_deviance <= e.penalized_deviance) {
      selection_ = std::move(both), e = std::move(loose);
    } else {
      e = explained_by(selection_);
    }
  }
  return e;
}

Fingerprint Diagnoser::Sharpening::simulated(const std::vector<EffectFit>& found,
                                             const std::string& name) {
  std::vector<Effect> effects;
  std::vector<Fingerprint> each;
  std::vector<Vector> at;
  for (const EffectFit& f : found) {
    effects.push_back(of_.found_effect(f, judged_.details)), each.push_back(fingerprint(f)),
        at.push_back(f.amplitudes);
  }
  const Fingerprint sum = together(each, at);
  Fingerprint out = of_.atlas_->fingerprint_about(sum.about, sum, together(effects),
                                                  of_.atlas_->calibrated(judged_.observed.summary),
                                                  name, learned_);
  out.base = out.at(sum.about), out.about = sum.about;
  return out;
}

}  // namespace lilytank
