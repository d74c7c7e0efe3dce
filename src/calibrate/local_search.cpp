// Designs of simulations that move to the answer and shrink about it.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "calibrate/stages.hpp"
#include "lilytank/random.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kFirstSpread = 0.04;  // deviation of the first design, as a share of the ranges
constexpr double kNoiseSpread = 0.08;  // of the camera's noise, on its log scale
constexpr double kLastSpread = 2;      // of the last design, in standard errors
constexpr double kSettled = 1.5;  // deviations of the design that the answer may be off its centre
constexpr double kFar = 1.5, kNear = 1.6;  // farthest points, over the root of their dimension
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
    const double far = z.norm() / (kFar * std::sqrt(static_cast<double>(p)));
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

// All simulations so far; those of worlds that diverged are left out.
class Simulated {
 public:
  void add(const Matrix& points, std::vector<std::vector<double>> rows) {
    std::size_t lost = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i].empty()) {
        ++lost;
      } else {
        points_.push_back(points.row(static_cast<Eigen::Index>(i)));
        rows_.push_back(std::move(rows[i]));
      }
    }
    if (2 * lost > rows.size()) {
      throw InputError("more than half of the simulations about the search's answer diverged");
    }
  }
  // Those about a centre, of this round or an earlier one.
  Design near(const Vector& centre, const Matrix& spread) const {
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vector z = spread.triangularView<Eigen::Lower>().solve(points_[i] - centre);
      if (z.norm() < kNear * std::sqrt(static_cast<double>(z.size()))) chosen.push_back(i);
    }
    Design out;
    const auto n = static_cast<Eigen::Index>(chosen.size());
    out.points.resize(n, centre.size());
    out.numbers.resize(n, static_cast<Eigen::Index>(rows_.front().size()));
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::size_t from = chosen[static_cast<std::size_t>(i)];
      out.points.row(i) = points_[from];
      out.numbers.row(i) = Eigen::Map<const Vector>(rows_[from].data(), out.numbers.cols());
    }
    return out;
  }

 private:
  std::vector<Vector> points_;
  std::vector<std::vector<double>> rows_;
};

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
                         const Vector& observed, CalibrationResult& out) {
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
  Simulated simulated;
  bool narrow = false;
  for (int round = 1; round <= o.most_rounds; ++round) {
    const std::uint64_t seed = derived_seed(o.seed, kRoundSeed + static_cast<std::uint64_t>(round));
    const Matrix points = scattered(centre, spread, o.round, bounds, seed);
    simulated.add(points,
                  stages.simulate("local model " + std::to_string(round), points, seed, maps));
    const Design design = simulated.near(centre, spread);
    LocalModel model(design, kind);
    FitBounds near = bounds;
    near.reach = 2;
    const LocalFit fit = model.fit(observed, near);
    const Vector moved = spread.triangularView<Eigen::Lower>().solve(fit.point - centre);
    const bool settled = narrow && !fit.at_reach && moved.norm() < kSettled;
    out.rounds_taken.push_back({static_cast<int>(design.points.rows()), moved.norm(), fit.misfit,
                                fit.at_reach, stages.from_scale(fit.point)});
    if (std::getenv("CALDEBUG")) {
      fprintf(stderr, "round %d n %d moved %.2f misfit %.1f reach %d:", round,
              int(design.points.rows()), moved.norm(), fit.misfit, fit.at_reach);
      for (double v : stages.from_scale(fit.point)) fprintf(stderr, " %.4g", v);
      fprintf(stderr, " | spread");
      for (Eigen::Index k = 0; k < spread.rows(); ++k)
        fprintf(stderr, " %.3g", spread.row(k).norm());
      fprintf(stderr, "\n");
    }
    answer.emplace(LocalAnswer{std::move(model), fit, round, settled});
    if (settled && design.points.rows() >= o.last_round) break;
    // A centre that is good enough stays, so that all simulations about it count.
    if (!settled) centre = fit.point;
    if (!settled && !fit.at_reach) {
      // Where the numbers are not explained yet, errors are larger than their covariance says.
      const auto freedom = static_cast<double>(observed.size() - centre.size());
      const double unexplained =
          kind == Misfit::covariance ? std::max(1.0, fit.misfit / freedom) : 1;
      spread = spread_of(unexplained * answer->model.parameter_covariance(fit.point), most);
    }
    narrow = !fit.at_reach;
  }
  return std::move(*answer);
}

}  // namespace lilytank
