#include "calibrate/stages.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "lilytank/random.hpp"
#include "lilytank/search_run.hpp"
#include "lilytank/state.hpp"
#include "scores/flow_uncertainty.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

// Of simulating balls and extracting, in simulated experiments; 24 with the experiment of the tour.
constexpr double kFlowCost = 20;
constexpr double kRoundsExpected = 3, kRoughExpected = 4, kPredictedExpected = 6,
                 kNearestExpected = 2;
constexpr std::uint64_t kFlowSeed = 3, kFlowMix = 4, kSearchOrder = 5;

std::unique_ptr<Search> make_search(const CalibrationSetup& setup, const SearchSpace& space) {
  const CalibrationOptions& o = setup.options;
  const std::vector<double> start(setup.start.begin(),
                                  setup.start.begin() + static_cast<std::ptrdiff_t>(space.size()));
  const std::uint64_t seed = derived_seed(o.seed, kSearchOrder);
  if (o.search_name == "cma-es") {
    CmaEsOptions options;
    options.budget = o.search_budget, options.start = start;
    options.final_evaluations =
        static_cast<int>(std::clamp<std::int64_t>(o.search_budget / 10, 4, 100));
    return make_cma_es(space, options, seed);
  }
  SwarmOptions options = swarm_preset(o.search_name);
  if (o.search_particles > 0) options.particles = o.search_particles;
  if (o.search_iterations > 0) options.iterations = o.search_iterations;
  options.starts = {start};
  return make_swarm(space, options, seed);
}

std::int64_t budget_of(const CalibrationOptions& o) {
  if (o.search_name == "none") return 0;
  if (o.search_name == "cma-es") return o.search_budget;
  const SwarmOptions swarm = swarm_preset(o.search_name);
  return std::int64_t{o.search_particles > 0 ? o.search_particles : swarm.particles} *
         (o.search_iterations > 0 ? o.search_iterations : swarm.iterations) * swarm.evaluations;
}

}  // namespace

Stages::Stages(CalibrationSetup& setup)
    : setup_(setup),
      whole_(setup.emulator(setup.shapes, Of::experiments)),
      piece_(setup.emulator(setup.shapes, Of::pieces)) {
  const CalibrationOptions& o = setup.options;
  double seconds = 0;
  for (const RecordingShape& shape : setup.shapes) seconds += shape.frames / shape.rate;
  piece_cost_ = setup.piece / seconds;
  search_cost_ = static_cast<double>(budget_of(o)) * piece_cost_;
  const double rounds =
      setup.predicted() ? kPredictedExpected : kRoundsExpected + kRoughExpected * 2 * piece_cost_;
  usual_ = search_cost_ + rounds * o.round + o.replicates +
           (setup.chosen_by_displacements() ? kNearestExpected * o.round : 0) +
           (setup.held_out.empty() ? 2 : 4) * o.comparisons;
  expected_ = (setup.draws_flow() ? kFlowCost * o.flow_draws : 0) + usual_;
}

std::string Stages::file(const std::string& stage) const {
  if (setup_.options.out.empty()) return "";
  return (fs::path(setup_.options.out) / "work" / (stage + ".rows")).string();
}

std::vector<std::vector<double>> Stages::rows(const std::string& stage, int count,
                                              const std::function<std::vector<double>(int)>& work,
                                              double cost) {
  return std::move(rows(stage, {{stage, count, work}}, cost).front());
}

std::vector<std::vector<std::vector<double>>> Stages::rows(const std::string& title,
                                                           const std::vector<RowsOfStage>& stages,
                                                           double cost) {
  KeptRows kept;
  kept.identity = setup_.identity;
  kept.threads = setup_.options.threads, kept.stop = setup_.options.stop;
  std::vector<RowSet> sets;
  int count = 0;
  for (const RowsOfStage& one : stages) {
    sets.push_back({file(one.stage), one.count, one.work}), count += one.count;
  }
  kept.progress = [&](double done, const std::string& note) {
    tell(spent_ + cost * count * done, title + ", " + note);
  };
  auto out = kept_row_sets(kept, sets);
  spent_ += cost * count;
  return out;
}

Eigen::MatrixXd Stages::matrix(const std::string& stage, Eigen::Index rows,
                               const std::function<Eigen::MatrixXd()>& of) {
  const auto values = [&](int) {
    const Eigen::MatrixXd made = of();
    return std::vector<double>(made.data(), made.data() + made.size());
  };
  const auto kept = this->rows(stage, 1, values, 0);
  const auto size = static_cast<Eigen::Index>(kept.front().size());
  return Eigen::Map<const Eigen::MatrixXd>(kept.front().data(), rows, size / rows);
}

// The progress stays below 1 where rounds exceed the expected number.
void Stages::tell(double spent, const std::string& stage) const {
  setup_.options.report(std::min(0.98, spent / expected_), stage);
}

FlowMaps Stages::flow_maps() {
  if (!setup_.draws_flow()) return FlowMaps(setup_.model.field);
  const std::uint64_t seed = derived_seed(setup_.options.seed, kFlowSeed);
  const auto found = rows(
      "flow errors", setup_.options.flow_draws,
      [&](int run) {
        std::vector<double> row;
        for (const FlowSample& s :
             redraw_flow(*setup_.flow, setup_.balls, setup_.ball, FlowOptions{}, seed, run)) {
          row.insert(row.end(), {s.mu_x, s.mu_y, s.sigma_x, s.sigma_y});
        }
        return row;
      },
      kFlowCost);
  std::vector<FlowDifference> errors;
  for (const std::vector<double>& row : found) {
    FlowDifference error;
    for (std::size_t i = 0; i + 3 < row.size(); i += 4) {
      error.push_back({row[i], row[i + 1], row[i + 2], row[i + 3]});
    }
    errors.push_back(std::move(error));
  }
  FlowMaps maps(*setup_.model.field, errors, setup_.flow->draws, setup_.flow->components);
  setup_.model.field = maps.best();
  whole_ = setup_.emulator(setup_.shapes, Of::experiments);
  piece_ = setup_.emulator(setup_.shapes, Of::pieces);
  return maps;
}

std::vector<double> Stages::search(CalibrationResult& out) {
  if (setup_.options.search_name == "none") return setup_.start;
  const CalibrationSearch objective(setup_);
  std::unique_ptr<Search> search = make_search(setup_, objective.space());
  const auto value = [&](const Trial& trial) { return objective.value(trial); };
  if (setup_.options.out.empty()) {
    for (auto trials = search->ask(); !trials.empty(); trials = search->ask()) {
      std::vector<double> values;
      for (auto& row : rows(
               "search", static_cast<int>(trials.size()),
               [&](int i) {
                 return std::vector<double>{objective.value(trials[static_cast<std::size_t>(i)])};
               },
               0)) {
        values.push_back(row.front());
      }
      search->tell(values);
    }
  } else {
    SearchRunOptions run;
    run.dir = (fs::path(setup_.options.out) / "work" / "search").string();
    run.identity = "calibration " + hex(setup_.identity), run.force = setup_.options.force;
    run.threads = setup_.options.threads, run.stop = setup_.options.stop;
    run.progress = [&](double done, const std::string& note) {
      tell(spent_ + search_cost_ * done, "search, " + note);
    };
    search = run_search(std::move(search), value, run).search;
  }
  spent_ += search_cost_;
  out.history = search->history();
  std::vector<double> values = setup_.start;
  const Incumbent best = search->best();
  if (!std::isfinite(best.mean)) throw InputError("the model diverges wherever it was tried");
  std::copy(best.point.begin(), best.point.end(), values.begin());
  return values;
}

void Stages::predict_with(const std::vector<double>& values) {
  predicted_ =
      prediction_plan(setup_.model_at(values), setup_.training, most_bodies(setup_.shapes));
}

std::vector<double> Stages::numbers(const std::vector<Recording>& recordings) const {
  std::vector<double> out = setup_.numbers(recordings);
  if (!predicted_) return out;
  const std::vector<double> more = prediction_numbers(*predicted_, recordings);
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

std::vector<SummaryEntry> Stages::entries() const {
  std::vector<SummaryEntry> out = setup_.entries();
  if (!predicted_) return out;
  for (const std::string& name : prediction_names()) out.push_back({"prediction", name});
  return out;
}

std::vector<Eigen::Index> Stages::fitted() const {
  std::vector<Eigen::Index> out;
  Eigen::Index k = 0;
  for (const SummaryEntry& entry : entries()) {
    if (!predicted_ || entry.group == "kicks" || entry.group == "prediction") out.push_back(k);
    ++k;
  }
  return out;
}

std::vector<std::vector<double>> Stages::simulate(const std::string& stage,
                                                  const Eigen::MatrixXd& points, std::uint64_t seed,
                                                  const FlowMaps& maps, Of of) {
  const auto piece = [&](int i) {
    const auto made = piece_.piece(from_scale(points.row(i)), seed, i, setup_.piece);
    return made ? setup_.numbers({*made}) : std::vector<double>{};
  };
  const auto experiment = [&](int i) {
    const auto run = static_cast<std::uint64_t>(i);
    const std::uint64_t mix = derived_seed(seed, kFlowMix);
    const auto field =
        predicted_ && setup_.draws_flow() ? perturbed_flow(maps, mix, mix, i) : maps.draw(mix, i);
    const auto made = whole_.record(from_scale(points.row(i)), derived_seed(seed, 16 + run), field);
    return made ? numbers(*made) : std::vector<double>{};
  };
  const auto count = static_cast<int>(points.rows());
  if (of == Of::pieces) return rows(stage, count, piece, piece_cost_);
  simulations_ += count;
  return rows(stage, count, experiment);
}

std::vector<std::vector<double>> Stages::displacements(const std::string& stage,
                                                       const Eigen::MatrixXd& points,
                                                       std::uint64_t seed) {
  const auto count = static_cast<int>(points.rows());
  simulations_ += count;
  return rows(stage, count, [&](int i) {
    const auto made =
        whole_.record(from_scale(points.row(i)), derived_seed(seed, static_cast<unsigned>(i)));
    return made ? setup_.displacements(*made) : std::vector<double>{};
  });
}

Eigen::VectorXd Stages::to_scale(const std::vector<double>& values) const {
  Eigen::VectorXd out(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    out(static_cast<Eigen::Index>(i)) = setup_.parameters[i].to_scale(values[i]);
  }
  return out;
}

std::vector<double> Stages::from_scale(const Eigen::VectorXd& point) const {
  std::vector<double> out;
  for (std::size_t i = 0; i < setup_.parameters.size(); ++i) {
    const FitParameter& p = setup_.parameters[i];
    out.push_back(std::clamp(p.from_scale(point(static_cast<Eigen::Index>(i))), p.low, p.high));
  }
  return out;
}

FitBounds Stages::bounds() const {
  FitBounds out;
  std::vector<double> low, high;
  for (const FitParameter& p : setup_.parameters) low.push_back(p.low), high.push_back(p.high);
  out.low = to_scale(low), out.high = to_scale(high);
  return out;
}

}  // namespace lilytank
