#include "lilytank/recovery.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "lilytank/model_parameter.hpp"
#include "lilytank/random.hpp"
#include "lilytank/statistics.hpp"
#include "lilytank/study.hpp"
#include "statistics/text_table.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr std::uint64_t kTruthSeed = 4000;

RecordingShape shape(const RecoveryOptions& options, BodyKind body, int bodies) {
  RecordingShape out;
  out.body = body, out.bodies = bodies;
  out.name = body == BodyKind::lily ? "lily" : "balls";
  out.rate = options.rate, out.headings = body == BodyKind::lily;
  out.frames = 1 + static_cast<int>(std::lround(options.seconds * options.rate));
  return out;
}

std::vector<double> drawn_truth(const std::vector<FitParameter>& parameters, std::uint64_t seed) {
  std::vector<double> out;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const FitParameter& p = parameters[i];
    const double u = uniform({seed, Stream::calibrate, 0, static_cast<std::uint32_t>(i), 4});
    const double low = p.to_scale(p.low), high = p.to_scale(p.high);
    out.push_back(p.from_scale(low + (0.25 + 0.5 * u) * (high - low)));
  }
  return out;
}

struct Synthetic {
  Experiment experiment;
  std::vector<double> truth;
};

// Recordings with per-point gusts, as a run has them; the emulator that calibrates may be faster.
std::optional<Synthetic> synthesise(const Scenario& scenario, const RecoveryOptions& options,
                                    const std::vector<FitParameter>& parameters,
                                    std::uint64_t seed) {
  Synthetic out;
  out.experiment.name = "synthetic", out.experiment.base = scenario;
  out.truth = drawn_truth(parameters, seed);
  std::vector<std::string> paths;
  for (const FitParameter& p : parameters) paths.push_back(p.path);
  EmulatorOptions emulation;
  emulation.moment_matched = false;
  emulation.position_noise = options.position_noise,
  emulation.heading_noise = options.heading_noise;
  const int modules = scenario.model.module.count;
  std::vector<RecordingShape> shapes(static_cast<std::size_t>(options.recordings),
                                     shape(options, BodyKind::lily, modules));
  const Emulator lilies(scenario.model, paths, shapes, emulation);
  auto made = lilies.record(out.truth, derived_seed(seed, 1));
  if (!made) return std::nullopt;
  out.experiment.recordings = std::move(*made);
  if (options.balls == 0) return out;
  // Balls measure K_v times the flow, so K_v is the same for flow and Lilies.
  Model model = scenario.model;
  model.flow.K_v = 1;
  for (ActiveForce& force : model.forces) {
    if (force.term->name() == "ball_drag") force.p[0] = BallPhysics{}.drag_coefficient;
  }
  for (RecordingShape& s : shapes) s = shape(options, BodyKind::ball, options.balls);
  made = Emulator(model, {}, shapes, emulation).record({}, derived_seed(seed, 2));
  if (!made) return std::nullopt;
  for (Recording& one : *made) out.experiment.recordings.push_back(std::move(one));
  return out;
}

}  // namespace

std::vector<RecoveryRow> recover(const Scenario& scenario, const RecoveryOptions& options) {
  std::vector<RecoveryRow> rows;
  const std::vector<FitParameter> parameters = options.calibration.parameters.empty()
                                                   ? standard_parameters(BodyKind::lily)
                                                   : options.calibration.parameters;
  const double calibrations = options.experiments * static_cast<double>(options.objectives.size());
  int drawn = 0, calibrated = 0;
  for (int k = 0; k < options.experiments; ++k) {
    std::optional<Synthetic> made;
    while (!made) {
      const auto run = static_cast<std::uint64_t>(kTruthSeed + static_cast<unsigned>(drawn++));
      made = synthesise(scenario, options, parameters, derived_seed(options.calibration.seed, run));
      if (drawn > 20 * options.experiments) throw InputError("almost every simulation diverges");
    }
    for (const CalibrationObjective objective : options.objectives) {
      CalibrationOptions one = options.calibration;
      one.objective = objective, one.parameters = parameters, one.comparisons = 0;
      one.flow = options.balls > 0 ? CalibrationFlow::smooth : CalibrationFlow::scenario;
      const std::string name = std::to_string(k + 1) + "-" + name_of(objective);
      if (!one.out.empty()) one.out = (std::filesystem::path(one.out) / name).string();
      one.progress = [&](double done, const std::string& stage) {
        options.calibration.report((calibrated + done) / calibrations,
                                   "experiment " + name + ", " + stage);
      };
      const CalibrationResult found = calibrate(made->experiment, one);
      ++calibrated;
      if (!one.out.empty()) write_calibration(found, calibration_report(found), one.out);
      for (std::size_t i = 0; i < parameters.size(); ++i) {
        const CalibratedParameter& p = found.parameters[i];
        rows.push_back({k + 1, name_of(objective), p.parameter.path, made->truth[i], p.estimate,
                        p.low, p.high, p.parameter.low, p.parameter.high, p.parameter.logarithmic});
      }
    }
    if (options.done) options.done(rows);
  }
  return rows;
}

double RecoveryRow::interval_score() const {
  constexpr double kMissed = 2 / 0.05;
  const FitParameter scale{"", "", bound_low, bound_high, logarithmic, false};
  const double least = scale.to_scale(low), most = scale.to_scale(high), at = scale.to_scale(truth);
  const double missed = std::max({0.0, least - at, at - most});
  return (most - least + kMissed * missed) /
         (scale.to_scale(bound_high) - scale.to_scale(bound_low));
}

std::string recovery_csv(const std::vector<RecoveryRow>& rows) {
  std::string out = "experiment,objective,parameter,truth,estimate,low,high,covered\n";
  for (const RecoveryRow& r : rows) {
    out += std::to_string(r.experiment) + "," + r.objective + "," + r.parameter;
    for (const double v : {r.truth, r.estimate, r.low, r.high}) out += "," + without_rounding(v);
    out += r.covered() ? ",1\n" : ",0\n";
  }
  return out;
}

namespace {

// Rows of one objective and, unless empty, one parameter.
std::vector<const RecoveryRow*> chosen(const std::vector<RecoveryRow>& rows,
                                       const std::string& objective, const std::string& parameter) {
  std::vector<const RecoveryRow*> out;
  for (const RecoveryRow& r : rows) {
    if (r.objective == objective && (parameter.empty() || r.parameter == parameter)) {
      out.push_back(&r);
    }
  }
  return out;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n == 0 ? 0 : 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

double mean(const std::vector<double>& values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

std::vector<std::string> cells_of(const std::vector<const RecoveryRow*>& rows,
                                  const std::string& objective, const std::string& parameter) {
  std::int64_t covered = 0;
  std::vector<double> error, width, score, size;
  for (const RecoveryRow* r : rows) {
    covered += r->covered() ? 1 : 0;
    error.push_back((r->estimate - r->truth) / r->truth);
    size.push_back(std::fabs(error.back()));
    width.push_back((r->high - r->low) / (2 * r->truth));
    score.push_back(r->interval_score());
  }
  const auto n = static_cast<std::int64_t>(rows.size());
  const Estimate coverage = wilson(covered, n);
  return {objective,
          parameter.empty() ? "all" : parameter,
          std::to_string(covered) + " of " + std::to_string(n),
          fixed(100 * coverage.low, 0) + " .. " + fixed(100 * coverage.high, 0),
          fixed(100 * median(error), 1),
          fixed(100 * median(size), 1),
          fixed(100 * median(width), 1),
          fixed(100 * mean(score), 1)};
}

}  // namespace

std::string recovery_text(const std::vector<RecoveryRow>& rows) {
  TextTable table({"objective", "parameter", "covered", "95 % (%)", "bias (%)", "error (%)",
                   "half width (%)", "score (%)"});
  std::vector<std::string> objectives, parameters;
  for (const RecoveryRow& r : rows) {
    const auto add = [](std::vector<std::string>& to, const std::string& word) {
      if (std::find(to.begin(), to.end(), word) == to.end()) to.push_back(word);
    };
    add(objectives, r.objective), add(parameters, r.parameter);
  }
  for (const std::string& objective : objectives) {
    for (const std::string& p : parameters) {
      table.add(cells_of(chosen(rows, objective, p), objective, p));
    }
    table.add(cells_of(chosen(rows, objective, ""), objective, ""));
  }
  return "Coverage of 95 % intervals with its 95 % interval; medians of the error, its size and "
         "the "
         "half width,\nrelative to the true value; mean interval score (width, plus forty times "
         "the "
         "distance by which the truth is missed)\nas a fraction of the range searched: smallest "
         "for "
         "intervals that are calibrated and narrow\n\n" +
         table.text();
}

}  // namespace lilytank
