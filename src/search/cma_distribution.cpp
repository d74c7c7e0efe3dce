#include "search/cma_distribution.hpp"

#include <algorithm>
#include <cmath>

#include "lilytank/math.hpp"
#include "search/eigen.hpp"

namespace lilytank {
namespace {

constexpr double kMostDeviation = 1;      // of an axis, lengths of the unit box
constexpr double kLeastDeviation = 1e-9;  // of every axis, below which samples are one point
constexpr double kMostCondition = 1e14;   // of the covariance

double length(std::span<const double> v) {
  double squares = 0;
  for (const double x : v) squares += x * x;
  return std::sqrt(squares);
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

CmaDistribution::CmaDistribution(std::vector<double> mean, double sigma, int lambda)
    : constants_(static_cast<int>(mean.size()), lambda),
      mean_(std::move(mean)),
      path_sigma_(mean_.size(), 0.0),
      path_c_(mean_.size(), 0.0),
      covariance_(mean_.size() * mean_.size(), 0.0),
      sigma_(sigma) {
  for (std::size_t a = 0; a < mean_.size(); ++a) covariance_[a * mean_.size() + a] = 1;
  decompose();
}

void CmaDistribution::decompose() {
  symmetric_eigen(covariance_, constants_.n, scale_, basis_);
  for (double& value : scale_) value = std::sqrt(std::max(value, 0.0));
}

std::vector<double> CmaDistribution::turned(std::span<const double> v) const {
  const std::size_t n = mean_.size();
  std::vector<double> out(n, 0.0);
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t k = 0; k < n; ++k) out[a] += basis_[a * n + k] * v[k];
  }
  return out;
}

std::vector<double> CmaDistribution::stretched(std::span<const double> z) const {
  std::vector<double> scaled(z.begin(), z.end());
  for (std::size_t k = 0; k < scaled.size(); ++k) scaled[k] *= scale_[k];
  return turned(scaled);
}

std::vector<double> CmaDistribution::sample(std::span<const double> z) const {
  std::vector<double> x = stretched(z);
  for (std::size_t a = 0; a < x.size(); ++a) x[a] = mean_[a] + sigma_ * x[a];
  return x;
}

void CmaDistribution::update(const std::vector<std::vector<double>>& ranked) {
  const CmaConstants& c = constants_;
  const std::size_t n = mean_.size();
  std::vector<double> z(n, 0.0);  // the best samples' mean, as normals
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.mu); ++i) {
    for (std::size_t a = 0; a < n; ++a) z[a] += c.weight[i] * ranked[i][a];
  }
  const std::vector<double> step = stretched(z), way = turned(z);
  decay_ *= square(1 - c.c_sigma);
  const double gain = std::sqrt(c.c_sigma * (2 - c.c_sigma) * c.mu_eff);
  for (std::size_t a = 0; a < n; ++a) {
    path_sigma_[a] = (1 - c.c_sigma) * path_sigma_[a] + gain * way[a];
  }
  const double pace = length(path_sigma_);
  const bool calm = pace < std::sqrt(1 - decay_) * (1.4 + 2 / (static_cast<double>(n) + 1)) * c.chi;
  const double h_sigma = calm ? 1 : 0;
  const double gain_c = h_sigma * std::sqrt(c.c_c * (2 - c.c_c) * c.mu_eff);
  for (std::size_t a = 0; a < n; ++a) {
    path_c_[a] = (1 - c.c_c) * path_c_[a] + gain_c * step[a];
  }
  update_covariance(ranked, h_sigma);
  for (std::size_t a = 0; a < n; ++a) {
    mean_[a] += sigma_ * step[a];
    // The mean stays in the box, where samples beyond its sides are put on them.
    mean_[a] = std::clamp(mean_[a], 0.0, 1.0);
  }
  decompose();
  widen(exp_portable(std::min(1.0, c.c_sigma / c.d_sigma * (pace / c.chi - 1))));
}

void CmaDistribution::update_covariance(const std::vector<std::vector<double>>& ranked,
                                        double h_sigma) {
  const CmaConstants& c = constants_;
  const std::size_t n = mean_.size();
  double sum = 0;
  for (const double w : c.weight) sum += w;
  const double kept = 1 + c.c_1 * (1 - h_sigma) * c.c_c * (2 - c.c_c) - c.c_1 - c.c_mu * sum;
  for (double& value : covariance_) value *= kept;
  const auto add = [&](double factor, const std::vector<double>& y) {
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        covariance_[a * n + b] += factor * y[a] * y[b];
        covariance_[b * n + a] = covariance_[a * n + b];
      }
    }
  };
  add(c.c_1, path_c_);
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    double w = c.weight[i];
    if (w < 0) w *= static_cast<double>(n) / std::max(square(length(ranked[i])), 1e-300);
    add(c.c_mu * w, stretched(ranked[i]));
  }
}

void CmaDistribution::widen(double factor) {
  sigma_ *= factor;
  double most = 0;
  for (std::size_t a = 0; a < mean_.size(); ++a) {
    most = std::max(most, covariance_[a * mean_.size() + a]);
  }
  sigma_ = std::min(sigma_, kMostDeviation / std::sqrt(most));
}

double CmaDistribution::spread() const {
  double trace = 0;
  for (std::size_t a = 0; a < mean_.size(); ++a) trace += covariance_[a * mean_.size() + a];
  return sigma_ * std::sqrt(trace / static_cast<double>(mean_.size()));
}

bool CmaDistribution::worn_out() const {
  const auto [least, most] = std::minmax_element(scale_.begin(), scale_.end());
  const bool sound = std::isfinite(sigma_) && std::isfinite(*most) && *least > 0;
  return !sound || sigma_ * *most < kLeastDeviation || square(*most / *least) > kMostCondition;
}

void CmaDistribution::save(StateWriter& out) const {
  out.whole("lambda", constants_.lambda);
  out.numbers("mean", mean_);
  out.numbers("path_sigma", path_sigma_);
  out.numbers("path_c", path_c_);
  out.numbers("covariance", covariance_);
  const double step[] = {sigma_, decay_};
  out.numbers("sigma", step);
}

CmaDistribution::CmaDistribution(StateReader& in, int axes, int most_lambda)
    : constants_(axes, static_cast<int>(in.whole("lambda", 4, most_lambda))) {
  const auto n = static_cast<std::size_t>(axes);
  mean_ = in.numbers("mean", n);
  path_sigma_ = in.numbers("path_sigma", n);
  path_c_ = in.numbers("path_c", n);
  covariance_ = in.numbers("covariance", n * n);
  const auto step = in.numbers("sigma", 2);
  sigma_ = step[0], decay_ = step[1];
  decompose();
}

}  // namespace lilytank
