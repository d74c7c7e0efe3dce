#include <algorithm>
#include <cmath>
#include <cstdio>

#include "flow/gust_fit.hpp"
#include "flow/smooth_fit.hpp"
#include "lilytank/random.hpp"

namespace lilytank {
namespace {

constexpr double kGuess = 0.15;           // m/s, deviation of gusts before anything is known
constexpr double kFirstSmoothness = 5e3;  // s^2/m^2, weight of squared second differences
constexpr std::int64_t kSketch = 60000;   // balances of the first rounds
constexpr int kFirstRounds = 5, kRounds = 7;
constexpr double kOutlier = 20;        // variances; a fair one exceeds this once in 22,000
constexpr std::int64_t kFewest = 100;  // balances
constexpr double kSettled = 3e-4;      // m/s, change of the mean flow

using Matrix = Eigen::SparseMatrix<double>;

// Newton's rounds: the mean flow with its smoothness, the gusts' strength, the kicks.
class Solver {
 public:
  Solver(std::span<const BalanceSet> sets, const BallPhysics& ball, const FlowGrid& grid)
      : ball_(ball),
        nodes_(grid, ball.tank_radius),
        fit_(sets, ball, grid, nodes_),
        roughness_(nodes_.roughness()),
        splines_(nodes_.splines(ball.tank_radius / 3)) {
    now_.mean = Eigen::VectorXd::Zero(2 * nodes_.size());
    start_ = std::log(kGuess * kGuess / ball.draws);
    now_.log_s2 = Eigen::VectorXd::Constant(nodes_.size(), start_);
    gusts_.mean = Eigen::VectorXd::Zero(splines_.cols());
    for (const BalanceSet& set : sets) balances_ += static_cast<std::int64_t>(set.balances.size());
  }

  // First on a part of the balances, where there are many: that settles nearly everything.
  void solve(double kick) {
    now_.kick = now_.random_kick = kick;
    const int stride = static_cast<int>(std::max<std::int64_t>(1, balances_ / kSketch));
    for (int round = 0; round < kFirstRounds; ++round) {
      if (round >= 2) now_.outlier = kOutlier;
      sums_ = fit_.sum(now_, stride, nullptr);
      step_mean();
      set_kick();
    }
    find_covariance();
    settle(stride);
    if (stride > 1) settle(1);
    find_covariance();
    sums_ = fit_.sum(now_, 1, &covariance_);
  }

  const NodeGrid& nodes() const { return nodes_; }
  const FlowUnknowns& now() const { return now_; }
  const FlowSums& sums() const { return sums_; }
  double free_values() const { return free_values_; }

  // Variances of a node's mean flow: of the fit itself, and by the gusts' uncertainty.
  std::array<double, 2> mean_variance(int node) const {
    const auto& own = covariance_.block[static_cast<std::size_t>(node * 9 + 4)];
    const Eigen::RowVectorXd x = carried_.row(2 * node), y = carried_.row(2 * node + 1);
    return {own[0] + x * gusts_.covariance * x.transpose(),
            own[2] + y * gusts_.covariance * y.transpose()};
  }
  double log_variance(int node) const {
    const Eigen::RowVectorXd f = splines_.row(node);
    return f * gusts_.covariance * f.transpose();
  }
  // Variance of a weighted sum of log s^2 over nodes.
  double log_variance(const Eigen::VectorXd& weight) const {
    const Eigen::VectorXd f = splines_.transpose() * weight;
    return f.dot(gusts_.covariance * f);
  }

 private:
  void settle(int stride) {
    for (int round = 0; round < kRounds; ++round) {
      sums_ = fit_.sum(now_, stride, &covariance_);
      const double change = step_both();
      set_kick();
      if (change < kSettled) break;
      if (round == 0) find_covariance();
    }
  }

  Matrix assemble() const {
    std::vector<Eigen::Triplet<double>> entries;
    for (int n = 0; n < nodes_.size(); ++n) {
      for (int o = 0; o < 9; ++o) {
        const int m = nodes_.beside(n, o % 3 - 1, o / 3 - 1);
        if (m < 0) continue;
        for (int i = 0; i < 2; ++i) {
          for (int j = 0; j < 2; ++j) {
            entries.emplace_back(2 * n + i, 2 * m + j, sums_.block(n, o, i, j));
          }
        }
      }
    }
    for (int c = 0; c < roughness_.outerSize(); ++c) {
      for (Matrix::InnerIterator it(roughness_, c); it; ++it) {
        const int r = static_cast<int>(it.row());
        for (int i = 0; i < 2; ++i) {
          entries.emplace_back(2 * r + i, 2 * c + i, smoothness_ * it.value());
        }
      }
    }
    Matrix out(2 * nodes_.size(), 2 * nodes_.size());
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
  }

  Eigen::VectorXd rough(const Eigen::VectorXd& mean) const {
    const Eigen::Map<const Eigen::Matrix<double, 2, Eigen::Dynamic>> pairs(mean.data(), 2,
                                                                           nodes_.size());
    const Eigen::Matrix<double, 2, Eigen::Dynamic> out = pairs * roughness_;
    return Eigen::Map<const Eigen::VectorXd>(out.data(), mean.size());
  }

  void factor() {
    const Matrix all = assemble();
    if (!analysed_) factor_.analyzePattern(all);
    analysed_ = true;
    factor_.factorize(all);
    if (factor_.info() != Eigen::Success) {
      throw InputError("the tracks do not determine the flow: too few momentum balances");
    }
  }

  Eigen::VectorXd mean_right() const { return sums_.mean - smoothness_ * rough(now_.mean); }

  void step_mean() {
    factor();
    const Eigen::VectorXd step = factor_.solve(mean_right());
    now_.mean += step;
    set_smoothness();
  }

  // Mean flow and gusts together: the mean is eliminated, the gusts solved for, the mean follows.
  double step_both() {
    factor();
    const Eigen::VectorXd step = factor_.solve(mean_right());
    Matrix own(nodes_.size(), nodes_.size());
    const Eigen::MatrixXd coupling = couple(own);
    carried_ = factor_.solve(coupling);
    const Eigen::MatrixXd information =
        splines_.transpose() * (own * splines_) - coupling.transpose() * carried_;
    const Eigen::VectorXd slope = splines_.transpose() * sums_.log_s2 - coupling.transpose() * step;
    const GustPosterior next = gust_posterior(information, information * gusts_.mean + slope);
    const Eigen::VectorXd change = next.mean - gusts_.mean;
    gusts_ = next;
    now_.log_s2 = (start_ + (splines_ * gusts_.mean).array()).matrix();
    const Eigen::VectorXd moved = step - carried_ * change;
    now_.mean += moved;
    set_smoothness();
    return std::sqrt(moved.squaredNorm() / static_cast<double>(moved.size()));
  }

  // Second derivatives between mean flow and spline coefficients; `own`: between log s^2 at nodes.
  Eigen::MatrixXd couple(Matrix& own) const {
    std::vector<Eigen::Triplet<double>> entries, owned;
    for (int n = 0; n < nodes_.size(); ++n) {
      for (int o = 0; o < 9; ++o) {
        const int m = nodes_.beside(n, o % 3 - 1, o / 3 - 1);
        if (m < 0) continue;
        for (int i = 0; i < 2; ++i) entries.emplace_back(2 * n + i, m, sums_.block(n, o, i, 2));
        owned.emplace_back(n, m, sums_.block(n, o, 2, 2));
      }
    }
    Matrix cross(now_.mean.size(), nodes_.size());
    cross.setFromTriplets(entries.begin(), entries.end());
    own.setFromTriplets(owned.begin(), owned.end());
    return cross * splines_;
  }

  // The weight under which the fitted field is as rough as expected [MacKay, Neural Computation 4,
  // 1992]; the trace comes from random probes [Hutchinson, Commun. Stat. Simul. 18, 1989].
  void set_smoothness() {
    constexpr int kProbes = 8;
    const Eigen::Index n = now_.mean.size();
    double trace = 0;
    for (int p = 0; p < kProbes; ++p) {
      Eigen::VectorXd probe(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        const auto bits = random_bits({0, Stream::bootstrap, p, static_cast<std::uint32_t>(i), 0});
        probe[i] = (bits[0] & 1U) == 0 ? -1 : 1;
      }
      trace += factor_.solve(probe).dot(rough(probe)) / kProbes;
    }
    // Plane fields, three values each, cost nothing.
    free_values_ = std::max(1.0, static_cast<double>(n) - smoothness_ * trace);
    const double sum = now_.mean.dot(rough(now_.mean));
    if (sum > 0) smoothness_ = std::clamp(std::max(1.0, free_values_ - 6) / sum, 1.0, 1e9);
  }

  void set_kick() {
    if (!(sums_.shares > 0)) throw InputError("the tracks are too short or too dense for the flow");
    now_.kick = std::max(1e-6, sums_.squares / sums_.shares);
    now_.random_kick = std::max(0.0, (sums_.squares - sums_.gusts) / sums_.shares);
  }

  void find_covariance() {
    const SelectedInverse inverse(factor_);
    covariance_.block.assign(static_cast<std::size_t>(nodes_.size()) * 9, {0, 0, 0});
    for (int n = 0; n < nodes_.size(); ++n) {
      for (int o = 0; o < 9; ++o) {
        const int m = nodes_.beside(n, o % 3 - 1, o / 3 - 1);
        if (m < 0) continue;
        covariance_.block[static_cast<std::size_t>(n * 9 + o)] = {
            inverse(2 * n, 2 * m), inverse(2 * n, 2 * m + 1), inverse(2 * n + 1, 2 * m + 1)};
      }
    }
  }

  const BallPhysics& ball_;
  NodeGrid nodes_;
  SmoothFit fit_;
  Matrix roughness_;
  Eigen::MatrixXd splines_;
  FlowUnknowns now_;
  FlowSums sums_{0};
  GustPosterior gusts_;
  Eigen::MatrixXd carried_;  // answer of the mean flow to the spline coefficients
  MeanCovariance covariance_;
  SparseFactor factor_;
  double start_ = 0, smoothness_ = kFirstSmoothness, free_values_ = 0;
  std::int64_t balances_ = 0;
  bool analysed_ = false;
};

// What moves the balls besides the mean flow.
NoiseBudget noise_budget(const Solver& solver, std::span<const Recording> recordings,
                         const BallPhysics& ball, const FlowEstimate& estimate) {
  NoiseBudget out;
  const Eigen::VectorXd& log_s2 = solver.now().log_s2;
  // The mean deviation, and how it answers to log s^2 at each node.
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(log_s2.size());
  const double cells = estimate.measured();
  for (int n = 0; n < solver.nodes().size(); ++n) {
    const FlowCell& cell = estimate.cell[static_cast<std::size_t>(solver.nodes().cell(n))];
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

FlowCell cell_of(const Solver& solver, int node, const BallPhysics& ball) {
  FlowCell cell;
  const FlowUnknowns& now = solver.now();
  const double sigma = std::sqrt(ball.draws * std::exp(now.log_s2[node]));
  const double error = sigma / 2 * std::sqrt(solver.log_variance(node));
  const auto variance = solver.mean_variance(node);
  cell.flow = {now.mean[2 * node], now.mean[2 * node + 1], sigma, sigma};
  cell.error = {std::sqrt(variance[0]), std::sqrt(variance[1]), error, error};
  return cell;
}

}  // namespace

FlowEstimate estimate_smooth(std::span<const Recording> recordings, const BallPhysics& ball,
                             const FlowOptions& options) {
  FlowEstimate out = empty_estimate(recordings, ball, options, "smooth");
  const Balances all = all_balances(recordings, ball, out);
  Solver solver(all.sets, ball, {out.cells, out.extent});
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
  return out;
}

}  // namespace lilytank
