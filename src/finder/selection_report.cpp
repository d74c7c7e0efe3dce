#include "finder/selection_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "finder/found_effect.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

using Vector = Eigen::VectorXd;

constexpr std::size_t kNearest = 3;  // effects that come nearest to a residual without a name

// Words for a curve's variable, followed by its value.
std::string place_words(const std::string& variable) {
  static const std::map<std::string, std::string> kWords = {
      {"radius", "a distance from the centre of"},
      {"pair", "a gap between modules of"},
      {"slip", "a speed through the water of"},
      {"position", "x ="},
      {"turn", "a rate of turning of"},
      {"time", "a time of"}};
  const auto known = kWords.find(variable);
  return known == kWords.end() ? variable : known->second;
}

// What the report is written from, and where to.
struct SelectionReport {
  void add_ranking();
  void add_detectable();
  void add_findings();
  FoundCurve curve(std::size_t s, double z) const;
  const FoundCurve* map_of(const std::string& variable) const;
  void add_nearest();
  std::vector<EffectFit> equally_likely(const std::vector<ClearPlace>& places) const;
  void add_alternatives(const EffectFit& fit, const std::vector<EffectFit>& ranked,
                        DiagnosisFinding& f);
  bool is_reported(const Effect& one) const;
  void blame_camera();
  void disown();
  void warn_of_rest();

  const ReferenceEnsemble& ensemble;
  const RefinedSelection& selected;
  const Vector& residual;
  Diagnosis& out;
  const ModelSelection& selection = selected.selection;
  const SelectedModel& model = selected.model;
  const ScoreDetails& details = selected.details;
  const ScorePlan& plan = ensemble.plan();
  std::vector<EffectFit> open{};  // the strongest finding and its alternatives
};

void SelectionReport::add_ranking() {
  for (const EffectFit& f : selection.effects(residual)) {
    if (f.effect < 0) continue;
    const Effect& effect = effect_in(plan, f);
    out.ranking.push_back({effect.name, effect.variant(), f.z});
  }
  out.effect_threshold = selection.effect_threshold();
  out.shape_threshold = selection.shape_threshold();
  out.strongest_left = std::max(model.left_effect.z, model.left_shape.z);
  out.inexact = model.inexact;
  std::vector<double> z(plan.shapes.size(), 0.0);
  for (const EffectFit& f : selection.shapes(residual)) z[static_cast<std::size_t>(f.shape)] = f.z;
  for (std::size_t s = 0; s < z.size(); ++s) out.maps.push_back(curve(s, z[s]));
}

FoundCurve SelectionReport::curve(std::size_t s, double z) const {
  const Shape& shape = plan.shapes[s];
  FoundCurve c;
  c.variable = shape.variable, c.direction = shape.direction, c.unit = shape.unit;
  if (shape.curve.along == Along::x || shape.curve.along == Along::y) {
    c.variable += shape.curve.along == Along::x ? " x" : " y";
  }
  c.value_unit = shape.curve.toward == Toward::torque ? "N m" : "N", c.z = z;
  for (int k = 0; k < kKnots; ++k) {
    const Eigen::Index at = ensemble.named_numbers() + static_cast<Eigen::Index>(s) * kKnots + k;
    c.at.push_back(knot_at(shape.curve, k));
    c.value.push_back(residual(at) * ensemble.deviations()(at) * shape.size);
    c.deviation.push_back(ensemble.deviations()(at) * shape.size);
  }
  return c;
}

void SelectionReport::add_detectable() {
  for (std::size_t e = 0; e < plan.effects.size(); ++e) {
    const Effect& effect = plan.effects[e];
    const auto change = [&](double amplitude) {
      return std::fabs(effect.value(plan.model, 0, amplitude) - effect.absent(plan.model, 0));
    };
    const double least = change(selection.smallest_detectable(static_cast<int>(e)));
    const double tried = change(kLearnedSize);
    const auto same = std::find_if(out.detectable.begin(), out.detectable.end(),
                                   [&](const Detectable& d) { return d.path == effect.paths[0]; });
    if (same == out.detectable.end()) {
      out.detectable.push_back({effect.name, effect.paths[0], least, tried, effect.units[0]});
    } else {
      same->smallest = std::max(same->smallest, least);  // whatever its range
      same->tried = std::max(same->tried, tried);
    }
  }
}

// The map with the largest z for a variable.
const FoundCurve* SelectionReport::map_of(const std::string& variable) const {
  const FoundCurve* best = nullptr;
  for (std::size_t s = 0; s < out.maps.size(); ++s) {
    if (plan.shapes[s].variable != variable) continue;
    if (best == nullptr || out.maps[s].z > best->z) best = &out.maps[s];
  }
  return best;
}

void add_place(const FoundCurve& curve, DiagnosisFinding& f) {
  f.curve = curve, f.unit = curve.unit;
  std::size_t peak = 0;
  const auto strength = [&](std::size_t k) {
    return std::fabs(curve.value[k]) / std::max(curve.deviation[k], 1e-300);
  };
  for (std::size_t k = 0; k < curve.at.size(); ++k) {
    if (strength(k) > strength(peak)) peak = k;
  }
  std::size_t first = peak, last = peak;
  while (first > 0 && strength(first - 1) > 2) --first;
  while (last + 1 < curve.at.size() && strength(last + 1) > 2) ++last;
  const double half = 0.5 * (curve.at[1] - curve.at[0]);
  f.from = curve.at[first] - (first == 0 ? 0 : half);
  f.to = curve.at[last] + (last + 1 == curve.at.size() ? 0 : half);
  char text[200];
  std::snprintf(
      text, sizeof text, "largest z at %s %.3g %s: the baseline is off by %.2g +- %.2g %s, %s",
      place_words(curve.variable).c_str(), curve.at[peak], curve.unit.c_str(), curve.value[peak],
      curve.deviation[peak], curve.value_unit.c_str(), curve.direction.c_str());
  f.text = text;
}

void add_places(const Effect& effect, const Scans& scans, const Model& model, DiagnosisFinding& f) {
  const auto scan = scans.places.find(effect.term);
  if (scan == scans.places.end()) return;
  const FoundPlace& best = scan->second.best;
  char text[120];
  std::snprintf(text, sizeof text, "likeliest about (x, y) = (%.3g, %.3g) m", best.x, best.y);
  f.text = text;
  PlaceMap& map = f.places;
  map.units = effect.units, map.tank_radius = model.tank.radius;
  for (const std::string& path : effect.paths) map.components.push_back(own_name(path));
  for (const FoundPlace& one : scan->second.map) {
    PlaceMap::Place place{one.x, one.y, one.amplitudes, std::sqrt(std::max(0.0, one.gain))};
    for (std::size_t c = 0; c < place.value.size(); ++c) place.value[c] *= effect.sizes[c];
    map.width = one.width, map.places.push_back(std::move(place));
  }
}

// Whether the findings include an effect of the same family.
bool SelectionReport::is_reported(const Effect& one) const {
  return std::any_of(model.found.begin(), model.found.end(), [&](const EffectFit& fit) {
    return fit.effect >= 0 && effect_in(plan, fit).family == one.family;
  });
}

// By scores, or one step ahead where scores do not show the finding.
void SelectionReport::add_alternatives(const EffectFit& fit, const std::vector<EffectFit>& ranked,
                                       DiagnosisFinding& f) {
  open = {fit};
  std::vector<EffectFit> others = ranked;
  if (selected.by_place) {
    others = equally_likely(selected.by_place->clear);
    others.insert(others.end(), selected.by_place->others.begin(), selected.by_place->others.end());
  } else {
    open[0].gain = std::ranges::find(ranked, fit.effect, &EffectFit::effect)->gain;
    for (EffectFit one : selected.alike) one.gain = open[0].gain, others.push_back(one);
  }
  std::set<int> rivals;
  for (const EffectFit& other : others) {
    if (other.effect < 0) continue;
    const Effect& rival = effect_in(plan, other);
    if (open[0].gain - other.gain >= kSameGain || is_reported(rival)) continue;
    if (!rivals.insert(rival.family).second) continue;
    f.alternatives.push_back(rival.name), open.push_back(other);
  }
}

// Those that are about as likely at their best places as the first of them, with its gain.
std::vector<EffectFit> SelectionReport::equally_likely(
    const std::vector<ClearPlace>& places) const {
  const auto gain = [&](const ClearPlace& one) {
    return scanned(effect_in(plan, one.fit), details)->amplitudes->gain;
  };
  std::vector<EffectFit> likely;
  for (const ClearPlace& one : places) {
    if (gain(places.front()) - gain(one) >= kSameGain) break;
    likely.push_back(one.fit), likely.back().gain = places.front().fit.gain;
  }
  return likely;
}

void SelectionReport::add_findings() {
  const std::vector<EffectFit> ranked = selection.effects(residual);
  for (std::size_t i = 0; i < model.found.size(); ++i) {
    const EffectFit& fit = model.found[i];
    DiagnosisFinding f;
    f.z = fit.z;
    f.confidence =
        selected.by_place ? selected.by_place->clear.front().confidence : selection.confidence(fit);
    if (fit.effect >= 0) {
      const Effect& effect = effect_in(plan, fit);
      f.effect = effect.name, f.variable = effect.variable, f.equation = effect.equation;
      if (i == 0) add_alternatives(fit, ranked, f);
      if (!f.alternatives.empty()) f.split = effect.split;
      if (effect.estimated == Estimated::place) {
        add_places(effect, details.scans, plan.model, f);
        if (selected.by_place) {
          f.text += "; z by the scan of all places, threshold " +
                    significant(selected.by_place->clear.front().threshold, 2);
        }
      } else if (const FoundCurve* map = map_of(f.variable)) {
        add_place(*map, f);
      }
    } else {
      const auto s = static_cast<std::size_t>(fit.shape);
      f.effect = "unnamed", f.variable = plan.shapes[s].variable;
      f.equation =
          "F = f(" + f.variable + ") " + plan.shapes[s].direction + ", the curve that is drawn";
      add_place(out.maps[s], f);
    }
    out.findings.push_back(std::move(f));
  }
  out.verdict = model.found.empty() ? Verdict::complete : Verdict::missing;
  blame_camera();
  if (model.found.empty() && selection.leaves_residual(model)) out.verdict = Verdict::undecided;
  if (!model.found.empty() && selection.fails(model)) disown();
  if (out.verdict == Verdict::undecided) {
    add_nearest();
  } else if (out.verdict == Verdict::missing && selection.leaves_residual(model)) {
    warn_of_rest();
  }
}

void SelectionReport::add_nearest() {
  std::set<int> families;
  open.clear();
  for (const EffectFit& f : selection.effects(residual)) {
    if (f.effect < 0 || open.size() == kNearest) continue;
    if (families.insert(effect_in(plan, f).family).second) open.push_back(f);
  }
}

// Warns where the findings leave a significant remainder without a name.
void SelectionReport::warn_of_rest() {
  std::string text = "the remaining discrepancy exceeds that of null experiments";
  if (model.left_shape.z > out.shape_threshold) {
    const Shape& shape = plan.shapes[static_cast<std::size_t>(model.left_shape.shape)];
    text += ", most over " + shape.variable + " " + shape.direction + " (z " +
            significant(model.left_shape.z, 2) + ")";
  }
  out.warnings.push_back(text + ": another effect may be omitted, or a law has another form");
}

// Withdraws findings that leave most of the mismatch unexplained.
void SelectionReport::disown() {
  std::string names;
  for (const DiagnosisFinding& f : out.findings) names += (names.empty() ? "" : " and ") + f.effect;
  char share[40];
  std::snprintf(share, sizeof share, "%.0f %%", 100 * model.share_left);
  out.warnings.push_back("nothing that is known explains these recordings: what comes nearest, " +
                         names + ", leaves " + share + " of the mismatch");
  out.verdict = Verdict::undecided, out.findings.clear();
}

// Reports no forces where the camera is faulty: they may be artefacts of the fault.
void SelectionReport::blame_camera() {
  std::vector<DiagnosisFinding> faults;
  for (std::size_t i = 0; i < model.found.size(); ++i) {
    if (model.found[i].effect < 0) continue;
    const Effect& effect = effect_in(plan, model.found[i]);
    if (!effect.camera()) continue;
    DiagnosisFinding f = out.findings[i];
    for (std::size_t c = 0; c < effect.paths.size(); ++c) {
      const double value =
          model.found[i].amplitudes(static_cast<Eigen::Index>(c)) * effect.sizes[c];
      f.parameters.push_back(
          {own_name(effect.paths[c]), effect.paths[c], value, value, value, effect.units[c]});
    }
    faults.push_back(std::move(f));
  }
  if (faults.empty()) return;
  out.verdict = Verdict::measurement, out.findings = std::move(faults);
}

}  // namespace

std::vector<EffectFit> report_selection(const ReferenceEnsemble& ensemble,
                                        const RefinedSelection& selected, const Vector& residual,
                                        double false_alarms, Diagnosis& out) {
  out.false_alarms = false_alarms;
  SelectionReport report{ensemble, selected, residual, out};
  report.add_ranking();
  report.add_detectable();
  report.add_findings();
  return report.open;
}

}  // namespace lilytank
