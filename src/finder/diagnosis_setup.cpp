#include "finder/diagnosis_setup.hpp"

#include <algorithm>
#include <cmath>

#include "scores/nuisances.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr int kPosteriorDraws = 1000;  // a variance by these is known to 5 %

CalibrationOptions calibration_of(const Experiment& experiment, const DiagnosisOptions& o,
                                  const DiagnosisBudget& budget) {
  CalibrationOptions c;
  c.parameters = standard_parameters(BodyKind::lily);
  const bool marked =
      std::any_of(experiment.recordings.begin(), experiment.recordings.end(),
                  [](const Recording& r) { return r.body == BodyKind::lily && r.held_out; });
  const auto lilies = std::count_if(experiment.recordings.begin(), experiment.recordings.end(),
                                    [](const Recording& r) { return r.body == BodyKind::lily; });
  c.hold_out = marked || lilies < 2 ? 0 : std::min(o.hold_out, static_cast<int>(lilies) - 1);
  c.flow_draws = budget.flow_draws;
  c.posterior_draws = kPosteriorDraws, c.posterior_components = Nuisances::kMeanModes;
  c.round = budget.centre, c.seed = o.seed, c.out = o.out, c.force = o.force;
  c.threads = o.threads, c.stop = o.stop, c.progress = o.progress;
  return c;
}

}  // namespace

DiagnosisBudget::DiagnosisBudget(double minutes) {
  const double s = std::clamp(minutes, kLeastTankMinutes, 40.0) / 10;
  const auto scaled = [&](int n, int least) {
    return std::max(least, static_cast<int>(std::lround(n * s)));
  };
  flow_draws = scaled(12, 12), centre = 70;
  nulls = scaled(240, 160), round = scaled(80, 80);
  learning = {scaled(5, 5), scaled(3, 3)};
  comparisons = scaled(16, 12);
}

DiagnosisSetup::DiagnosisSetup(const Experiment& experiment,
                               const DiagnosisOptions& diagnosis_options)
    : options(diagnosis_options),
      budget(options.minutes),
      calibration(set_up(experiment, calibration_of(experiment, options, budget))),
      stages(calibration) {}

std::string DiagnosisSetup::identity() const {
  return "40 " + hex(calibration.identity) + " " + shortest(options.minutes);
}

}  // namespace lilytank
