#include "calibrate/setup.hpp"

#include <algorithm>
#include <cmath>

#include "lilytank/model_parameter.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr double kLongest = 60;                  // s of MSD in Eq. 9
constexpr Eq9 kLocalCurve{60, 0.5, 0.6, false};  // coarser: neighbouring lags tell the same

void split(const Experiment& experiment, CalibrationSetup& setup) {
  for (const Recording& one : experiment.recordings) {
    if (one.body == setup.body) {
      (one.held_out ? setup.held_out : setup.training).push_back(one);
    } else if (one.body == BodyKind::ball && !one.held_out) {
      setup.balls.push_back(one);
    }
  }
  const std::string kind = setup.body == BodyKind::lily ? "lily" : "ball";
  for (int k = 0; k < setup.options.hold_out && !setup.training.empty(); ++k) {
    setup.held_out.push_back(std::move(setup.training.back()));
    setup.training.pop_back();
  }
  if (setup.body == BodyKind::ball) setup.balls = setup.training;
  if (setup.training.empty()) {
    throw InputError("experiment " + experiment.name + " has no recording of body = \"" + kind +
                     "\" that is not held out: there is nothing to calibrate from");
  }
  for (const Recording& one : setup.training) {
    if (std::fabs(one.rate - setup.training.front().rate) < 1e-6 * one.rate) continue;
    throw InputError(one.name + " has " + shortest(one.rate) + " frames per second, " +
                     setup.training.front().name + " " + shortest(setup.training.front().rate) +
                     ": recordings that are compared together need one rate");
  }
}

void find_flow(const Experiment& experiment, CalibrationSetup& setup) {
  setup.ball = ball_physics(experiment.base);
  if (setup.options.flow == CalibrationFlow::scenario) return;
  if (setup.balls.empty()) {
    if (setup.options.flow == CalibrationFlow::smooth) return;
    throw InputError("experiment " + experiment.name +
                     " has no recordings of balls to extract the flow from");
  }
  setup.flow = setup.options.flow == CalibrationFlow::paper
                   ? estimate_paper(setup.balls, setup.ball)
                   : estimate_smooth(setup.balls, setup.ball,
                                     {.draws = setup.options.posterior_draws,
                                      .components = setup.options.posterior_components});
  setup.model.field = std::make_shared<const FlowField>(
      field_of(*setup.flow, experiment.base.model.field->interpolation()));
}

// Averages over recordings of the white noise in positions and headings.
void find_noise(CalibrationSetup& setup) {
  double place = 0, heading = 0;
  for (const Recording& one : setup.training) {
    place += fit_position(one).noise;
    if (one.has_heading()) heading += fit_heading(one).noise;
  }
  const auto n = static_cast<double>(setup.training.size());
  const auto nuisance = [&](const std::string& path, double value, double least) {
    value = std::max(value, least);
    setup.parameters.push_back(
        {path, emulator_parameter(path).unit, 0.2 * value, 4 * value, true, true});
    setup.start.push_back(value);
  };
  nuisance(kPositionNoise, place / n, 1e-5);
  if (setup.summary.headings) nuisance(kHeadingNoise, heading / n, 1e-4);
}

void find_parameters(const Experiment& experiment, CalibrationSetup& setup) {
  setup.parameters = setup.options.parameters;
  if (setup.parameters.empty()) setup.parameters = standard_parameters(setup.body);
  const std::vector<double>& given = setup.options.start;
  for (std::size_t i = 0; i < setup.parameters.size(); ++i) {
    const FitParameter& p = setup.parameters[i];
    const double value =
        i < given.size() ? given[i] : parameter_value(experiment.base.model, p.path);
    setup.start.push_back(std::clamp(value, p.low, p.high));
  }
}

void find_summary(CalibrationSetup& setup) {
  for (const auto* all : {&setup.training, &setup.held_out}) {
    // Half of the frames, rounded down: two pieces must fit.
    for (const Recording& one : *all)
      setup.piece = std::min(setup.piece, one.frames / 2 / one.rate);
  }
  // Where recordings are short, two pieces of each, for the noise floor.
  if (setup.piece < 2) throw InputError("recordings shorter than 4 s do not constrain a tank");
  MotionSummary& s = setup.summary;
  s.tank_radius = setup.model.tank.radius;
  s.body_size =
      setup.body == BodyKind::lily ? setup.model.module.side : 2 * setup.model.ball.radius;
  s.rate = setup.training.front().rate, s.longest = setup.piece;
  s.headings = std::all_of(setup.training.begin(), setup.training.end(),
                           [](const Recording& one) { return one.has_heading(); });
  s.field = setup.model.field;
}

std::uint64_t identity_of(const Experiment& experiment, const CalibrationSetup& setup) {
  const CalibrationOptions& o = setup.options;
  Fnv hash;
  hash.add("calibration 5 " + std::to_string(experiment.base.identity));
  for (const auto* of : {&setup.training, &setup.held_out, &setup.balls}) add_recordings(*of, hash);
  for (std::size_t i = 0; i < setup.parameters.size(); ++i) {
    const FitParameter& p = setup.parameters[i];
    hash.add(p.path + " " + shortest(p.low) + " " + shortest(p.high) + " " +
             shortest(setup.start[i]));
  }
  hash.add(name_of(o.objective) + " " + name_of(o.flow) + " " + o.search_name);
  for (const std::int64_t number :
       {std::int64_t{o.search_particles}, std::int64_t{o.search_iterations}, o.search_budget,
        std::int64_t{o.flow_draws}, std::int64_t{o.round}, std::int64_t{o.last_round},
        std::int64_t{o.most_rounds}, std::int64_t{o.replicates}, std::int64_t{o.comparisons},
        static_cast<std::int64_t>(o.seed)}) {
    hash.add(std::to_string(number));
  }
  return hash.value();
}

// Options that go by the objective.
void complete(const Experiment& experiment, CalibrationSetup& setup) {
  const bool predicted = setup.predicted();
  if (predicted && default_objective(experiment, setup.body, setup.parameters) !=
                       CalibrationObjective::prediction) {
    throw InputError(
        "objective prediction is for the paper's five parameters of Lilies recorded with headings: "
        "use summary");
  }
  CalibrationOptions& o = setup.options;
  if (o.search_name.empty()) o.search_name = predicted ? "none" : "cma-es";
  if (o.flow_draws < 0) o.flow_draws = predicted ? 12 : 24;
  if (o.round == 0) o.round = predicted ? 60 : 120;
  if (o.last_round == 0) o.last_round = 2 * o.round;
  if (o.replicates == 0) o.replicates = predicted ? 100 : 200;
}

std::vector<RecordingShape> shapes_of(const std::vector<Recording>& recordings, double side) {
  std::vector<RecordingShape> shapes;
  for (const Recording& one : recordings) shapes.push_back(shape_of(one, side));
  return shapes;
}

}  // namespace

std::vector<std::string> CalibrationSetup::warnings_of_begin() const {
  std::vector<std::string> out;
  for (const auto* all : {&shapes, &held_out_shapes}) {
    for (const RecordingShape& shape : *all) {
      if (!shape.latches || !shape.starts.empty()) continue;
      out.push_back(shape.name +
                    ": no frame of the first second shows all modules with their headings, so "
                    "simulations of it begin with single modules at random places: begin the "
                    "recording at a frame that does");
    }
  }
  return out;
}

int most_bodies(const std::vector<RecordingShape>& shapes) {
  int most = 0;
  for (const RecordingShape& shape : shapes) most = std::max(most, shape.bodies);
  return most;
}

void add_recordings(const std::vector<Recording>& recordings, Fnv& hash) {
  for (const Recording& one : recordings) {
    hash.add(one.name + " " + shortest(one.rate) + " " + std::to_string(one.frames));
    for (const Track& track : one.tracks) {
      for (const auto* of : {&track.x, &track.y, &track.theta}) {
        hash.add(*of);
      }
    }
    for (const LoggedEvent& e : one.events) {
      hash.add(shortest(e.time) + " " + std::to_string(static_cast<int>(e.kind)) + " " +
               std::to_string(e.a) + " " + std::to_string(e.b));
    }
  }
}

std::vector<std::string> CalibrationSetup::paths() const {
  std::vector<std::string> out;
  for (const FitParameter& p : parameters) out.push_back(p.path);
  return out;
}

bool CalibrationSetup::draws_flow() const {
  return flow && flow->noise && options.flow_draws >= 2;
}

Prior CalibrationSetup::prior() const {
  const auto n = static_cast<Eigen::Index>(parameters.size());
  Prior out{Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const FitParameter& p = parameters[static_cast<std::size_t>(k)];
    const double low = p.to_scale(p.low), high = p.to_scale(p.high);
    out.expected(k) = 0.5 * (low + high), out.deviation(k) = (high - low) / std::sqrt(12.0);
  }
  return out;
}

bool CalibrationSetup::summarised() const {
  return options.objective == CalibrationObjective::summary || predicted();
}

bool CalibrationSetup::predicted() const {
  return options.objective == CalibrationObjective::prediction;
}

bool CalibrationSetup::chosen_by_displacements() const {
  return options.objective == CalibrationObjective::summary && draws_flow();
}

std::size_t CalibrationSetup::reported_count() const {
  return static_cast<std::size_t>(std::count_if(parameters.begin(), parameters.end(),
                                                [](const FitParameter& p) { return !p.nuisance; }));
}

Emulator CalibrationSetup::emulator(const std::vector<RecordingShape>& shapes_of, Of of) const {
  EmulatorOptions how;
  how.moment_matched = of == Of::pieces;
  return Emulator(model, paths(), shapes_of, how);
}

Model CalibrationSetup::model_at(const std::vector<double>& values) const {
  const auto reported = static_cast<std::ptrdiff_t>(reported_count());
  std::vector<std::string> of = paths();
  of.resize(reported_count());
  return with_parameters(model, of, std::vector<double>(values.begin(), values.begin() + reported));
}

std::vector<double> CalibrationSetup::numbers(const std::vector<Recording>& recordings) const {
  if (summarised()) return summarise(recordings, summary);
  return displacements(recordings);
}

std::vector<double> CalibrationSetup::displacements(
    const std::vector<Recording>& recordings) const {
  Eq9 rule = kLocalCurve;
  rule.seconds = piece;
  std::vector<double> curve = eq9_curve(recordings, rule);
  for (double& value : curve) {
    if (std::isnan(value)) value = 0;
  }
  return curve;
}

std::vector<SummaryEntry> CalibrationSetup::entries() const {
  if (summarised()) return summary_entries(summary);
  std::vector<SummaryEntry> out;
  const auto n = std::lround(piece / kLocalCurve.lag);
  for (long k = 1; k <= n; ++k) {
    out.push_back({"displacement",
                   "msd " + without_rounding(static_cast<double>(k) * kLocalCurve.lag) + " s"});
  }
  return out;
}

std::string CalibrationSetup::corrected_csv(const FlowField& best) const {
  if (!flow) return "";
  FlowEstimate estimate = *flow;
  for (std::size_t i = 0; i < estimate.cell.size(); ++i) estimate.cell[i].flow = best.samples()[i];
  return flow_csv(estimate);
}

CalibrationSetup set_up(const Experiment& experiment, const CalibrationOptions& options) {
  CalibrationSetup setup;
  setup.options = options, setup.name = experiment.name, setup.body = options.body;
  setup.model = experiment.base.model, setup.piece = kLongest;
  split(experiment, setup);
  find_flow(experiment, setup);
  find_summary(setup);
  find_parameters(experiment, setup);
  complete(experiment, setup);
  find_noise(setup);
  const double side = setup.model.module.side;
  setup.shapes = shapes_of(setup.training, side);
  setup.held_out_shapes = shapes_of(setup.held_out, side);
  setup.model.control.latches =
      std::ranges::any_of(setup.shapes, [](const RecordingShape& s) { return s.latches; });
  setup.identity = identity_of(experiment, setup);
  return setup;
}

std::vector<Recording> pieces_of(const std::vector<Recording>& recordings, double seconds) {
  std::vector<Recording> out;
  for (const Recording& one : recordings) {
    const int length = static_cast<int>(std::lround(seconds * one.rate)) + 1;
    for (int first = 0; first + length <= one.frames + 1; first += length - 1) {
      Recording piece = one;
      piece.tracks.clear(), piece.frames = length, piece.start = one.time(first);
      for (const Track& track : one.tracks) {
        const int begin = std::max(first, track.first);
        const int end = std::min(first + length, track.last() + 1);
        if (end - begin < 2) continue;
        Track part;
        part.id = track.id, part.first = begin - first;
        const auto cut = [&](const std::vector<double>& of) {
          if (of.empty()) return std::vector<double>{};
          return std::vector<double>(of.begin() + (begin - track.first),
                                     of.begin() + (end - track.first));
        };
        part.x = cut(track.x), part.y = cut(track.y), part.theta = cut(track.theta);
        piece.tracks.push_back(std::move(part));
      }
      out.push_back(std::move(piece));
    }
  }
  return out;
}

}  // namespace lilytank
