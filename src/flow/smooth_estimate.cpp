// The smooth estimate: balances, their solution, and what it says about cells and noise.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "flow/smooth_solver.hpp"

namespace lilytank {
namespace {

constexpr std::int64_t kFewest = 100;  // balances

// What moves the balls besides the mean flow.
NoiseBudget noise_budget(const SmoothSolver& solver, std::span<const Recording> recordings,
                         const BallPhysics& ball, const FlowEstimate& estimate) {
  NoiseBudget out;
  const Eigen::VectorXd& log_s2 = solver.now().log_s2;
  // The mean standard deviation, and its derivative by log s^2 at each node.
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(log_s2.size());
  const double cells = estimate.measured();
  for (int n = 0; n < solver.nodes().size(); ++n) {
    const FlowCell& cell = estimate.cell[solver.nodes().cell(n)];
    if (!cell.measured) continue;
    out.gusts += cell.flow.sigma_x / cells;
    weight[n] = cell.flow.sigma_x / 2 / cells;
  }
  out.gusts_error = std::sqrt(solver.log_variance(weight));
  // The random force: the kicks' strength, less the gusts' part.
  const FlowUnknowns& now = solver.now();
  const double relative = 1 / std::sqrt(static_cast<double>(solver.sums().count));
  const double by_gusts = (now.kick - now.random_kick) * 2 * out.gusts_error / out.gusts;
  const double kick_error = std::hypot(relative * now.kick, by_gusts);
  const double scale = ball.mass / std::sqrt(ball.gust_interval);
  out.stochastic = scale * std::sqrt(now.random_kick);
  out.stochastic_error =
      scale * kick_error / (2 * std::sqrt(std::max(now.random_kick, kick_error)));
  // Tracking noise: what second differences from frame to frame have beyond the kicks.
  double variance = 0, error = 0, count = 0;
  for (const Recording& recording : recordings) {
    if (recording.body != BodyKind::ball) continue;
    const SecondDifference d = second_difference({&recording, 1}, 1);
    const double share = second_difference_share(1 / recording.rate, ball.gust_interval);
    // A steady acceleration shows in second differences, too.
    const double steady = solver.sums().pulls / std::pow(recording.rate, 4);
    const double n = static_cast<double>(d.count);
    variance += n * (d.mean_square - now.kick * share - steady) / 6;
    // Neighbours overlap: white noise's second differences count half.
    error = std::max(error, std::hypot(2 * d.mean_square / std::sqrt(n), kick_error * share) / 6);
    count += n;
  }
  variance = std::max(0.0, variance / count);
  out.tracking = std::sqrt(variance);
  out.tracking_error = error / (2 * std::sqrt(std::max(variance, error)));
  return out;
}

struct Balances {
  std::vector<BalanceSet> sets;
  double kick = 0;
};

Balances all_balances(std::span<const Recording> recordings, const BallPhysics& ball,
                      FlowEstimate& out) {
  Balances all;
  for (const Recording& recording : recordings) {
    if (recording.body != BodyKind::ball) continue;
    const TrackNoise noise = track_noise({&recording, 1}, recording.rate, ball.gust_interval);
    const BalanceShape shape = balance_shape(recording.rate, noise, ball.gust_interval);
    all.sets.push_back(find_balances(recording, ball, shape, noise));
    all.kick = std::max(all.kick, noise.kick);
    out.samples += static_cast<std::int64_t>(all.sets.back().balances.size());
    out.dropped += all.sets.back().dropped;
    char text[160];
    std::snprintf(text, sizeof text,
                  "changes of velocity over %.3g s, velocities over %.3g s to both sides",
                  shape.duration(), shape.box() / 2);
    out.filter = text;
  }
  if (out.samples < kFewest) {
    throw InputError("the balls' tracks hold " + std::to_string(out.samples) +
                     " momentum balances without a contact; " + std::to_string(kFewest) +
                     " are the least");
  }
  return all;
}

FlowCell cell_of(const SmoothSolver& solver, int node, const BallPhysics& ball) {
  FlowCell cell;
  const FlowUnknowns& now = solver.now();
  const double sigma = std::sqrt(ball.draws * std::exp(now.log_s2[node]));
  const double error = sigma / 2 * std::sqrt(solver.log_variance(node));
  const auto variance = solver.mean_variance(node);
  cell.flow = {now.mean[2 * node], now.mean[2 * node + 1], sigma, sigma};
  cell.error = {std::sqrt(variance[0]), std::sqrt(variance[1]), error, error};
  return cell;
}

// A draw less the estimate. Standard deviations are scaled, as they cannot be negative.
FlowDifference drawn(const SmoothSolver& solver, const FlowEstimate& estimate, int run) {
  FlowDifference out(estimate.cell.size());
  const SmoothSolver::Change change = solver.draw(run);
  for (int n = 0; n < solver.nodes().size(); ++n) {
    const auto i = static_cast<std::size_t>(solver.nodes().cell(n));
    const double sigma = estimate.cell[i].flow.sigma_x * (std::exp(change.log_s2[n] / 2) - 1);
    out[i] = {change.mean[2 * n], change.mean[2 * n + 1], sigma, sigma};
  }
  return out;
}

std::vector<FlowDifference> components(const SmoothSolver& solver, const FlowEstimate& estimate,
                                       int count, double radius) {
  const Eigen::MatrixXd found = solver.components(count, radius);
  std::vector<FlowDifference> out;
  for (Eigen::Index k = 0; k < found.cols(); ++k) {
    FlowDifference& one = out.emplace_back(estimate.cell.size());
    for (int n = 0; n < solver.nodes().size(); ++n) {
      FlowSample& of = one[static_cast<std::size_t>(solver.nodes().cell(n))];
      of.mu_x = found(2 * n, k), of.mu_y = found(2 * n + 1, k);
    }
  }
  return out;
}

}  // namespace

FlowEstimate estimate_smooth(std::span<const Recording> recordings, const BallPhysics& ball,
                             const FlowOptions& options) {
  FlowEstimate out = empty_estimate(recordings, ball, options, "smooth");
  const Balances all = all_balances(recordings, ball, out);
  SmoothSolver solver(all.sets, ball, {out.cells, out.extent});
  solver.solve(all.kick);
  const int frames_each = all.sets.front().shape.length;
  for (int n = 0; n < solver.nodes().size(); ++n) {
    const auto i = static_cast<std::size_t>(solver.nodes().cell(n));
    out.cell[i] = cell_of(solver, n, ball);
    out.cell[i].samples = solver.sums().per_cell[i];
    out.cell[i].measured = out.cell[i].samples * frames_each >= options.least_samples;
  }
  out.smoothness = solver.free_values();
  fill_cells(out);
  out.noise = noise_budget(solver, recordings, ball, out);
  for (int run = 0; run < options.draws; ++run) out.draws.push_back(drawn(solver, out, run));
  if (options.components > 0) {
    out.components = components(solver, out, options.components, kVisitedRadius * ball.tank_radius);
  }
  return out;
}

}  // namespace lilytank
