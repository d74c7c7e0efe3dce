#include "flow/smooth_solver.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "lilytank/random.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

constexpr double kGuess = 0.15;           // m/s, prior standard deviation of gusts
constexpr double kFirstSmoothness = 5e3;  // s^2/m^2, weight of squared second differences
constexpr std::int64_t kSketch = 60000;   // balances of the first rounds
constexpr int kFirstRounds = 5, kRounds = 7;
constexpr double kOutlier = 20;     // variances; a fair difference exceeds this once in 22,000
constexpr double kSettled = 3e-4;   // m/s, change of the mean flow
constexpr double kLongestStep = 1;  // of log s^2 in a round
// Subspace iteration: vectors beside those that are wanted, and passes. Of a map from 12 min of
// balls the components then hold 99.8 % of the variance that the best 256 hold.
constexpr int kBeside = 32, kPasses = 4;

}  // namespace

SmoothSolver::SmoothSolver(std::span<const BalanceSet> sets, const BallPhysics& ball,
                           const FlowGrid& grid)
    : nodes_(grid, ball.tank_radius),
      fit_(sets, ball, grid, nodes_),
      roughness_(nodes_.roughness()),
      start_(std::log(kGuess * kGuess / ball.draws)),
      smoothness_(kFirstSmoothness) {
  const Eigen::MatrixXd plane = nodes_.splines(ball.tank_radius / 3);
  const Eigen::MatrixXd radial = nodes_.radial_splines(ball.tank_radius / 4);
  plane_ = plane.cols();
  splines_.resize(nodes_.size(), plane_ + radial.cols());
  splines_ << plane, radial;
  now_.mean = Eigen::VectorXd::Zero(2 * nodes_.size());
  now_.log_s2 = Eigen::VectorXd::Constant(nodes_.size(), start_);
  gusts_.mean = Eigen::VectorXd::Zero(splines_.cols());
  for (const BalanceSet& set : sets) balances_ += static_cast<std::int64_t>(set.balances.size());
}

// First on a part of the balances, where there are many: that settles nearly everything.
void SmoothSolver::solve(double kick) {
  now_.kick = now_.random_kick = kick;
  const int stride = static_cast<int>(std::max<std::int64_t>(1, balances_ / kSketch));
  for (int round = 0; round < kFirstRounds; ++round) {
    if (round >= 2) now_.outlier = kOutlier;
    sums_ = fit_.sum(now_, stride, nullptr);
    step_mean();
    set_kick();
  }
  settle(stride);
  if (stride > 1) settle(1);
  find_covariance();
  sums_ = fit_.sum(now_, 1, &covariance_);
}

std::array<double, 2> SmoothSolver::mean_variance(int node) const {
  const auto& own = covariance_.block[node * 9 + 4];
  const Eigen::RowVectorXd x = carried_.row(2 * node), y = carried_.row(2 * node + 1);
  return {own[0] + x * gusts_.covariance * x.transpose(),
          own[2] + y * gusts_.covariance * y.transpose()};
}
double SmoothSolver::log_variance(int node) const {
  const Eigen::RowVectorXd f = splines_.row(node);
  return f * gusts_.covariance * f.transpose();
}
double SmoothSolver::log_variance(const Eigen::VectorXd& weight) const {
  const Eigen::VectorXd f = splines_.transpose() * weight;
  return f.dot(gusts_.covariance * f);
}

// The gusts' coefficients, the mean flow that goes with them, and what scatters about that: with
// P A P^T = L D L^T of the precision A, P^T L^-T D^-1/2 z has its inverse as covariance.
SmoothSolver::Change SmoothSolver::draw(int run) const {
  const auto normals = [&](Eigen::Index n, std::uint32_t use) {
    Eigen::VectorXd z(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      z[i] = normal_pair({0, Stream::bootstrap, run, static_cast<std::uint32_t>(i), use})[0];
    }
    return z;
  };
  const Eigen::Index gusts = gusts_.mean.size(), means = now_.mean.size();
  Eigen::MatrixXd covariance = gusts_.covariance;
  covariance.diagonal().array() += 1e-10 * covariance.trace() / static_cast<double>(gusts);
  const Eigen::MatrixXd root = lower_root(covariance);
  const Eigen::VectorXd c = root * normals(gusts, 1);
  const Eigen::VectorXd scaled = normals(means, 2).cwiseQuotient(factor_.vectorD().cwiseSqrt());
  const Eigen::VectorXd ordered = factor_.matrixU().solve(scaled);
  return {factor_.permutationPinv() * ordered - carried_ * c, splines_ * c};
}

Eigen::MatrixXd SmoothSolver::covariance_times(const Eigen::MatrixXd& of) const {
  return factor_.solve(of) + carried_ * (gusts_.covariance * (carried_.transpose() * of));
}

// By subspace iteration from a random start [Halko, Martinsson and Tropp, SIAM Review 53, 2011].
Eigen::MatrixXd SmoothSolver::components(int count, double radius) const {
  const Eigen::Index means = now_.mean.size();
  Eigen::VectorXd within = Eigen::VectorXd::Zero(means);
  for (int n = 0; n < nodes_.size(); ++n) {
    if (std::hypot(nodes_.x(n), nodes_.y(n)) <= radius) within.segment<2>(2 * n).setOnes();
  }
  const auto places = static_cast<Eigen::Index>(within.sum());
  const Eigen::Index wanted = std::min<Eigen::Index>(count, places),
                     width = std::min<Eigen::Index>(wanted + kBeside, places);
  Eigen::MatrixXd basis(means, width);
  for (Eigen::Index k = 0; k < width; ++k) {
    for (Eigen::Index i = 0; i < means; ++i) {
      basis(i, k) = within(i) * normal_pair({0, Stream::bootstrap, static_cast<std::int64_t>(k),
                                             static_cast<std::uint32_t>(i), 3})[0];
    }
  }
  for (int pass = 0; pass < kPasses; ++pass) {
    basis = within.asDiagonal() * covariance_times(basis);
    const Eigen::HouseholderQR<Eigen::MatrixXd> factors(basis);
    basis = factors.householderQ() * Eigen::MatrixXd::Identity(means, width);
  }
  const Eigen::MatrixXd image = covariance_times(basis);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(basis.transpose() * image);
  const Eigen::VectorXd variance = solved.eigenvalues().tail(wanted).reverse();
  const Eigen::MatrixXd leading = solved.eigenvectors().rightCols(wanted).rowwise().reverse();
  return image * leading * variance.cwiseSqrt().cwiseInverse().asDiagonal();
}

void SmoothSolver::settle(int stride) {
  for (int round = 0; round < kRounds; ++round) {
    if (round == 0) find_covariance();
    sums_ = fit_.sum(now_, stride, &covariance_);
    const double change = step_both();
    set_kick();
    if (change < kSettled) break;
  }
}

SmoothSolver::Matrix SmoothSolver::assemble() const {
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

Eigen::VectorXd SmoothSolver::rough(const Eigen::VectorXd& mean) const {
  const Eigen::Map<const Eigen::Matrix<double, 2, Eigen::Dynamic>> pairs(mean.data(), 2,
                                                                         nodes_.size());
  const Eigen::Matrix<double, 2, Eigen::Dynamic> out = pairs * roughness_;
  return Eigen::Map<const Eigen::VectorXd>(out.data(), mean.size());
}

void SmoothSolver::factor() {
  const Matrix all = assemble();
  if (!analysed_) factor_.analyzePattern(all);
  analysed_ = true;
  factor_.factorize(all);
  if (factor_.info() != Eigen::Success) {
    throw InputError("the tracks do not determine the flow: too few momentum balances");
  }
}

void SmoothSolver::step_mean() {
  factor();
  const Eigen::VectorXd step = factor_.solve(mean_right());
  now_.mean += step;
  set_smoothness();
}

// Mean flow and gusts together: the mean is eliminated, the gusts solved for, the mean follows.
double SmoothSolver::step_both() {
  factor();
  const Eigen::VectorXd step = factor_.solve(mean_right());
  Matrix own(nodes_.size(), nodes_.size());
  const Eigen::MatrixXd coupling = couple(own);
  carried_ = factor_.solve(coupling);
  const Eigen::MatrixXd information =
      splines_.transpose() * (own * splines_) - coupling.transpose() * carried_;
  const Eigen::VectorXd slope = splines_.transpose() * sums_.log_s2 - coupling.transpose() * step;
  const GustPosterior next = gust_posterior(information, information * gusts_.mean + slope, plane_);
  Eigen::VectorXd change = next.mean - gusts_.mean;
  // Far from the solution a step may overshoot.
  const double longest = (splines_ * change).cwiseAbs().maxCoeff();
  if (longest > kLongestStep) change *= kLongestStep / longest;
  gusts_.mean += change;
  gusts_.covariance = next.covariance;
  now_.log_s2 = (start_ + (splines_ * gusts_.mean).array()).matrix();
  const Eigen::VectorXd moved = step - carried_ * change;
  now_.mean += moved;
  set_smoothness();
  return std::sqrt(moved.squaredNorm() / static_cast<double>(moved.size()));
}

// Second derivatives between mean flow and spline coefficients; `own`: between log s^2 at nodes.
Eigen::MatrixXd SmoothSolver::couple(Matrix& own) const {
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
void SmoothSolver::set_smoothness() {
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

void SmoothSolver::set_kick() {
  if (!(sums_.shares > 0)) throw InputError("the tracks are too short or too dense for the flow");
  now_.kick = std::max(1e-6, sums_.squares / sums_.shares);
  now_.random_kick = std::max(0.0, (sums_.squares - sums_.gusts) / sums_.shares);
}

void SmoothSolver::find_covariance() {
  const SelectedInverse inverse(factor_);
  covariance_.block.assign(static_cast<std::size_t>(nodes_.size()) * 9, {0, 0, 0});
  for (int n = 0; n < nodes_.size(); ++n) {
    for (int o = 0; o < 9; ++o) {
      const int m = nodes_.beside(n, o % 3 - 1, o / 3 - 1);
      if (m < 0) continue;
      covariance_.block[n * 9 + o] = {inverse(2 * n, 2 * m), inverse(2 * n, 2 * m + 1),
                                      inverse(2 * n + 1, 2 * m + 1)};
    }
  }
}

}  // namespace lilytank
