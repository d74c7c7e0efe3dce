#include "finder/reference_ensemble.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "calibrate/cross_fit.hpp"
#include "calibrate/design.hpp"
#include "lilytank/emulator.hpp"
#include "lilytank/random.hpp"
#include "scores/flow_uncertainty.hpp"
#include "statistics/linear.hpp"
#include "statistics/median.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::uint64_t kNullSeed = 1, kFurtherSeed = 3, kFieldSeed = 7;
constexpr int kEnsembleFolds = 8;
constexpr double kCalibrationReach = 2.5;  // deviations of the design that a calibration may go
constexpr double kNeverVaries = 1e-6, kNoWeight = 1e30;
constexpr double kFarOff = 100;  // deviations

FitBounds within() {
  FitBounds out;
  out.reach = kCalibrationReach;
  return out;
}

// Scores less their mean at the parameters estimated from the summary, cross-fitted: each
// experiment by surfaces fitted without it, as for data.
Matrix held_out_residuals(const Design& summaries, const Design& numbers, const Prior& prior) {
  Matrix out(numbers.numbers.rows(), numbers.numbers.cols());
  for (int fold = 0; fold < kEnsembleFolds; ++fold) {
    const ResponseSurface parameters(without_fold(summaries, fold, kEnsembleFolds));
    const ResponseSurface scores(without_fold(numbers, fold, kEnsembleFolds));
    for (Eigen::Index i = fold; i < out.rows(); i += kEnsembleFolds) {
      const Vector at =
          parameters.fit(summaries.numbers.row(i).transpose(), within(), prior).fit.point;
      out.row(i) = numbers.numbers.row(i) - scores.mean(at).transpose();
    }
  }
  return out;
}

Vector to_vector(const std::vector<double>& values) {
  return Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

ReferenceEnsemble::ReferenceEnsemble(Stages& stages, const FlowMaps& maps, ScorePlan plan,
                                     const Vector& centre, const Matrix& spread,
                                     const EnsembleOptions& options)
    : stages_(stages),
      maps_(maps),
      plan_(std::move(plan)),
      options_(options),
      centre_(centre),
      spread_(spread) {
  const CalibrationSetup& setup = stages.setup();
  const Simulation without = nulls(options.nulls, kNullSeed);
  const Design all = design_of(without.points,
                               stages.rows("null experiments", {scored("nulls", without)}).front());
  const auto p = centre.size();
  summaries_ = {all.points.leftCols(p), all.numbers.leftCols(summary_numbers())};
  const Design numbers{summaries_.points,
                       all.numbers.rightCols(all.numbers.cols() - summary_numbers())};
  const Eigen::Index n = all.points.rows();
  parameters_ = std::make_unique<ResponseSurface>(summaries_);
  scores_ = std::make_unique<ResponseSurface>(numbers);
  named_ = static_cast<Eigen::Index>(plan_.first_of_shape(0));
  const auto amplitudes = static_cast<Eigen::Index>(plan_.first_of_effect(plan_.effects.size()));
  informations_ = stages.matrix("informations", amplitudes,
                                [&] { return score_informations(plan_, setup.training); });
  null_residuals_ = held_out_residuals(summaries_, numbers, prior());
  const Matrix off = null_residuals_.rowwise() - null_residuals_.colwise().mean();
  deviation_ = (off.colwise().squaredNorm() / static_cast<double>(n - 1)).cwiseSqrt().transpose();
  const std::vector<ScoreEntry> entries = plan_.entries();
  // Floors: statistics that almost never vary would make any change significant.
  for (Eigen::Index k = 0; k < deviation_.size(); ++k) {
    deviation_(k) = std::max(deviation_(k), entries[static_cast<std::size_t>(k)].least_deviation);
    const double size = numbers.numbers.col(k).cwiseAbs().maxCoeff();
    if (deviation_(k) < kNeverVaries * std::max(size, 1e-3)) deviation_(k) = kNoWeight;
  }
  // A rarely visited knot has at least the deviation of its neighbours.
  for (std::size_t s = 0; s < plan_.shapes.size(); ++s) {
    auto knots = deviation_.segment(named_ + static_cast<Eigen::Index>(s) * kKnots, kKnots);
    std::vector<double> known;
    std::copy_if(knots.begin(), knots.end(), std::back_inserter(known),
                 [](double d) { return d < kNoWeight; });
    if (!known.empty()) knots = knots.cwiseMax(median(known));
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    null_residuals_.row(i) = null_residuals_.row(i).cwiseQuotient(deviation_.transpose());
  }
  learn_effects();
}

Eigen::Index ReferenceEnsemble::summary_numbers() const {
  return static_cast<Eigen::Index>(stages_.setup().entries().size());
}

Vectors ReferenceEnsemble::vectors(const std::vector<Recording>& recordings,
                                   ScoreDetails* details) const {
  return {summary(recordings), to_vector(score(plan_, recordings, details))};
}

Vector ReferenceEnsemble::summary(const std::vector<Recording>& recordings) const {
  return to_vector(stages_.setup().numbers(recordings));
}

ReferenceEnsemble::Simulation ReferenceEnsemble::simulation(
    const Emulator& emulator, const Vector& about, const Matrix& spread, const Matrix& amplitudes,
    const Effect* effect, std::uint64_t seed) const {
  const Matrix points =
      scattered(about, spread, static_cast<int>(amplitudes.rows()), stages_.bounds(), seed);
  Matrix values(amplitudes.rows(), amplitudes.cols());  // of the effect's parameters
  for (Eigen::Index k = 0; k < values.cols(); ++k) {
    const auto c = static_cast<std::size_t>(k);
    const ParameterInfo bounds = emulator_parameter(effect->paths[c]);
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      const double value = effect->value(stages_.setup().model, c, amplitudes(i, k));
      values(i, k) = std::clamp(value, bounds.low, bounds.high);
    }
  }
  const auto record = [this, emulator, points, values, seed](int i) {
    std::vector<double> at = stages_.from_scale(points.row(i));
    for (Eigen::Index k = 0; k < values.cols(); ++k) at.push_back(values(i, k));
    const auto field = perturbed_flow(maps_, derived_seed(seed, kFieldSeed), seed, i);
    return emulator.record(at, derived_seed(seed, 16 + static_cast<std::uint64_t>(i)), field);
  };
  Matrix where(points.rows(), points.cols() + amplitudes.cols());
  where << points, amplitudes;
  return {std::move(where), record};
}

Stages::RowsOfStage ReferenceEnsemble::measured(const std::string& stage, const Simulation& of,
                                                const Measure& numbers) {
  const auto work = [record = of.record, numbers](int i) {
    const auto made = record(i);
    return made ? numbers(*made) : std::vector<double>{};
  };
  return {stage, static_cast<int>(of.points.rows()), work};
}

Stages::RowsOfStage ReferenceEnsemble::scored(const std::string& stage,
                                              const Simulation& of) const {
  return measured(stage, of, [this](const std::vector<Recording>& recordings) {
    const Vectors both = vectors(recordings);
    std::vector<double> row(both.summary.begin(), both.summary.end());
    row.insert(row.end(), both.scores.begin(), both.scores.end());
    return row;
  });
}

Prior ReferenceEnsemble::prior() const {
  return {centre_, spread_.diagonal()};
}

LocalFit ReferenceEnsemble::nearest(const Vector& summary) const {
  return parameters_->fit(summary, within());
}

Vector ReferenceEnsemble::calibrated(const Vector& summary) const {
  return parameters_->fit(summary, within(), prior()).fit.point;
}

ParameterEstimate ReferenceEnsemble::posterior(const Vector& summary, const Prior& before) const {
  return inverse_regression(summaries_, centre_, before, summary).answer;
}

Vector ReferenceEnsemble::residual(const Vectors& vectors) const {
  return residual_at(vectors.scores, calibrated(vectors.summary));
}

// Residuals saturate at 100 deviations, so that statistics with almost no variance among nulls do
// not outweigh all others.
Vector ReferenceEnsemble::residual_at(const Vector& scores, const Vector& point) const {
  const Vector off = scores - scores_->mean(point);
  return off.cwiseQuotient(deviation_).cwiseMax(-kFarOff).cwiseMin(kFarOff);
}

ReferenceEnsemble::Simulation ReferenceEnsemble::simulation_with(const Effect& effect,
                                                                 const Vector& about,
                                                                 const Matrix& spread,
                                                                 const Matrix& amplitudes,
                                                                 std::uint64_t seed) const {
  const CalibrationSetup& setup = stages_.setup();
  std::vector<double> absent;
  for (std::size_t c = 0; c < effect.paths.size(); ++c) {
    absent.push_back(effect.absent(setup.model, c));
  }
  std::vector<std::string> paths = setup.paths();
  paths.insert(paths.end(), effect.paths.begin(), effect.paths.end());
  const Emulator emulator(with_effect(setup.model, effect, absent), paths, setup.shapes,
                          {.moment_matched = false});
  return simulation(emulator, about, spread, amplitudes, &effect, seed);
}

ReferenceEnsemble::Simulation ReferenceEnsemble::nulls(int count, std::uint64_t seed) const {
  const CalibrationSetup& setup = stages_.setup();
  return simulation(setup.emulator(setup.shapes, CalibrationSetup::Of::experiments), centre_,
                    spread_, Matrix(count, 0), nullptr, derived_seed(options_.seed, seed));
}

Matrix ReferenceEnsemble::further_nulls(const std::string& stage, int count,
                                        const Measure& numbers) const {
  const Simulation one = nulls(count, kFurtherSeed);
  const auto rows = stages_.rows("null experiments, " + stage, {measured(stage, one, numbers)});
  return design_of(one.points, rows.front()).numbers;
}

double ReferenceEnsemble::displacement_misfit(const Vector& summary) const {
  const std::vector<SummaryEntry> entries = stages_.setup().entries();
  std::vector<Eigen::Index> of;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].group == "displacement") of.push_back(static_cast<Eigen::Index>(i));
  }
  const Vector off = (summary - parameters_->mean(nearest(summary).point))(of);
  const Matrix covariance = parameters_->covariance()(of, of);
  return off.dot(solve_symmetric(covariance, off));
}

}  // namespace lilytank
