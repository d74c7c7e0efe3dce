// Of all parameters that the data do not distinguish, those with the most similar MSD.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "calibrate/design.hpp"
#include "calibrate/stages.hpp"
#include "lilytank/random.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::uint64_t kNearestSeed = 2500;
constexpr double kMostSpread = 0.1;    // deviation of a round's points, as a share of the ranges
constexpr double kNearestReach = 2;    // deviations of the points that a round may go
constexpr double kNearestSettled = 1;  // ... that its answer may be off their centre
constexpr int kMostRounds = 6;
// Points of a round at least: three for each coefficient of a quadratic of five parameters.
constexpr int kPerParameter = 12;
constexpr int kEvaluations = 4000;  // of a response surface

// The search for them over the reported parameters; nuisances are fixed.
class Nearest {
 public:
  Nearest(Stages& stages, const Vector& middle, const Matrix& covariance)
      : stages_(stages),
        reported_(static_cast<Eigen::Index>(stages.setup().reported_count())),
        middle_(middle),
        to_unit_(lower_inverse(lower_root(covariance.topLeftCorner(reported_, reported_)))) {
    const FitBounds all = stages.bounds();
    bounds_.low = all.low.head(reported_), bounds_.high = all.high.head(reported_);
    const std::vector<double> curve = stages.setup().displacements(stages.setup().training);
    observed_ = Eigen::Map<const Vector>(curve.data(), static_cast<Eigen::Index>(curve.size()));
    spread_ = spread_of(covariance.topLeftCorner(reported_, reported_), 1,
                        kMostSpread * (bounds_.high - bounds_.low));
  }

  // `centre`: of earlier simulations.
  NearestPoint from(const Vector& centre) {
    NearestPoint out;
    Vector reported = centre.head(reported_);
    while (!out.settled && out.rounds < kMostRounds) {
      const Vector next = step(reported, ++out.rounds);
      out.settled = solve_lower(spread_, next - reported).cwiseAbs().maxCoeff() < kNearestSettled;
      reported = next;
    }
    out.point = with(reported);
    return out;
  }

 private:
  Vector step(const Vector& centre, int round) {
    const std::uint64_t seed =
        derived_seed(stages_.setup().options.seed, kNearestSeed + static_cast<unsigned>(round));
    const int count =
        std::max(stages_.setup().options.round, static_cast<int>(kPerParameter * reported_));
    const Matrix points = scattered(centre, spread_, count, bounds_, seed);
    Matrix whole(count, middle_.size());
    for (int i = 0; i < count; ++i) whole.row(i) = with(points.row(i));
    const std::string stage = "displacements " + std::to_string(round);
    const ResponseSurface model(design_of(points, stages_.displacements(stage, whole, seed)),
                                Misfit::absolute);
    return least(model, centre, seed);
  }

  Vector with(const Vector& reported) const {
    Vector out = middle_;
    out.head(reported_) = reported;
    return out;
  }

  // Deviance of parameters: normal for the posterior from all statistics, Laplace for the sum of
  // the MSD's absolute differences; `usual` is its mean among equal experiments.
  double deviance(const ResponseSurface& model, double usual, const Vector& point) const {
    const double by_numbers = (to_unit_ * (point - middle_.head(reported_))).squaredNorm();
    return by_numbers + 2 * model.misfit(observed_, point) / usual;
  }

  Vector least(const ResponseSurface& model, const Vector& centre, std::uint64_t seed) {
    const double usual = std::sqrt(2 / std::numbers::pi) *  // of a normal deviate's size
                         model.covariance().diagonal().cwiseSqrt().sum();
    SearchSpace space;
    for (Eigen::Index k = 0; k < reported_; ++k) {
      space.push_back({"z" + std::to_string(k), -kNearestReach, kNearestReach});
    }
    const auto point = [&](const std::vector<double>& z) -> Vector {
      const Vector at = centre + spread_ * Eigen::Map<const Vector>(z.data(), reported_);
      return at.cwiseMax(bounds_.low).cwiseMin(bounds_.high);
    };
    CmaEsOptions options;
    options.budget = kEvaluations, options.handle_uncertainty = false;
    options.final_evaluations = 0;
    const auto search = make_cma_es(space, options, seed);
    for (auto trials = search->ask(); !trials.empty(); trials = search->ask()) {
      std::vector<double> values;
      for (const Trial& t : trials) values.push_back(deviance(model, usual, point(t.point)));
      search->tell(values);
    }
    return point(search->best().point);
  }

  Stages& stages_;
  Eigen::Index reported_;
  Vector middle_;
  Matrix to_unit_, spread_;
  FitBounds bounds_;
  Vector observed_;
};

}  // namespace

NearestPoint nearest_displacements(Stages& stages, const Vector& middle, const Matrix& covariance,
                                   const Vector& centre) {
  return Nearest(stages, middle, covariance).from(centre);
}

}  // namespace lilytank
