#include "search/cma_distribution.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "lilytank/math.hpp"

namespace lilytank {
namespace {

constexpr double kMostDeviation = 1;      // of an axis, lengths of the unit box
constexpr double kLeastDeviation = 1e-9;  // of every axis, below which samples are one point
constexpr double kMostCondition = 1e14;   // of the covariance

using Vector = Eigen::VectorXd;

Eigen::Map<const Vector> vector_of(std::span<const double> v) {
  return {v.data(), static_cast<Eigen::Index>(v.size())};
}

double square(double x) {
  return x * x;
}

struct WeightSums {
  double positive = 0, negative = 0, mu_eff = 0, mu_eff_negative = 0;
};

WeightSums sums_of(const std::vector<double>& raw, int mu) {
  WeightSums out;
  double squares = 0, negative_squares = 0, better = 0, worse = 0;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    (raw[i] >= 0 ? out.positive : out.negative) += std::fabs(raw[i]);
    const bool good = static_cast<int>(i) < mu;
    (good ? better : worse) += raw[i];
    (good ? squares : negative_squares) += raw[i] * raw[i];
  }
  out.mu_eff = better * better / squares;
  out.mu_eff_negative = worse * worse / negative_squares;
  return out;
}

}  // namespace

CmaConstants::CmaConstants(int axes, int samples) : n(axes), lambda(samples), mu(samples / 2) {
  for (int i = 1; i <= lambda; ++i) {
    weight.push_back(log_portable((lambda + 1) / 2.0) - log_portable(i));
  }
  const WeightSums sums = sums_of(weight, mu);
  mu_eff = sums.mu_eff;
  const double size = n;
  c_c = (4 + mu_eff / size) / (size + 4 + 2 * mu_eff / size);
  c_sigma = (mu_eff + 2) / (size + mu_eff + 5);
  c_1 = 2 / (square(size + 1.3) + mu_eff);
  c_mu = std::min(1 - c_1, 2 * (0.25 + mu_eff - 2 + 1 / mu_eff) / (square(size + 2) + mu_eff));
  d_sigma = 1 + 2 * std::max(0.0, std::sqrt((mu_eff - 1) / (size + 1)) - 1) + c_sigma;
  chi = std::sqrt(size) * (1 - 1 / (4 * size) + 1 / (21 * size * size));
  const double least = std::min({1 + c_1 / c_mu, 1 + 2 * sums.mu_eff_negative / (mu_eff + 2),
                                 (1 - c_1 - c_mu) / (size * c_mu)});
  for (double& w : weight) w *= w >= 0 ? 1 / sums.positive : least / sums.negative;
}

CmaDistribution::CmaDistribution(const std::vector<double>& mean, double sigma, int lambda)
    : constants_(static_cast<int>(mean.size()), lambda),
      mean_(vector_of(mean)),
      path_sigma_(Vector::Zero(mean_.size())),
      path_c_(path_sigma_),
      covariance_(Eigen::MatrixXd::Identity(mean_.size(), mean_.size())),
      sigma_(sigma) {
  decompose();
}

void CmaDistribution::decompose() {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance_);
  scale_ = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  root_ = solver.eigenvectors() * scale_.asDiagonal() * solver.eigenvectors().transpose();
}

std::vector<double> CmaDistribution::sample(std::span<const double> z) const {
  const Vector x = mean_ + sigma_ * (root_ * vector_of(z));
  return {x.begin(), x.end()};
}

void CmaDistribution::update(const std::vector<std::vector<double>>& ranked) {
  const CmaConstants& c = constants_;
  Vector z = Vector::Zero(mean_.size());  // the best samples' mean, as normals
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.mu); ++i) {
    z += c.weight[i] * vector_of(ranked[i]);
  }
  const Vector step = root_ * z;
  decay_ *= square(1 - c.c_sigma);
  path_sigma_ =
      (1 - c.c_sigma) * path_sigma_ + std::sqrt(c.c_sigma * (2 - c.c_sigma) * c.mu_eff) * z;
  const double pace = path_sigma_.norm();
  const bool calm = pace < std::sqrt(1 - decay_) * (1.4 + 2.0 / (c.n + 1)) * c.chi;
  const double h_sigma = calm ? 1 : 0;
  path_c_ = (1 - c.c_c) * path_c_ + h_sigma * std::sqrt(c.c_c * (2 - c.c_c) * c.mu_eff) * step;
  update_covariance(ranked, h_sigma);
  // The mean stays in the box, where samples beyond its sides are put on them.
  mean_ = (mean_ + sigma_ * step).cwiseMax(0).cwiseMin(1);
  decompose();
  widen(exp_portable(std::min(1.0, c.c_sigma / c.d_sigma * (pace / c.chi - 1))));
}

void CmaDistribution::update_covariance(const std::vector<std::vector<double>>& ranked,
                                        double h_sigma) {
  const CmaConstants& c = constants_;
  double sum = 0;
  for (const double w : c.weight) sum += w;
  covariance_ *= 1 + c.c_1 * (1 - h_sigma) * c.c_c * (2 - c.c_c) - c.c_1 - c.c_mu * sum;
  covariance_ += c.c_1 * path_c_ * path_c_.transpose();
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    const auto z = vector_of(ranked[i]);
    double w = c.weight[i];
    if (w < 0) w *= c.n / std::max(z.squaredNorm(), 1e-300);
    const Vector y = root_ * z;
    covariance_ += c.c_mu * w * y * y.transpose();
  }
}

void CmaDistribution::widen(double factor) {
  const double most = covariance_.diagonal().maxCoeff();
  sigma_ = std::min(sigma_ * factor, kMostDeviation / std::sqrt(most));
}

double CmaDistribution::spread() const {
  return sigma_ * std::sqrt(covariance_.trace() / constants_.n);
}

bool CmaDistribution::worn_out() const {
  const double least = scale_.minCoeff(), most = scale_.maxCoeff();
  const bool sound = std::isfinite(sigma_) && scale_.allFinite() && least > 0;
  return !sound || sigma_ * most < kLeastDeviation || square(most / least) > kMostCondition;
}

void CmaDistribution::save(StateWriter& out) const {
  out.whole("lambda", constants_.lambda);
  const auto numbers = [&](const char* key, const auto& values) {
    out.numbers(key, {values.data(), static_cast<std::size_t>(values.size())});
  };
  numbers("mean", mean_);
  numbers("path_sigma", path_sigma_);
  numbers("path_c", path_c_);
  numbers("covariance", covariance_);
  const double step[] = {sigma_, decay_};
  out.numbers("sigma", step);
}

CmaDistribution::CmaDistribution(StateReader& in, int axes, int most_lambda)
    : constants_(axes, static_cast<int>(in.whole("lambda", 4, most_lambda))) {
  const auto n = static_cast<std::size_t>(axes);
  mean_ = vector_of(in.numbers("mean", n));
  path_sigma_ = vector_of(in.numbers("path_sigma", n));
  path_c_ = vector_of(in.numbers("path_c", n));
  covariance_ = vector_of(in.numbers("covariance", n * n)).reshaped(axes, axes);
  const auto step = in.numbers("sigma", 2);
  sigma_ = step[0], decay_ = step[1];
  decompose();
}

}  // namespace lilytank
