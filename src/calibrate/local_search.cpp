// Designs of simulations that move to the estimate and shrink about it.
#include <algorithm>
#include <cmath>

#include "calibrate/cross_fit.hpp"
#include "calibrate/design.hpp"
#include "calibrate/stages.hpp"
#include "lilytank/random.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kFirstSpread = 0.04;  // deviation of the first design, as a share of the ranges
constexpr double kNoiseSpread = 0.08;  // of the camera's noise, on its log scale
constexpr double kRoughSpread = 3, kLastSpread = 2.5;  // of designs, in standard errors
constexpr double kNarrowest =
    0.4;  // of whole experiments' first design, as a share of pieces' last
constexpr double kSettledWithin =
    2;  // deviations of the design that the answer may be off its centre
constexpr double kSettledErrors = 1;  // ... or its standard errors: bounds may narrow designs
constexpr double kFarOff = 2;         // deviations beyond which the next design is stretched
constexpr double kWidest = 2;         // most of both, in deviations of the first design
constexpr double kWidestLast = 3;     // the same of whole experiments
// The same for CalibrationObjective::prediction, by the scale of a parameter: statistics are nearly
// linear in dampings, but not in large factors.
constexpr double kWidestLinear = 6, kWidestFactor = 1.5;
constexpr double kShrink = 0.3;   // least width of the next such design, in widths of this one
constexpr double kTooWide = 2.5;  // widths, over the errors', beyond which such a design shrinks
constexpr double kLeastAnswerSlope = 0.25;  // of an answer in the truth
constexpr double kResolved = 1.5;           // times a design that is wide enough would be wider
constexpr double kNear = 1.6;      // farthest points that count, over the root of their dimension
constexpr double kRoundReach = 2;  // deviations of the design that a round may go
constexpr std::uint64_t kRoundSeed = 1000;

// All simulations so far, without diverged worlds.
class Simulated {
 public:
  void add(const Matrix& points, const std::vector<std::vector<double>>& rows) {
    Design more = design_of(points, rows);
    all_ = all_ ? joined(*all_, more) : std::move(more);
  }
  // Simulations near a centre, of any round.
  Design near(const Vector& centre, const Matrix& spread) const {
    std::vector<Eigen::Index> chosen;
    for (Eigen::Index i = 0; i < all_->points.rows(); ++i) {
      const Vector z = solve_lower(spread, all_->points.row(i).transpose() - centre);
      if (z.norm() < kNear * std::sqrt(static_cast<double>(z.size()))) chosen.push_back(i);
    }
    return {all_->points(chosen, Eigen::all), all_->numbers(chosen, Eigen::all)};
  }

 private:
  std::optional<Design> all_;
};

struct Phase {
  std::string name;
  Stages::Of of;
  int round, enough;  ///< simulations of a round, and of the last model at least
  int most_rounds;
};

// The sequence of response surfaces from the search's estimate to the last one.
class Way {
 public:
  Way(Stages& stages, const FlowMaps& maps, const std::vector<double>& from)
      : stages_(stages),
        maps_(maps),
        observed_(observed()),
        bounds_(stages.bounds()),
        centre_(stages.to_scale(from)),
        predicted_(stages.setup().predicted()) {
    const CalibrationSetup& setup = stages.setup();
    kind_ = setup.options.objective == CalibrationObjective::msd ? Misfit::absolute
                                                                 : Misfit::covariance;
    most_ = kFirstSpread * (bounds_.high - bounds_.low);
    for (std::size_t i = setup.reported_count(); i < setup.parameters.size(); ++i) {
      most_(static_cast<Eigen::Index>(i)) = kNoiseSpread;
    }
    spread_ = own_ = most_.asDiagonal();
    widest_ = kWidestLast * most_;
    if (predicted_) begin_wide();
  }

  void go(const Phase& phase) {
    Simulated simulated;
    bool close = false;
    for (int round = 1; round <= phase.most_rounds; ++round) {
      // Parameters' errors are seen to first order: from afar, only where to go.
      if (predicted_ && !close) predict(), simulated = {};
      const std::string name = phase.name + std::to_string(round);
      const std::uint64_t seed = derived_seed(stages_.setup().options.seed, seed_++);
      const Matrix points = scattered(centre_, spread_, phase.round, bounds_, seed);
      simulated.add(points, stages_.simulate(name, points, seed, maps_, phase.of));
      const LocalRound last = look(simulated.near(centre_, spread_), close || fixed_, name);
      if (answer_->settled && last.simulations >= phase.enough) return;
      close = !last.at_bound;
    }
  }

  /// Whole experiments scatter less than pieces. From here on designs do not shrink further: noisy
  /// slopes give too small a covariance, and a narrower design even noisier slopes. They widen with
  /// the errors.
  void narrow() {
    own_ *= std::clamp(std::sqrt(stages_.piece_cost()), kNarrowest, 1.0);
    spread_ = least_ = own_, stretched_ = false, fixed_ = true;
  }

  const std::vector<LocalRound>& taken() const { return taken_; }
  LocalAnswer answer() {
    answer_->observed = observed_;
    return std::move(*answer_);
  }

 private:
  // Predictions show where to go even from afar: whole experiments from the first design on.
  void begin_wide() {
    least_ = kShrink * own_, fixed_ = true;
    const std::vector<FitParameter>& parameters = stages_.setup().parameters;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      widest_(i) = (parameters[k].logarithmic ? kWidestFactor : kWidestLinear) * most_(i);
    }
  }

  Vector observed() const {
    const std::vector<double> numbers = stages_.numbers(stages_.setup().training);
    return Eigen::Map<const Vector>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
  }

  void predict() {
    stages_.predict_with(stages_.from_scale(centre_));
    observed_ = observed();
  }

  // Fits one response surface and centres the next design at its estimate.
  LocalRound look(Design whole, bool close, const std::string& name) {
    const std::vector<Eigen::Index> fitted = stages_.fitted();
    const Design design = with_columns(whole, fitted);
    const Vector observed = observed_(fitted);
    const Slopes slopes = stages_.setup().slopes();
    ResponseSurface model(design, kind_, slopes);
    FitBounds near = bounds_;
    near.reach = kRoundReach;
    LocalFit fit = model.fit(observed, near);
    Matrix next = own_;
    bool within_errors = false;
    if (fixed_ && kind_ == Misfit::covariance) {
      const CrossFit by_others = cross_fit(design, observed, kind_, slopes);
      const BiasCorrectedFit corrected =
          predicted_ ? bias_corrected(design, by_others, stages_.setup().prior())
                     : bias_corrected(design, by_others, kLeastAnswerSlope);
      fit = within_reach(corrected.point, by_others.misfit);
      next = next_spread(corrected.covariance);
      const Vector step = solve_lower(lower_root(corrected.covariance), corrected.point - centre_);
      within_errors = step.norm() < kSettledErrors;
    } else if (fixed_) {
      next = next_spread(model.parameter_covariance(fit.point));
    } else if (!fit.at_bound) {
      next = rough_spread(model, fit);
    }
    const Vector moved = solve_lower(spread_, fit.point - centre_);
    const bool wide =
        (next.rowwise().norm() - kResolved * own_.rowwise().norm()).maxCoeff() < 0 &&
        (!predicted_ || (own_.rowwise().norm() - kTooWide * next.rowwise().norm()).maxCoeff() < 0);
    const bool within_design = !stretched_ && !fit.at_bound && moved.norm() < kSettledWithin;
    const bool settled = close && wide && (within_design || within_errors);
    taken_.push_back({name, static_cast<int>(design.points.rows()), moved.norm(), fit.misfit,
                      fit.at_bound, stages_.from_scale(fit.point)});
    answer_.emplace(LocalAnswer{std::move(whole),
                                std::move(model),
                                fit,
                                static_cast<int>(taken_.size()),
                                settled,
                                own_,
                                {}});
    // A settled centre stays, so that all simulations about it are used.
    if (settled) return taken_.back();
    Vector step = fit.point - centre_;
    step *= std::min(1.0, kWidest / step.cwiseAbs().cwiseQuotient(most_).maxCoeff());
    centre_ = fit.point, own_ = next;
    if (predicted_) least_ = kShrink * own_;
    // Nearly collinear parameters form a long, narrow valley; a design stretched along the last
    // step crosses it in a few rounds.
    stretched_ = fit.at_bound || moved.norm() > kFarOff;
    spread_ = own_;
    if (stretched_) spread_ = lower_root(own_ * own_.transpose() + step * step.transpose());
    return taken_.back();
  }

  // The step towards a point, cut at the bound of a round.
  LocalFit within_reach(const Vector& point, double misfit) const {
    const Vector step = solve_lower(spread_, point - centre_);
    const double far = step.cwiseAbs().maxCoeff() / kRoundReach;
    const Vector at = centre_ + spread_ * step / std::max(1.0, far);
    return {at.cwiseMax(bounds_.low).cwiseMin(bounds_.high), misfit, far > 1};
  }

  // Where the fit is poor, errors exceed their covariance.
  Matrix rough_spread(const ResponseSurface& model, const LocalFit& fit) const {
    const auto freedom = static_cast<double>(observed_.size() - centre_.size());
    const double unexplained =
        kind_ == Misfit::covariance ? std::max(1.0, fit.misfit / freedom) : 1;
    return spread_of(unexplained * model.parameter_covariance(fit.point), kRoughSpread, most_);
  }

  // In proportion to the errors, never narrower than the first design of whole experiments.
  Matrix next_spread(const Matrix& errors) const {
    const Matrix wide = spread_of(errors, kLastSpread, widest_);
    return lower_root(least_ * least_.transpose() + wide * wide.transpose());
  }

  Stages& stages_;
  const FlowMaps& maps_;
  Vector observed_;
  FitBounds bounds_;
  Vector centre_, most_, widest_;  ///< of designs, of whole experiments'
  Matrix own_, spread_;            ///< of the points by themselves, and stretched along the way
  Matrix least_;                   ///< of the points of whole experiments
  Misfit kind_ = Misfit::covariance;
  const bool predicted_;
  bool fixed_ = false, stretched_ = false;
  std::uint64_t seed_ = kRoundSeed;
  std::optional<LocalAnswer> answer_;
  std::vector<LocalRound> taken_;
};

}  // namespace

LocalAnswer find_locally(Stages& stages, const std::vector<double>& from, const FlowMaps& maps,
                         CalibrationResult& out) {
  const CalibrationSetup& setup = stages.setup();
  Way way(stages, maps, from);
  if (!setup.predicted()) {
    // Pieces are cheap and scatter widely: they find the centre of the first design of whole
    // experiments.
    way.go({"rough model ", Stages::Of::pieces, setup.options.last_round, setup.options.last_round,
            setup.options.most_rounds});
    way.narrow();
  }
  way.go({"local model ", Stages::Of::experiments, setup.options.round, setup.options.last_round,
          setup.options.most_rounds});
  out.rounds_taken = way.taken();
  return way.answer();
}

}  // namespace lilytank
