#include "lilytank/flow_maps.hpp"

#include <algorithm>
#include <cmath>

#include "lilytank/emulator.hpp"
#include "lilytank/random.hpp"

namespace lilytank {
namespace {

constexpr int kStepsPerTick = 5;  // 5 ms: longer steps would add errors that recordings do not have

ActiveForce force(const char* name, std::initializer_list<double> values) {
  ActiveForce out = with_defaults(*find_force(name));
  std::copy(values.begin(), values.end(), out.p.begin());
  return out;
}

// A model of balls with the flow estimator's equation of motion.
Model ball_model(const FlowEstimate& estimate, const BallPhysics& ball) {
  Model m = standard_model();
  m.steps_per_tick = kStepsPerTick, m.dt = kTick / kStepsPerTick;
  m.tank.radius = ball.tank_radius;
  m.ball.radius = ball.radius, m.ball.mass = ball.mass, m.ball.drag_area = ball.drag_area;
  m.flow.K_v = 1, m.flow.rho = ball.rho;
  m.field = std::make_shared<const FlowField>(field_of(estimate, Interpolation::bilinear));
  m.start.radius = 0.85 * ball.tank_radius - ball.radius, m.start.distance = 2.1 * ball.radius;
  m.forces = {force("ball_drag", {ball.drag_coefficient, ball.draws}),
              force("stochastic", {estimate.noise->stochastic}),
              force("damping", {1 - exp_portable(-ball.damping)})};
  return m;
}

void add(FlowSample& to, const FlowSample& from, double times) {
  to.mu_x += times * from.mu_x, to.mu_y += times * from.mu_y;
  to.sigma_x += times * from.sigma_x, to.sigma_y += times * from.sigma_y;
}

// A field on the cells of another, deviations cut at 0.
std::shared_ptr<const FlowField> like(const FlowField& other, std::vector<FlowSample> samples) {
  for (FlowSample& s : samples) {
    s.sigma_x = std::max(s.sigma_x, 0.0), s.sigma_y = std::max(s.sigma_y, 0.0);
  }
  return std::make_shared<const FlowField>(other.cells(), other.extent(), std::move(samples),
                                           other.measured(), other.interpolation());
}

}  // namespace

FlowDifference redraw_flow(const FlowEstimate& estimate, std::span<const Recording> balls,
                           const BallPhysics& physics, const FlowOptions& options,
                           std::uint64_t seed, int run) {
  if (!estimate.noise) throw InputError("the flow's error is drawn for a smooth estimate only");
  std::vector<RecordingShape> shapes;
  for (const Recording& one : balls) {
    // Simulated balls start as the recording begins.
    if (one.body == BodyKind::ball) shapes.push_back(shape_of(one, 0, 1e6));
  }
  EmulatorOptions emulation;
  emulation.settle = 5, emulation.position_noise = estimate.noise->tracking;
  const Emulator emulator(ball_model(estimate, physics), {}, std::move(shapes), emulation);
  const auto made = emulator.record({}, derived_seed(seed, static_cast<std::uint64_t>(run)));
  if (!made) throw InputError("balls diverge in the flow that was found: is it that of this tank?");
  const FlowEstimate again = estimate_smooth(*made, physics, options);
  FlowDifference out;
  for (std::size_t i = 0; i < again.cell.size(); ++i) {
    FlowSample difference = again.cell[i].flow;
    add(difference, estimate.cell[i].flow, -1);
    out.push_back(difference);
  }
  return out;
}

FlowMaps::FlowMaps(const FlowField& extracted, const std::vector<FlowDifference>& errors,
                   const std::vector<FlowDifference>& open, std::vector<FlowDifference> components)
    : components_(std::move(components)) {
  const auto mean = [&](const std::vector<FlowDifference>& of) {
    FlowDifference out(extracted.samples().size());
    for (const FlowDifference& one : of) {
      for (std::size_t i = 0; i < out.size(); ++i) {
        add(out[i], one[i], 1 / static_cast<double>(of.size()));
      }
    }
    return out;
  };
  const FlowDifference middle = mean(open), bias = mean(errors);
  open_.reserve(4 * open.size() * extracted.samples().size());
  for (const FlowDifference& one : open) {
    for (std::size_t i = 0; i < one.size(); ++i) {
      FlowSample off = one[i];
      add(off, middle[i], -1);
      for (const double value : {off.mu_x, off.mu_y, off.sigma_x, off.sigma_y}) {
        open_.push_back(static_cast<float>(value));
      }
    }
  }
  std::vector<FlowSample> samples = extracted.samples();
  for (std::size_t i = 0; i < samples.size(); ++i) add(samples[i], bias[i], -1);
  field_ = like(extracted, std::move(samples));
}

std::shared_ptr<const FlowField> FlowMaps::draw(std::uint64_t seed, std::int64_t run) const {
  if (!uncertain()) return field_;
  std::vector<FlowSample> samples = field_->samples();
  const std::size_t values = 4 * samples.size(), draws = open_.size() / values;
  std::vector<float> sum(values);
  for (std::size_t k = 0; k < draws; ++k) {
    const auto z = static_cast<float>(
        normal_pair({seed, Stream::calibrate, run, static_cast<std::uint32_t>(k), 1})[0]);
    const float* draw = &open_[k * values];
    for (std::size_t i = 0; i < values; ++i) sum[i] += z * draw[i];
  }
  const double scale = 1 / std::sqrt(static_cast<double>(draws - 1));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const float* of = &sum[4 * i];
    add(samples[i], {of[0], of[1], of[2], of[3]}, scale);
  }
  return like(*field_, std::move(samples));
}

}  // namespace lilytank
