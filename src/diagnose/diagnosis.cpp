#include "lilytank/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "diagnose/naming.hpp"
#include "diagnose/show.hpp"
#include "io/atomic_file.hpp"
#include "lilytank/model_parameter.hpp"
#include "lilytank/random.hpp"
#include "lilytank/state.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kFirstSpread = 0.04, kLeastSpread = 0.015;  // of designs, shares of the ranges
constexpr double kMostMissing = 0.1;  // share of unseen frames beyond which cameras are at fault
constexpr double kSame = 4;           // gains that differ by less do not tell effects apart

// Simulations of each kind for ten minutes on two cores.
struct Budget {
  int search, flow_draws, centre, nulls, experiments, round, replicates, comparisons;
  explicit Budget(double minutes) {
    const double s = std::clamp(minutes / 10, 0.3, 4.0);
    const auto scaled = [&](int n, int least) {
      return std::max(least, static_cast<int>(std::lround(n * s)));
    };
    search = scaled(500, 200), flow_draws = scaled(16, 12), centre = scaled(100, 80);
    nulls = scaled(280, 160), experiments = scaled(9, 6), round = scaled(130, 110);
    replicates = scaled(80, 40), comparisons = scaled(24, 12);
  }
};

CalibrationOptions calibration_of(const Experiment& experiment, const DiagnosisOptions& o,
                                  const Budget& budget) {
  CalibrationOptions c;
  c.parameters = standard_parameters(BodyKind::lily);
  const bool told = std::any_of(experiment.recordings.begin(), experiment.recordings.end(),
                                [](const Recording& r) { return r.held_out; });
  const auto lilies = std::count_if(experiment.recordings.begin(), experiment.recordings.end(),
                                    [](const Recording& r) { return r.body == BodyKind::lily; });
  c.hold_out = told || lilies < 2 ? 0 : std::min(o.hold_out, static_cast<int>(lilies) - 1);
  c.search_budget = budget.search, c.flow_draws = budget.flow_draws;
  c.round = budget.centre, c.seed = o.seed, c.out = o.out, c.force = o.force;
  c.threads = o.threads, c.stop = o.stop, c.progress = o.progress;
  return c;
}

void take_directory(const CalibrationSetup& setup, const DiagnosisOptions& o) {
  if (o.out.empty()) return;
  const fs::path mark = fs::path(o.out) / "work" / "identity";
  const std::string identity =
      "lilytank diagnosis 1 " + hex(setup.identity) + " " + shortest(o.minutes) + "\n";
  std::error_code problem;
  if (fs::exists(mark, problem) && read_whole(mark.string()) != identity) {
    if (!o.force) {
      throw InputError(o.out +
                       " holds another diagnosis (other data or options): choose another --out, or "
                       "replace it with --force");
    }
    fs::remove_all(fs::path(o.out) / "work", problem);
  }
  fs::create_directories(mark.parent_path(), problem);
  if (problem) throw InputError(system_problem("cannot make", o.out, problem.value()));
  write_atomically(mark.string(), identity);
}

// Faults of the camera and the tracker: named as such, and no force is looked for behind them.
bool recordings_at_fault(const Experiment& experiment, Diagnosis& out) {
  int swaps = 0, clocks = 0;
  for (const Finding& f : experiment.findings) {
    out.checks.push_back(f.text());
    swaps += f.check == Check::swap ? 1 : 0;
    clocks += f.check == Check::clock ? 1 : 0;
  }
  const auto blame = [&](const std::string& effect, const std::string& variable,
                         const std::string& text) {
    DiagnosisFinding f;
    f.effect = effect, f.variable = variable, f.text = text, f.confidence = 1;
    out.findings.push_back(f);
  };
  if (swaps > 0) {
    blame("identity_swap", "module",
          std::to_string(swaps) + " times two bodies go on in each other's places");
  }
  double all = 0, missed = 0;
  for (const Recording& r : experiment.recordings) {
    for (const Track& t : r.tracks) {
      all += static_cast<double>(t.x.size());
      missed += static_cast<double>(
          std::count_if(t.x.begin(), t.x.end(), [](double x) { return std::isnan(x); }));
    }
  }
  if (clocks > 0 || missed > kMostMissing * all) {
    blame("lost_frames", "time",
          clocks > 0 ? std::to_string(clocks) + " times the clock disagrees with the frames"
                     : "bodies are unseen in " + std::to_string(std::lround(100 * missed / all)) +
                           " % of the frames");
  }
  return !out.findings.empty();
}

class Diagnoser {
 public:
  Diagnoser(const Experiment& experiment, const DiagnosisOptions& options)
      : options_(options),
        budget_(options.minutes),
        setup_(set_up(experiment, calibration_of(experiment, options, budget_))),
        stages_(begin(setup_, options)) {}

  void run(Diagnosis& out) {
    const FlowMaps maps = stages_.flow_maps();
    out.flow_csv = setup_.corrected_csv(*maps.best());
    CalibrationResult searched;
    const Vector first = stages_.to_scale(stages_.search(searched));
    const FitBounds bounds = stages_.bounds();
    const auto [centre, deviation] = centre_of(first, maps, bounds);
    Matrix spread =
        (4 * deviation).cwiseMax(kLeastSpread * (bounds.high - bounds.low)).asDiagonal();
    Atlas atlas(stages_, maps, plan(centre), centre, spread,
                {budget_.nulls, budget_.experiments, derived_seed(options_.seed, 31)});
    ScoreDetails details;
    const Vectors observed = atlas.vectors(setup_.training, &details);
    Naming naming(atlas, options_.false_alarms);
    const Vector residual = atlas.residual(observed);
    Explanation explanation = explained(atlas, naming, residual);
    tell_ranking(atlas, naming, residual, explanation, out);
    tell_detectable(atlas, naming, out);
    tell_findings(atlas, naming, residual, explanation, details, out);
    model_and_show(maps, atlas, explanation, observed, spread, details, out);
    out.simulations = stages_.simulations() + budget_.nulls;
  }

 private:
  static Stages begin(CalibrationSetup& setup, const DiagnosisOptions& options) {
    take_directory(setup, options);
    return Stages(setup);
  }

  // The parameters of the baseline that whole experiments say, and their errors.
  std::pair<Vector, Vector> centre_of(const Vector& first, const FlowMaps& maps,
                                      const FitBounds& bounds) {
    const Vector wide = kFirstSpread * (bounds.high - bounds.low);
    Matrix points(budget_.centre, first.size());
    const std::uint64_t seed = derived_seed(options_.seed, 30);
    for (int i = 0; i < budget_.centre; ++i) {
      for (Eigen::Index k = 0; k < first.size(); ++k) {
        const double u =
            uniform({seed, Stream::calibrate, i / 2, static_cast<std::uint32_t>(k), 5});
        points(i, k) = first(k) + (i % 2 == 0 ? 1 : -1) * 1.7 * (2 * u - 1) * wide(k);
      }
      points.row(i) =
          points.row(i).transpose().cwiseMax(bounds.low).cwiseMin(bounds.high).transpose();
    }
    const auto rows = stages_.simulate("centre", points, seed, maps);
    Design design;
    std::vector<int> good;
    for (int i = 0; i < budget_.centre; ++i) {
      if (!rows[static_cast<std::size_t>(i)].empty()) good.push_back(i);
    }
    const auto n = static_cast<Eigen::Index>(good.size());
    if (2 * n < budget_.centre) throw InputError("most worlds about the search's answer diverge");
    design.points.resize(n, first.size());
    design.numbers.resize(n, static_cast<Eigen::Index>(setup_.entries().size()));
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto& row = rows[static_cast<std::size_t>(good[static_cast<std::size_t>(i)])];
      design.points.row(i) = points.row(good[static_cast<std::size_t>(i)]);
      design.numbers.row(i) = Eigen::Map<const Vector>(row.data(), design.numbers.cols());
    }
    const LocalModel model(design);
    const std::vector<double> numbers = setup_.numbers(setup_.training);
    FitBounds near = bounds;
    near.reach = 2.5;
    const LocalFit fit = model.fit(
        Eigen::Map<const Vector>(numbers.data(), static_cast<Eigen::Index>(numbers.size())), near);
    return {fit.point, model.parameter_covariance(fit.point).diagonal().cwiseSqrt()};
  }

  ScorePlan plan(const Vector& centre) const {
    ScorePlan p;
    const std::vector<double> values = stages_.from_scale(centre);
    const std::vector<std::string> paths = setup_.paths();
    const auto told = static_cast<std::ptrdiff_t>(setup_.told());
    p.model =
        with_parameters(setup_.model, std::vector<std::string>(paths.begin(), paths.begin() + told),
                        std::vector<double>(values.begin(), values.begin() + told));
    p.predictor = predictor_options(p.model, setup_.training);
    p.effects = effect_catalogue(setup_.model);
    double longest = 0;
    int modules = 0;
    for (const Recording& r : setup_.training) {
      longest = std::max(longest, r.frames / r.rate);
      modules = std::max(modules, static_cast<int>(r.tracks.size()));
    }
    p.shapes = shape_catalogue(setup_.model, longest);
    p.rate = setup_.training.front().rate, p.modules = std::max(modules, setup_.shapes[0].bodies);
    return p;
  }

  // Named effects first; a shape competes with them where they leave something.
  Explanation explained(Atlas& atlas, Naming& naming, const Vector& residual) {
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
    for (const int s : asked) {
      naming.add_shape(
          s, atlas.fingerprint(effect_of(atlas.plan().shapes[static_cast<std::size_t>(s)]),
                               "shape " + std::to_string(s),
                               derived_seed(options_.seed, 500 + static_cast<std::uint64_t>(s))));
    }
    return asked.empty() ? e : naming.explain(residual);
  }

  void tell_ranking(const Atlas& atlas, const Naming& naming, const Vector& residual,
                    const Explanation& e, Diagnosis& out) const {
    for (const EffectFit& f : naming.effects(residual)) {
      const auto k = static_cast<std::size_t>(f.effect);
      if (f.effect >= 0) out.ranking.emplace_back(atlas.plan().effects[k].name, f.z);
    }
    out.effect_threshold = naming.effect_threshold();
    out.shape_threshold = naming.shape_threshold(), out.false_alarms = options_.false_alarms;
    out.strongest_left = std::max(e.left_effect.z, e.left_shape.z);
    std::vector<double> z(atlas.plan().shapes.size(), 0.0);
    for (const EffectFit& f : naming.shapes(residual)) z[static_cast<std::size_t>(f.shape)] = f.z;
    for (std::size_t s = 0; s < z.size(); ++s) out.maps.push_back(curve(atlas, residual, s, z[s]));
  }

  FoundCurve curve(const Atlas& atlas, const Vector& residual, std::size_t s, double z) const {
    const Shape& shape = atlas.plan().shapes[s];
    FoundCurve c;
    c.variable = shape.variable, c.direction = shape.direction, c.unit = shape.unit;
    if (shape.curve.along == Along::x || shape.curve.along == Along::y) {
      c.variable += shape.curve.along == Along::x ? " x" : " y";
    }
    c.value_unit = shape.curve.toward == Toward::torque ? "N m" : "N", c.z = z;
    const bool closed = shape.curve.along == Along::heading;
    for (int k = 0; k < kKnots; ++k) {
      const Eigen::Index at = atlas.named_numbers() + static_cast<Eigen::Index>(s) * kKnots + k;
      const double step = (shape.curve.high - shape.curve.low) / (closed ? kKnots : kKnots - 1);
      c.at.push_back(shape.curve.low + k * step);
      c.value.push_back(residual(at) * atlas.deviations()(at) * shape.size);
      c.deviation.push_back(atlas.deviations()(at) * shape.size);
    }
    return c;
  }

  void tell_detectable(const Atlas& atlas, const Naming& naming, Diagnosis& out) const {
    for (std::size_t e = 0; e < atlas.plan().effects.size(); ++e) {
      const Effect& effect = atlas.plan().effects[e];
      const double least = naming.smallest_seen(static_cast<int>(e)) * effect.sizes[0];
      const auto same =
          std::find_if(out.detectable.begin(), out.detectable.end(), [&](const Detectable& d) {
            return d.effect == effect.name && d.path == effect.paths[0];
          });
      if (same == out.detectable.end()) {
        out.detectable.push_back({effect.name, effect.paths[0], least, effect.units[0]});
      } else {
        same->smallest = std::min(same->smallest, least);
      }
    }
  }

  // The map in which a finding shows most.
  const FoundCurve* map_of(const std::string& variable, const Diagnosis& out) const {
    const FoundCurve* best = nullptr;
    for (const FoundCurve& c : out.maps) {
      if (c.variable.rfind(variable, 0) != 0) continue;
      if (best == nullptr || c.z > best->z) best = &c;
    }
    return best;
  }

  void tell_where(const FoundCurve& curve, DiagnosisFinding& f) const {
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
    std::snprintf(text, sizeof text,
                  "strongest %s at %s %.3g %s, where the baseline is off by %.2g +- %.2g %s",
                  curve.direction.c_str(), curve.variable.c_str(), curve.at[peak],
                  curve.unit.c_str(), curve.value[peak], curve.deviation[peak],
                  curve.value_unit.c_str());
    f.text = text;
  }

  void tell_findings(const Atlas& atlas, const Naming& naming, const Vector& residual,
                     const Explanation& e, const ScoreDetails& details, Diagnosis& out) const {
    static_cast<void>(details);
    const std::vector<EffectFit> ranked = naming.effects(residual);
    for (std::size_t i = 0; i < e.found.size(); ++i) {
      const EffectFit& fit = e.found[i];
      DiagnosisFinding f;
      f.z = fit.z, f.confidence = std::erf(fit.z / std::sqrt(2.0));
      if (fit.effect >= 0) {
        const Effect& effect = atlas.plan().effects[static_cast<std::size_t>(fit.effect)];
        f.effect = effect.name, f.variable = effect.variable;
        const ForceTerm* term = find_force(effect.name);
        if (term != nullptr) f.equation = std::string(term->equation());
        for (const EffectFit& other : ranked) {
          if (other.effect < 0 || i > 0) continue;
          const std::string& name =
              atlas.plan().effects[static_cast<std::size_t>(other.effect)].name;
          if (name == effect.name || fit.gain - other.gain >= kSame) continue;
          if (std::find(f.alternatives.begin(), f.alternatives.end(), name) == f.alternatives.end())
            f.alternatives.push_back(name);
        }
        if (!f.alternatives.empty()) f.split = effect.split;
        if (const FoundCurve* map = map_of(f.variable, out)) tell_where(*map, f);
      } else {
        const auto s = static_cast<std::size_t>(fit.shape);
        f.effect = "unnamed", f.variable = atlas.plan().shapes[s].variable;
        f.equation = "F = f(" + f.variable + ") " + atlas.plan().shapes[s].direction +
                     ", the curve that is drawn";
        tell_where(out.maps[s], f);
      }
      out.findings.push_back(std::move(f));
    }
    out.verdict = e.found.empty() ? Verdict::complete : Verdict::missing;
    if (e.found.empty() && e.strongest > naming.shape_threshold()) out.verdict = Verdict::undecided;
  }

  void model_and_show(const FlowMaps& maps, const Atlas& atlas, const Explanation& e,
                      const Vectors& observed, const Matrix& spread, const ScoreDetails& details,
                      Diagnosis& out) {
    const LocalFit baseline = atlas.calibrated(observed.summary);
    const std::vector<double> before = stages_.from_scale(baseline.point);
    const Matrix covariance = atlas.parameters().parameter_covariance(baseline.point);
    for (std::size_t i = 0; i < setup_.told(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      out.parameters.push_back({setup_.parameters[i].path, setup_.parameters[i].unit, before[i],
                                std::sqrt(covariance(k, k)), before[i], before[i], before[i]});
    }
    out.overlay = "# What was found of " + setup_.name + ".\n";
    if (e.found.empty()) return;
    std::vector<Effect> effects;
    std::vector<Vector> amplitudes;
    for (const EffectFit& f : e.found) {
      effects.push_back(f.effect >= 0
                            ? atlas.plan().effects[static_cast<std::size_t>(f.effect)]
                            : effect_of(atlas.plan().shapes[static_cast<std::size_t>(f.shape)]));
      amplitudes.push_back(f.amplitudes);
      if (effects.back().name == "flow_pulsation") {
        effects.back().shape = {{"forces.flow_pulsation.frequency", details.pulsation}};
      }
      if (effects.back().name == "heterogeneous_module") {
        effects.back().shape = {
            {"forces.heterogeneous_module.module", static_cast<double>(details.heaviest)}};
      }
    }
    const JointFit fit =
        fit_jointly(stages_, maps, atlas, effects, amplitudes, observed, spread, budget_.round,
                    budget_.replicates, derived_seed(options_.seed, 700));
    tell_parameters(fit, effects, out);
    show(maps, atlas, fit, before, out);
  }

  void tell_parameters(const JointFit& fit, const std::vector<Effect>& effects,
                       Diagnosis& out) const {
    for (std::size_t i = 0; i < out.parameters.size(); ++i) {
      out.parameters[i].with_effects = fit.value[i];
      out.parameters[i].low = fit.low[i], out.parameters[i].high = fit.high[i];
    }
    std::size_t at = setup_.parameters.size();
    for (std::size_t e = 0; e < effects.size(); ++e) {
      const std::size_t count = effects[e].paths.size() + effects[e].refine.size();
      for (std::size_t k = 0; k < count; ++k, ++at) {
        const FitParameter& p = fit.parameters[at];
        out.findings[e].parameters.push_back({p.path.substr(p.path.rfind('.') + 1), p.path,
                                              fit.value[at], fit.low[at], fit.high[at], p.unit});
      }
      for (const auto& [path, value] : effects[e].shape) {
        const bool refined =
            std::any_of(effects[e].refine.begin(), effects[e].refine.end(),
                        [&p = path](const FitParameter& r) { return r.path == p; });
        if (refined || effects[e].name == "empirical_force") continue;
        const ModelParameter of{path, "", 0, 0, ""};
        out.findings[e].parameters.push_back(
            {of.path.substr(of.path.rfind('.') + 1), path, value, value, value, ""});
      }
      if (effects[e].name == "empirical_force") {
        for (int k = 0; k < kKnots; ++k) {
          out.findings[e].curve.value[static_cast<std::size_t>(k)] =
              out.findings[e].parameters[static_cast<std::size_t>(k)].value;
        }
      }
    }
    std::string text = "# Physics that the recordings of " + setup_.name +
                       " ask for, found by lilytank diagnose: lay this over a scenario, as in\n"
                       "#   lilytank run scenarios/tank_lilies.toml missing.toml\n";
    text += "run.dt = " + shortest(setup_.model.dt) + "\n";
    if (setup_.flow) text += "flow.file = \"flow.csv\"\n";
    for (const MovedParameter& p : out.parameters) {
      text += p.path + " = " + shortest(p.with_effects) + "\n";
    }
    for (std::size_t e = 0; e < effects.size(); ++e) {
      if (effects[e].name == "empirical_force") {
        for (const auto& [path, value] : effects[e].shape)
          text += path + " = " + shortest(value) + "\n";
      }
      for (const FoundParameter& p : out.findings[e].parameters) {
        text += p.path + " = " + shortest(p.value) + "  # " + shortest(p.low) + " .. " +
                shortest(p.high) + "\n";
      }
    }
    out.overlay = text;
  }

  void show(const FlowMaps& maps, const Atlas& atlas, const JointFit& fit,
            const std::vector<double>& before, Diagnosis& out) {
    const bool held = !setup_.held_out.empty();
    const auto& recordings = held ? setup_.held_out : setup_.training;
    const auto& shapes = held ? setup_.held_out_shapes : setup_.shapes;
    std::vector<std::string> paths;
    for (const FitParameter& p : fit.parameters) paths.push_back(p.path);
    const Emulator with(fit.model, paths, shapes);
    const auto b = repeat(stages_, maps, setup_.emulator(shapes), before, budget_.comparisons,
                          "before", derived_seed(options_.seed, 801));
    const auto a = repeat(stages_, maps, with, fit.value, budget_.comparisons, "after",
                          derived_seed(options_.seed, 802));
    out.held_out = group_fits(setup_, atlas.plan(), recordings, b, a);
    msd_share(recordings, b, a, setup_.piece, out);
    std::vector<std::string> told;
    std::vector<double> values;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      if (paths[i] == kPositionNoise || paths[i] == kHeadingNoise) continue;
      told.push_back(paths[i]), values.push_back(fit.value[i]);
    }
    const Model after = with_parameters(fit.model, told, values);
    const StepGain gain = step_gain(atlas.plan().model, after, atlas.plan().predictor, recordings);
    for (DiagnosisFinding& f : out.findings) {
      f.gain = gain.gain, f.gain_low = gain.low, f.gain_high = gain.high;
    }
  }

  DiagnosisOptions options_;
  Budget budget_;
  CalibrationSetup setup_;
  Stages stages_;
};

}  // namespace

double GroupFit::removed() const {
  return before > 1 ? std::clamp(1 - std::max(0.0, after - 1) / (before - 1), -1.0, 1.0) : 0;
}

std::string name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::complete:
      return "complete";
    case Verdict::missing:
      return "missing";
    case Verdict::measurement:
      return "measurement";
    default:
      return "undecided";
  }
}

std::optional<Diagnosis> diagnose(const Experiment& experiment, const DiagnosisOptions& options) {
  Diagnosis out;
  out.name = experiment.name;
  for (const Recording& r : experiment.recordings) {
    if (r.body != BodyKind::lily) continue;
    if (r.latches) {
      throw InputError(r.name +
                       " was recorded with latches on: a diagnosis needs recordings with "
                       "latches = \"off\", or modules would move as one for other reasons");
    }
    out.recordings += 1, out.seconds += r.frames / r.rate;
    out.modules = std::max(out.modules, static_cast<int>(r.tracks.size()));
  }
  if (recordings_at_fault(experiment, out)) {
    out.verdict = Verdict::measurement;
    return out;
  }
  try {
    Diagnoser(experiment, options).run(out);
  } catch (const Stopped&) {
    return std::nullopt;
  }
  return out;
}

}  // namespace lilytank
