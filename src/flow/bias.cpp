// The estimators' errors on recordings whose flow is known because it was simulated.
#include <algorithm>
#include <cmath>
#include <memory>

#include "lilytank/camera.hpp"
#include "lilytank/flow_report.hpp"
#include "lilytank/random.hpp"
#include "lilytank/world.hpp"

namespace lilytank {
namespace {

constexpr double kSettle = 5;     // s before a recording begins
constexpr int kStepsPerTick = 2;  // 12.5 ms: the balls' motion is then nearly that of the equation

/// What is different from the recordings.
struct Variant {
  std::string what;
  double tracking = 1, random_force = 1, gusts = 1, damping = 1;  // factors
  double window = 0;                                              // s, of Eq. 3; 0: unchanged
  bool smooth = true;  // whether the smooth estimator runs, too
};

const std::vector<Variant>& variants() {
  static const std::vector<Variant> all{
      {"as recorded"},
      {"no tracking noise", 0},
      {"tracking noise x 4", 4},
      {"no random force", 1, 0},
      {"random force x 2", 1, 2},
      {"no gusts", 1, 1, 0},
      {"no damping", 1, 1, 1, 0},
      {"mean flow alone", 0, 0, 0, 1, 0, false},
      {"mean flow alone, no damping", 0, 0, 0, 0, 0, false},
      {"window of 0.17 s", 1, 1, 1, 1, 0.17, false},
      {"window of 0.6 s", 1, 1, 1, 1, 0.6, false},
      {"window of 1.2 s", 1, 1, 1, 1, 1.2, false},
  };
  return all;
}

ActiveForce force(const char* name, std::initializer_list<double> values) {
  ActiveForce out = with_defaults(*find_force(name));
  std::copy(values.begin(), values.end(), out.p.begin());
  return out;
}

Model model_of(const BallPhysics& ball, const NoiseBudget& noise, const Variant& variant,
               std::shared_ptr<const FlowField> field) {
  Model m = standard_model();
  m.steps_per_tick = kStepsPerTick, m.dt = kTick / kStepsPerTick;
  m.tank.radius = ball.tank_radius;
  m.module.count = 0;
  m.ball.radius = ball.radius, m.ball.mass = ball.mass, m.ball.drag_area = ball.drag_area;
  m.flow.K_v = 1, m.flow.rho = ball.rho;
  m.field = std::move(field);
  m.start.radius = 0.85 * ball.tank_radius - ball.radius;
  m.start.distance = 2.1 * ball.radius;
  m.forces = {force("ball_drag", {ball.drag_coefficient, ball.draws}),
              force("damping", {1 - std::exp(-ball.damping)})};
  if (variant.random_force > 0) {
    m.forces.push_back(force("stochastic", {variant.random_force * noise.stochastic}));
  }
  return m;
}

Recording simulate(const Model& model, const Recording& shape, double tracking,
                   std::uint64_t seed) {
  World world(model, seed);
  Trajectory trajectory;
  const auto settle = static_cast<std::int64_t>(kSettle / model.dt);
  for (std::int64_t step = 0; step < settle; ++step) world.step();
  const double end = world.time() + shape.frames / shape.rate;
  append_poses(world, trajectory);
  while (world.time() < end && world.step() == RunStatus::ok) append_poses(world, trajectory);
  Camera camera;
  camera.rate = shape.rate, camera.position_noise = tracking, camera.seed = seed;
  return film(trajectory, camera, BodyKind::ball);
}

int bodies_of(const Recording& recording) {
  std::vector<std::int64_t> ids;
  for (const Track& t : recording.tracks) ids.push_back(t.id);
  std::sort(ids.begin(), ids.end());
  return static_cast<int>(std::unique(ids.begin(), ids.end()) - ids.begin());
}

// Recordings with the bodies, frames and rates of those given.
std::vector<Recording> like(std::span<const Recording> recordings, Model model, double tracking,
                            std::uint64_t seed) {
  std::vector<Recording> made;
  for (const Recording& one : recordings) {
    if (one.body != BodyKind::ball) continue;
    model.ball.count = bodies_of(one);
    made.push_back(simulate(model, one, tracking, derived_seed(seed, made.size())));
  }
  return made;
}

std::shared_ptr<const FlowField> scaled(const FlowEstimate& smooth, double gusts) {
  std::vector<FlowSample> samples;
  for (const FlowCell& c : smooth.cell) {
    samples.push_back({c.flow.mu_x, c.flow.mu_y, gusts * c.flow.sigma_x, gusts * c.flow.sigma_y});
  }
  std::vector<bool> measured(samples.size(), true);
  return std::make_shared<const FlowField>(smooth.cells, smooth.extent, std::move(samples),
                                           std::move(measured), Interpolation::bilinear);
}

using Estimator = FlowEstimate(std::span<const Recording>, const BallPhysics&, const FlowOptions&);

// An estimate's errors, or why these recordings, which are as short as those given, do not do.
FlowBiasRow row_of(const std::string& what, const char* name, Estimator* estimate,
                   std::span<const Recording> made, const BallPhysics& ball,
                   const FlowOptions& options, const FlowTruth& truth) {
  FlowBiasRow row{what, name, {}, {}};
  try {
    row.error = compare_flow(estimate(made, ball, options), truth, true);
  } catch (const InputError& error) {
    row.missing = error.what();
  }
  return row;
}

}  // namespace

std::vector<FlowBiasRow> measure_flow_bias(std::span<const Recording> recordings,
                                           const FlowEstimate& smooth, const BallPhysics& ball,
                                           const FlowOptions& options, std::uint64_t seed,
                                           const JobControl& control) {
  if (!smooth.noise) throw InputError("biases are measured in the flow of a smooth estimate");
  std::vector<FlowBiasRow> rows;
  double done = 0;
  for (const Variant& variant : variants()) {
    if (control.stop_requested())
      throw Stopped("stopped; nothing is kept of a measurement of biases");
    const auto field = scaled(smooth, variant.gusts);
    BallPhysics changed = ball;
    changed.damping *= variant.damping;
    const std::vector<Recording> made =
        like(recordings, model_of(changed, *smooth.noise, variant, field),
             variant.tracking * smooth.noise->tracking, seed);
    FlowOptions asked = options;
    if (variant.window > 0) {
      asked.smoothing.method = SmoothingMethod::polynomial, asked.smoothing.window = variant.window;
    }
    const FlowTruth truth{field->cells(), field->samples()};
    const auto add = [&](const char* name, Estimator* estimate) {
      rows.push_back(row_of(variant.what, name, estimate, made, changed, asked, truth));
    };
    add("paper", estimate_paper);
    if (variant.smooth) add("smooth", estimate_smooth);
    done += 1.0 / static_cast<double>(variants().size());
    control.report(done, "of the biases");
  }
  return rows;
}

}  // namespace lilytank
