#include "lilytank/diagnosis.hpp"

#include <algorithm>
#include <cmath>

#include "finder/fitted_model.hpp"
#include "finder/proposal.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/emulator.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr double kMostMissing = 0.1;  // share of unseen frames beyond which cameras are at fault

// Expected number of detections in a recording: for Lilies, frames times the number of bodies that
// at least 1 % of the frames show (fewer is a spurious track), gaps included; balls may come and
// go.
double expected_sightings(const Recording& r, std::vector<int> seen) {
  double all = 0;
  if (r.body != BodyKind::lily) {
    for (const Track& t : r.tracks) all += static_cast<double>(t.x.size());
    return all;
  }
  if (seen.empty()) return 0;
  const auto at = seen.begin() + static_cast<std::ptrdiff_t>(99 * seen.size() / 100);
  std::nth_element(seen.begin(), at, seen.end());
  return static_cast<double>(*at) * r.frames;
}

// Share of missed detections: the larger one of Lilies and balls.
double unseen_share(const Experiment& experiment) {
  double worst = 0;
  for (const bool lilies : {true, false}) {
    double all = 0, sightings = 0;
    for (const Recording& r : experiment.recordings) {
      if ((r.body == BodyKind::lily) != lilies) continue;
      const std::vector<int> seen = seen_by_frame(r);
      for (const int n : seen) sightings += n;
      all += expected_sightings(r, seen);
    }
    if (all > 0) worst = std::max(worst, 1 - sightings / all);
  }
  return worst;
}

// Faults of the camera and the tracker; recordings with faults are not searched for forces.
bool recordings_at_fault(const Experiment& experiment, Diagnosis& out) {
  constexpr int kListed = 1;  // of each kind in each file; `lilytank recording check` lists all
  out.checks = finding_texts(experiment.findings, kListed);
  int swaps = 0, clocks = 0;
  for (const Finding& f : experiment.findings) {
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
  const double missed = unseen_share(experiment);
  if (clocks > 0 || missed > kMostMissing) {
    blame("lost_frames", "time",
          clocks > 0 ? std::to_string(clocks) + " times the clock disagrees with the frames"
                     : "bodies are unseen in " + std::to_string(std::lround(100 * missed)) +
                           " % of the frames");
  }
  return !out.findings.empty();
}

// Identity of recordings without a calibration.
std::string identity_of(const Experiment& experiment) {
  Fnv hash;
  hash.add(std::to_string(experiment.base.identity));
  add_recordings(experiment.recordings, hash);
  return hex(hash.value());
}

// Alternatives that the proposals are not compared for.
void warn_of_unpredicted(const OpenQuestion& question, Diagnosis& out) {
  if (out.next.empty() || out.findings.empty()) return;
  for (const std::string& name : out.findings.front().alternatives) {
    const auto is = [&](const EffectHypothesis& one) { return one.effect.name == name; };
    if (std::ranges::any_of(question.candidates, is)) continue;
    out.warnings.push_back("the next experiment is chosen without regard to " + name);
  }
}

// Verdict, model and comparison of recordings without faults.
void search(PreparedTank& tank, const CalibrationSetup& recordings, Diagnosis& out) {
  out.flow_csv = tank.setup.calibration.corrected_csv(*tank.maps.best());
  out.modules = std::max(
      {out.modules, most_bodies(recordings.shapes), most_bodies(recordings.held_out_shapes)});
  if (!tank.ensemble.plan().identities) {
    out.checks.push_back(
        "there are more identities than bodies: differences between modules, "
        "heterogeneous_module among them, are not tested");
  }
  for (const std::string& one : recordings.warnings_of_begin()) out.warnings.push_back(one);
  out.nothing_held_out = recordings.held_out.empty();
  if (out.nothing_held_out) {
    out.warnings.push_back(
        "no recording was held out: what is shown of the fit is of recordings "
        "that it rests on, and says less than of others");
  }
  const Judged judged = judge(tank, recordings.training, out);
  fit_findings(tank, judged, out.nothing_held_out ? recordings.training : recordings.held_out, out);
  if (out.verdict == Verdict::missing && out.removed() < 0) {
    out.warnings.push_back(
        std::string("the model with the findings fits ") +
        (out.nothing_held_out ? "these" : "the held-out") +
        " recordings no better: repeat the diagnosis with other recordings before you use it");
  }
  const OpenQuestion question = open_question(tank.ensemble.plan(), judged, out.verdict);
  out.next = proposals(tank, question, recordings.training);
  warn_of_unpredicted(question, out);
  if (tank.ensemble.nearest(judged.observed.summary).at_bound) {
    out.warnings.push_back(
        "the parameters that are calibrated to these recordings lie at the edge of those of the "
        "null experiments");
  }
}

// "2 recordings of 240 s with 15 modules at 30 frames/s"
std::string kind_of(const std::vector<RecordingShape>& shapes) {
  double longest = 0;
  for (const RecordingShape& s : shapes) longest = std::max(longest, s.frames / s.rate);
  return counted(static_cast<int>(shapes.size()), "recording") + " of " + significant(longest, 3) +
         " s with " + std::to_string(most_bodies(shapes)) + " modules at " +
         significant(shapes.front().rate, 4) + " frames/s";
}

// Null experiments hold for recordings like those that they were simulated for.
void refuse_unlike(const CalibrationSetup& tank, const CalibrationSetup& recordings) {
  for (const RecordingShape& shape : recordings.shapes) {
    if (!shape.latches) continue;
    throw InputError(shape.name +
                     " was recorded with latches on: null experiments begin with the poses of "
                     "their own recordings, so those of another experiment do not hold for it");
  }
  const std::string of_tank = kind_of(tank.shapes), own = kind_of(recordings.shapes);
  if (own != of_tank) {
    throw InputError("the fitted recordings of " + recordings.name + " are " + own + ", those of " +
                     tank.name + " " + of_tank + ": its null experiments do not hold for these");
  }
}

// What is known of an experiment before anything is estimated.
Diagnosis begun(const Experiment& experiment) {
  Diagnosis out;
  out.name = experiment.name;
  for (const Recording& r : experiment.recordings) {
    if (r.body != BodyKind::lily) continue;
    if (r.latches && experiment.base.model.rulesets.empty()) {
      throw InputError(r.name +
                       " was recorded with latches on: name the modules' rules by ruleset.file, or "
                       "set latches = \"off\" if their magnets were off");
    }
    if (!r.has_heading()) {
      throw InputError(r.name + " has no headings: a diagnosis needs them for the drag on faces");
    }
    const std::vector<int> seen = seen_by_frame(r);
    if (!seen.empty()) out.modules = std::max(out.modules, *std::ranges::max_element(seen));
    out.recordings += 1, out.seconds += r.frames / r.rate;
  }
  return out;
}

// The directory of the results, whose lock the caller may keep.
std::shared_ptr<const DirectoryLock> claim(const DiagnosisOptions& options,
                                           const std::string& identity) {
  auto lock =
      claim_directory(options.out, options.force, {"diagnosis", identity, diagnosis_files()});
  if (options.lock != nullptr) *options.lock = lock;
  return lock;
}

// The directory of an earlier diagnosis is not replaced.
void check_tank(const DiagnosisSetup& tank) {
  try {
    check_directory(tank.options.out, false, {"diagnosis", tank.identity(), diagnosis_files()});
  } catch (const InputError&) {
    throw InputError("'" + tank.options.out + "' is not of a diagnosis of " +
                     tank.calibration.name +
                     " with the same --seed, --budget and --set: give --tank-results");
  }
}

// Whether faults of the recordings are the verdict; its directory is claimed then.
bool ends_at_fault(const Experiment& experiment, const DiagnosisOptions& options, Diagnosis& out) {
  if (!recordings_at_fault(experiment, out)) return false;
  out.verdict = Verdict::measurement;
  claim(options, "measurement " + identity_of(experiment));
  return true;
}

// The flow is that of the tank: other balls are not looked at.
Experiment lilies_of(Experiment experiment) {
  std::erase_if(experiment.recordings, [](const Recording& r) { return r.body == BodyKind::ball; });
  return experiment;
}

// Whether too little was recorded; then that is the verdict.
bool is_insufficient(const std::vector<Shortfall>& shortfalls, const DiagnosisOptions& options,
                     Diagnosis& out) {
  out.shortfalls = shortfalls;
  if (shortfalls.empty()) return false;
  if (!options.uncertified) {
    out.verdict = Verdict::insufficient, out.next = {to_meet(shortfalls)};
    return true;
  }
  for (const Shortfall& s : shortfalls) {
    out.warnings.push_back(s.what + ": error rates are not known here");
  }
  return false;
}

// `recordings`: of the tank's experiment or of another one in the same tank.
void diagnose_in(DiagnosisSetup& setup, const CalibrationSetup& recordings,
                 const DiagnosisOptions& options, Diagnosis& out) {
  const CalibrationSetup& known = setup.calibration;
  const FlowEstimate* flow = known.flow ? &*known.flow : nullptr;
  if (is_insufficient(shortfalls_of(flow, known.balls, recordings.training), options, out)) return;
  PreparedTank tank(setup, setup.model_cost());
  search(tank, recordings, out);
}

}  // namespace

std::string Detectable::parameter() const {
  return own_name(path);
}

bool GroupFit::clear() const {
  return deviation > 0 ? before > chance + 3 * deviation : before > 2 * chance;
}

double GroupFit::removed() const {
  if (before <= chance) return 0;
  return std::clamp(1 - std::max(0.0, after - chance) / (before - chance), -1.0, 1.0);
}

double Diagnosis::removed() const {
  double before = 0, after = 0;
  for (const GroupFit& g : held_out) {
    if (g.clear()) before += g.before - g.chance, after += std::max(0.0, g.after - g.chance);
  }
  return before > 0 ? 1 - after / before : std::nan("");
}

std::string name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::complete:
      return "complete";
    case Verdict::missing:
      return "missing";
    case Verdict::measurement:
      return "measurement";
    case Verdict::insufficient:
      return "insufficient";
    default:
      return "undecided";
  }
}

Diagnosis diagnose(const Experiment& experiment, const DiagnosisOptions& options) {
  Diagnosis out = begun(experiment);
  if (ends_at_fault(experiment, options, out)) return out;
  DiagnosisSetup setup(experiment, options);
  const auto lock = claim(options, setup.identity());
  diagnose_in(setup, setup.calibration, options, out);
  return out;
}

Diagnosis diagnose(const Experiment& experiment, const DiagnosedTank& earlier,
                   const DiagnosisOptions& options) {
  Diagnosis out = begun(experiment);
  if (ends_at_fault(experiment, options, out)) return out;
  if (experiment.base.identity != earlier.experiment.base.identity) {
    throw InputError("the tank of " + earlier.experiment.name +
                     " has other values of the model than " + experiment.name +
                     ": `lilytank info` shows both");
  }
  DiagnosisOptions in_tank = options;
  in_tank.out = earlier.directory, in_tank.force = false, in_tank.lock = nullptr;
  DiagnosisSetup tank(earlier.experiment, in_tank);
  const DiagnosisSetup own(lilies_of(experiment), options);
  refuse_unlike(tank.calibration, own.calibration);
  check_tank(tank);
  const auto lock = claim(options, own.identity() + " in " + tank.identity());
  const auto tank_lock = claim(tank.options, tank.identity());
  diagnose_in(tank, own.calibration, options, out);
  return out;
}

}  // namespace lilytank
