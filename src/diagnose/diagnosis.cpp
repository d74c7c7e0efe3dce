#include "lilytank/diagnosis.hpp"

#include <algorithm>
#include <cmath>

#include "diagnose/diagnoser.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr double kMostMissing = 0.1;  // share of unseen frames beyond which cameras are at fault

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
    if (!r.has_heading()) {
      throw InputError(r.name + " has no headings: a diagnosis needs them for the drag on faces");
    }
    out.recordings += 1, out.seconds += r.frames / r.rate;
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
