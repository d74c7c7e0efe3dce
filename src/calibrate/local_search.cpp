// Designs of simulations that move to the answer and shrink about it.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "calibrate/stages.hpp"
#include "lilytank/random.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kFirstSpread = 0.08;  // deviation of the first design, as a share of the ranges
constexpr double kNoiseSpread = 0.08;  // of the camera's noise, on its log scale
constexpr double kLastSpread = 2;      // of the last design, in standard errors
constexpr double kSettled = 1.5;  // deviations of the design that the answer may be off its centre
constexpr std::uint64_t kRoundSeed = 1000;

// Points about a centre: normal, in pairs opposite each other, mirrored at the bounds.
Matrix scattered(const Vector& centre, const Matrix& spread, int count, const FitBounds& bounds,
                 std::uint64_t seed) {
  const Eigen::Index p = centre.size();
  Matrix points(count, p);
  for (int i = 0; i < count; ++i) {
    Vector z(p);
    for (Eigen::Index k = 0; k < p; ++k) {
      z(k) = normal_pair({seed, Stream::calibrate, i / 2, static_cast<std::uint32_t>(k), 2})[0];
    }
    // Far points would bend a quadratic, and tell little of the middle.
    const double far = z.norm() / (1.5 * std::sqrt(static_cast<double>(p)));
    if (far > 1) z /= far;
    Vector at = centre + (i % 2 == 0 ? 1 : -1) * (spread * z);
    for (Eigen::Index k = 0; k < p; ++k) {
      if (at(k) < bounds.low(k)) at(k) = 2 * bounds.low(k) - at(k);
      if (at(k) > bounds.high(k)) at(k) = 2 * bounds.high(k) - at(k);
      at(k) = std::clamp(at(k), bounds.low(k), bounds.high(k));
    }
    points.row(i) = at;
  }
  return points;
}

// Rows of worlds that diverged are left out.
Design design_of(const Matrix& points, const std::vector<std::vector<double>>& rows) {
  std::vector<Eigen::Index> whole;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].empty()) whole.push_back(static_cast<Eigen::Index>(i));
  }
  if (2 * whole.size() < rows.size()) {
    throw InputError("more than half of the simulations about the search's answer diverged");
  }
  Design out;
  const auto n = static_cast<Eigen::Index>(whole.size());
  const auto& first = rows[static_cast<std::size_t>(whole.front())];
  out.points.resize(n, points.cols());
  out.numbers.resize(n, static_cast<Eigen::Index>(first.size()));
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index from = whole[static_cast<std::size_t>(i)];
    out.points.row(i) = points.row(from);
    const auto& row = rows[static_cast<std::size_t>(from)];
    out.numbers.row(i) = Eigen::Map<const Vector>(row.data(), out.numbers.cols());
  }
  return out;
}

// The next design's spread: so many standard errors, along no axis more than the first one's.
Matrix spread_of(const Matrix& covariance, const Vector& most) {
  Matrix c = covariance;
  for (Eigen::Index k = 0; k < c.rows(); ++k) c(k, k) += 1e-8 * most(k) * most(k);
  Matrix root = kLastSpread * Matrix(c.llt().matrixL());
  for (Eigen::Index k = 0; k < c.rows(); ++k) {
    const double size = root.row(k).norm();
    if (size > most(k)) root.row(k) *= most(k) / size;
  }
  return root;
}

}  // namespace

LocalAnswer find_locally(Stages& stages, const std::vector<double>& from, const FlowMaps& maps,
                         const Vector& observed) {
  const CalibrationSetup& setup = stages.setup();
  const CalibrationOptions& o = setup.options;
  const Misfit kind =
      o.objective == CalibrationObjective::msd ? Misfit::absolute : Misfit::covariance;
  const FitBounds bounds = stages.bounds();
  Vector centre = stages.to_scale(from);
  Vector most = kFirstSpread * (bounds.high - bounds.low);
  for (std::size_t i = setup.told(); i < setup.parameters.size(); ++i) {
    most(static_cast<Eigen::Index>(i)) = kNoiseSpread;
  }
  Matrix spread = most.asDiagonal();
  std::optional<LocalAnswer> answer;
  bool last = false;
  for (int round = 1; round <= o.most_rounds; ++round) {
    const std::uint64_t seed = derived_seed(o.seed, kRoundSeed + static_cast<std::uint64_t>(round));
    const Matrix points = scattered(centre, spread, last ? o.last_round : o.round, bounds, seed);
    const std::string stage = "local model " + std::to_string(round);
    LocalModel model(design_of(points, stages.simulate(stage, points, seed, maps)), kind);
    FitBounds near = bounds;
    near.reach = 2.5;
    const LocalFit fit = model.fit(observed, near);
    const Vector moved = spread.triangularView<Eigen::Lower>().solve(fit.point - centre);
    const bool settled = moved.norm() < kSettled && !fit.at_reach;
    answer.emplace(LocalAnswer{std::move(model), fit, round, settled && last});
    if (answer->settled) break;
    centre = fit.point;
    if (!fit.at_reach) spread = spread_of(answer->model.parameter_covariance(fit.point), most);
    last = !fit.at_reach;
  }
  return std::move(*answer);
}

}  // namespace lilytank
