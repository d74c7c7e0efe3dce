// Of all parameters that the data cannot tell apart, those that move modules most alike.
#include <algorithm>
#include <cmath>

#include "analysis/linear.hpp"
#include "calibrate/design.hpp"
#include "calibrate/stages.hpp"
#include "lilytank/random.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::uint64_t kNearestSeed = 2500;
constexpr double kMostSpread = 0.1;  // deviation of a round's points, as a share of the ranges
constexpr double kReach = 2;         // deviations of the points that a round may go
constexpr double kSettled = 1;       // ... that its answer may be off their centre
constexpr int kMostRounds = 6;
constexpr int kEvaluations = 4000;  // of a local model

// The way there, in parameters that are told; nuisances stay as they are.
class Nearest {
 public:
  Nearest(Stages& stages, const HonestAnswer& honest)
      : stages_(stages),
        emulator_(stages.setup().emulator(stages.setup().shapes, Stages::Of::experiments)),
        told_(static_cast<Eigen::Index>(stages.setup().told())),
        middle_(honest.middle),
        to_unit_(lower_inverse(lower_root(honest.covariance.topLeftCorner(told_, told_)))) {
    const FitBounds all = stages.bounds();
    bounds_.low = all.low.head(told_), bounds_.high = all.high.head(told_);
    const std::vector<double> curve = stages.setup().displacements(stages.setup().training);
    observed_ = Eigen::Map<const Vector>(curve.data(), static_cast<Eigen::Index>(curve.size()));
    spread_ = spread_of(honest.covariance.topLeftCorner(told_, told_), 1,
                        kMostSpread * (bounds_.high - bounds_.low));
  }

  // From a centre about which simulations were made before.
  Vector from(Vector centre) {
    for (int round = 1; round <= kMostRounds; ++round) {
      const Vector next = step(centre, round);
      const bool settled = solve_lower(spread_, next - centre).cwiseAbs().maxCoeff() < kSettled;
      centre = next;
      if (settled) break;
    }
    return centre;
  }

 private:
  Vector step(const Vector& centre, int round) {
    const std::uint64_t seed =
        derived_seed(stages_.setup().options.seed, kNearestSeed + static_cast<unsigned>(round));
    const int count = std::max(stages_.setup().options.round, static_cast<int>(12 * told_));
    const Matrix points = scattered(centre, spread_, count, bounds_, seed);
    const Design design = design_of(points, simulated(points, round, seed));
    const LocalModel model(design, Misfit::absolute);
    double usual = 0;
    for (Eigen::Index i = 0; i < design.points.rows(); ++i) {
      usual += model.misfit(design.numbers.row(i), design.points.row(i));
    }
    usual /= static_cast<double>(design.points.rows());
    return least(model, usual, centre, seed);
  }

  std::vector<std::vector<double>> simulated(const Matrix& points, int round, std::uint64_t seed) {
    const CalibrationSetup& setup = stages_.setup();
    const auto work = [&](int i) {
      Vector whole = middle_;
      whole.head(told_) = points.row(i);
      const auto made =
          emulator_.record(stages_.from_scale(whole), derived_seed(seed, static_cast<unsigned>(i)));
      return made ? setup.displacements(*made) : std::vector<double>{};
    };
    return stages_.rows("displacements " + std::to_string(round), static_cast<int>(points.rows()),
                        work);
  }

  // Twice the negative log likelihood of parameters: normal by what all numbers say, and of the
  // sizes of differences of the MSD, whose mean among equal experiments is `usual` [Laplace].
  double doubt(const LocalModel& model, double usual, const Vector& point) const {
    const double by_numbers = (to_unit_ * (point - middle_.head(told_))).squaredNorm();
    return by_numbers + 2 * model.misfit(observed_, point) / usual;
  }

  Vector least(const LocalModel& model, double usual, const Vector& centre, std::uint64_t seed) {
    SearchSpace space;
    for (Eigen::Index k = 0; k < told_; ++k) {
      space.push_back({"z" + std::to_string(k), -kReach, kReach});
    }
    const auto point = [&](const std::vector<double>& z) -> Vector {
      const Vector at = centre + spread_ * Eigen::Map<const Vector>(z.data(), told_);
      return at.cwiseMax(bounds_.low).cwiseMin(bounds_.high);
    };
    CmaEsOptions options;
    options.budget = kEvaluations, options.handle_uncertainty = false;
    options.final_evaluations = 0;
    const auto search = make_cma_es(space, options, seed);
    for (auto trials = search->ask(); !trials.empty(); trials = search->ask()) {
      std::vector<double> values;
      for (const Trial& t : trials) values.push_back(doubt(model, usual, point(t.point)));
      search->tell(values);
    }
    return point(search->best().point);
  }

  Stages& stages_;
  Emulator emulator_;
  Eigen::Index told_;
  Vector middle_;
  Matrix to_unit_, spread_;
  FitBounds bounds_;
  Vector observed_;
};

}  // namespace

Vector nearest_displacements(Stages& stages, const HonestAnswer& honest, const Vector& centre) {
  Vector out = honest.middle;
  const auto told = static_cast<Eigen::Index>(stages.setup().told());
  out.head(told) = Nearest(stages, honest).from(centre.head(told));
  return out;
}

}  // namespace lilytank
