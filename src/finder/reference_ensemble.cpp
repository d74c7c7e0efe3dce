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
#include "text/fnv.hpp"
#include "text/number.hpp"
#include "tracks/summary_parts.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::uint64_t kNullSeed = 1, kSharpSeed = 2, kFurtherSeed = 3, kEffectSeed = 100,
                        kFieldSeed = 7, kCurveSeed = 500;
constexpr int kEnsembleFolds = 8;
constexpr double kCalibrationReach = 2.5;  // deviations of the design that a calibration may go
// Width of designs about a finding relative to that of nulls: its parameters are known better.
constexpr double kNarrow = 0.6;
constexpr double kNeverVaries = 1e-6, kNoWeight = 1e30;
constexpr double kBend = 1;      // one over the square of a second order that is expected
constexpr double kFarOff = 100;  // deviations
// Ridge on the slopes of a fingerprint about estimated amplitudes (inverse of their expected
// squared error), and the degrees of freedom that such a slope takes.
constexpr double kSlopeKnown = 0.25, kSlopesFitted = 0.5;
// Power law of an effect's growth: significance over chance that it requires, least spread of the
// logarithms of the amplitudes, and largest power.
constexpr double kClearly = 0.5, kLeastScoreSpread = 0.03, kMostGrowth = 2.5;

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

// Power of the amplitude with which the residuals grow; 1 where it is not significant.
double growth_of(const Matrix& amplitudes, const Matrix& residuals) {
  const auto numbers = static_cast<double>(residuals.cols());
  MeanSum x, y, xx, xy;
  for (Eigen::Index i = 0; i < residuals.rows(); ++i) {
    const double square = residuals.row(i).squaredNorm() - numbers;
    if (!(square > kClearly * numbers)) continue;
    const double a = std::log(amplitudes.row(i).norm()), f = 0.5 * std::log(square);
    x.add(a), y.add(f), xx.add(a * a), xy.add(a * f);
  }
  const double spread = xx.mean() - x.mean() * x.mean();
  if (!(spread > kLeastScoreSpread)) return 1;
  return std::clamp((xy.mean() - x.mean() * y.mean()) / spread, 1.0, kMostGrowth);
}

// Share of the parameters' variance that calibration resolves: one less the ratio of the variance
// of its errors to that of the parameters.
Vector identifiable_share_by(const Matrix& points, const Matrix& off) {
  const auto variance = [](const Matrix& of) {
    return Vector((of.rowwise() - of.colwise().mean()).colwise().squaredNorm().transpose());
  };
  const Vector share = variance(off).cwiseQuotient(variance(points).cwiseMax(kNeverVaries));
  return (1 - share.array()).cwiseMax(0).matrix();
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
  const Design all =
      design_of(without.points, stages.rows("nulls", {scored("nulls", without)}).front());
  const auto p = centre.size();
  summaries_ = {all.points.leftCols(p), all.numbers.leftCols(summary_numbers())};
  const Design numbers{summaries_.points,
                       all.numbers.rightCols(all.numbers.cols() - summary_numbers())};
  const Eigen::Index n = all.points.rows();
  parameters_ = std::make_unique<ResponseSurface>(summaries_);
  scores_ = std::make_unique<ResponseSurface>(numbers);
  named_ = static_cast<Eigen::Index>(plan_.first_of_shape(0));
  const auto scored = static_cast<Eigen::Index>(plan_.first_of_effect(plan_.effects.size()));
  informations_ = stages.matrix("informations", scored,
                                [&] { return score_informations(plan_, setup.training); });
  null_residuals_ = held_out_residuals(summaries_, numbers, prior());
  const Matrix off = null_residuals_.rowwise() - null_residuals_.colwise().mean();
  deviation_ = (off.colwise().squaredNorm() / static_cast<double>(n - 1)).cwiseSqrt().transpose();
  // A floor: statistics that almost never vary would make any change significant.
  for (Eigen::Index k = 0; k < deviation_.size(); ++k) {
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

// All effects in one loop: an effect has few experiments, and threads would wait for its last one.
void ReferenceEnsemble::learn_effects() {
  std::vector<Simulation> all;
  std::vector<Stages::RowsOfStage> wanted;
  std::uint64_t number = kEffectSeed;
  for (std::size_t e = 0; e < plan_.effects.size(); ++e) {
    all.push_back(learning(plan_.effects[e], derived_seed(options_.seed, number++)));
    wanted.push_back(scored("effect " + std::to_string(e), all.back()));
  }
  const auto rows = stages_.rows("effects", wanted);
  for (std::size_t e = 0; e < all.size(); ++e) {
    fingerprints_.push_back(fingerprint(plan_.effects[e], responses(all[e], rows[e])));
  }
}

Eigen::Index ReferenceEnsemble::summary_numbers() const {
  return static_cast<Eigen::Index>(stages_.setup().entries().size());
}

Vectors ReferenceEnsemble::vectors(const std::vector<Recording>& recordings,
                                   ScoreDetails* details) const {
  return {to_vector(stages_.setup().numbers(recordings)),
          to_vector(score(plan_, recordings, details))};
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
    const double absent = effect->absent(stages_.setup().model, c);
    values.col(k) = (absent + amplitudes.col(k).array() * effect->sizes[c])
                        .cwiseMax(bounds.low)
                        .cwiseMin(bounds.high);
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
  return design_of(one.points, stages_.rows(stage, {measured(stage, one, numbers)}).front())
      .numbers;
}

ReferenceEnsemble::Responses ReferenceEnsemble::answers(const Effect& effect,
                                                        const std::string& stage,
                                                        const Vector& about, const Matrix& spread,
                                                        const Matrix& amplitudes,
                                                        std::uint64_t seed) {
  const Simulation one = simulation_with(effect, about, spread, amplitudes, seed);
  return responses(one, stages_.rows(stage, {scored(stage, one)}).front());
}

ReferenceEnsemble::Responses ReferenceEnsemble::responses(
    const Simulation& of, const std::vector<std::vector<double>>& rows) const {
  const Design made = design_of(of.points, rows);
  const Eigen::Index parameters = centre_.size(), amplitudes = made.points.cols() - parameters;
  const Eigen::Index n = made.points.rows();
  Responses out{made.points.rightCols(amplitudes), made.points.leftCols(parameters),
                Matrix(n, deviation_.size()), Matrix(n, parameters)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vectors v{made.numbers.row(i).head(summary_numbers()),
                    made.numbers.row(i).tail(deviation_.size())};
    const Vector at = calibrated(v.summary);
    out.residuals.row(i) = residual_at(v.scores, at).transpose();
    out.moved.row(i) = at.transpose() - out.points.row(i);
  }
  return out;
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

ReferenceEnsemble::Simulation ReferenceEnsemble::learning(const Effect& effect,
                                                          std::uint64_t seed) const {
  const int count = options_.experiments * static_cast<int>(effect.paths.size());
  return simulation_with(effect, centre_, spread_, learning_amplitudes(effect, count, seed), seed);
}

Fingerprint ReferenceEnsemble::fingerprint(const Effect& effect, const Responses& made) const {
  const auto m = static_cast<Eigen::Index>(effect.paths.size());
  Matrix x(made.amplitudes.rows(), 2 * m);
  x << made.amplitudes, made.amplitudes.array().square().matrix();
  // A ridge of the residuals' unit noise variance on the second-order terms, which are less
  // certain.
  Matrix normal = x.transpose() * x;
  for (Eigen::Index c = 0; c < m; ++c) normal(m + c, m + c) += kBend;
  const Matrix seen = solve_symmetric(normal, Matrix(x.transpose() * made.residuals));
  Matrix plain = made.amplitudes.transpose() * made.amplitudes;
  plain.diagonal().array() += kBend;
  const Matrix moved = solve_symmetric(plain, Matrix(made.amplitudes.transpose() * made.moved));
  Fingerprint out;
  out.about = Vector::Zero(m), out.base = Vector::Zero(deviation_.size());
  out.first = seen.topRows(m).transpose(), out.second = seen.bottomRows(m).transpose();
  out.moved_first = moved.transpose(), out.moved_base = Vector::Zero(centre_.size());
  out.identifiable_share = identifiable_share_by(made.points, made.moved - made.amplitudes * moved);
  out.experiments = options_.experiments, out.two_sided = effect.two_sided;
  out.growth = std::max(effect.growth, growth_of(made.amplitudes, made.residuals.leftCols(named_)));
  return out;
}

Vector ReferenceEnsemble::mean_residual(const Effect& effect, const Vector& amplitudes,
                                        const Vector& point, int experiments,
                                        const std::string& stage, std::uint64_t seed) {
  const Matrix at = amplitudes.transpose().replicate(experiments, 1);
  return answers(effect, stage, point, kNarrow * spread_, at, seed)
      .residuals.colwise()
      .mean()
      .transpose();
}

const Fingerprint& ReferenceEnsemble::shape_fingerprint(int s) {
  const auto known = shape_fingerprints_.find(s);
  if (known != shape_fingerprints_.end()) return known->second;
  const std::uint64_t seed =
      derived_seed(options_.curve_seed, kCurveSeed + static_cast<std::uint64_t>(s));
  const Effect effect = effect_of(plan_.shapes[static_cast<std::size_t>(s)]);
  const std::string stage = "shape " + std::to_string(s);
  const Simulation one = learning(effect, seed);
  const auto rows = stages_.rows(stage, {scored(stage, one)});
  return shape_fingerprints_[s] = fingerprint(effect, responses(one, rows.front()));
}

Fingerprint ReferenceEnsemble::fingerprint_about(const Vector& amplitudes, const Fingerprint& from,
                                                 const Effect& effect, const Vector& calibrated,
                                                 const std::string& name,
                                                 LearnedFingerprints& learned, int experiments) {
  const Eigen::Index m = amplitudes.size();
  const FitBounds bounds = stages_.bounds();
  // Parameters that a calibration does not identify beside the effect keep their prior mean.
  const Vector away =
      from.identifiable_share.cwiseProduct(calibrated - from.moved(amplitudes) - centre_);
  const Vector point = (centre_ + away).cwiseMax(bounds.low).cwiseMin(bounds.high);
  std::vector<LearnedFingerprint>& own = learned[name];
  if (const LearnedFingerprint* known = nearest_of(own, amplitudes, point, experiments)) {
    return known->fingerprint;
  }
  // The key covers what is simulated, not the order of the calls.
  Fnv place;
  place.add(std::span(amplitudes.data(), static_cast<std::size_t>(m)));
  place.add(std::span(point.data(), static_cast<std::size_t>(point.size())));
  const std::uint64_t seed = derived_seed(derived_seed(options_.seed, kSharpSeed), place.value());
  std::string stage = "sharp " + name + " " + hex(place.value());
  if (experiments != kAbout) stage += " of " + std::to_string(experiments);
  const Responses made =
      answers(effect, stage, point, kNarrow * spread_,
              amplitudes_about(amplitudes, experiments, effect.two_sided, seed), seed);
  // An affine response: the known secant slope, corrected in proportion to its noise.
  const Matrix off = made.amplitudes.rowwise() - amplitudes.transpose();
  const Matrix secant =
      from.first + from.second * (amplitudes - from.about).asDiagonal().toDenseMatrix();
  Matrix x(off.rows(), 1 + m);
  x << Vector::Ones(off.rows()), off;
  Matrix normal = x.transpose() * x;
  for (Eigen::Index c = 0; c < m; ++c) normal(1 + c, 1 + c) += kSlopeKnown;
  const Matrix solved =
      solve_symmetric(normal, Matrix(x.transpose() * (made.residuals - off * secant.transpose())));
  Fingerprint out = from;
  out.about = amplitudes, out.base = solved.row(0).transpose();
  out.first = secant + solved.bottomRows(m).transpose();
  out.second = Matrix::Zero(out.first.rows(), m);
  out.moved_base = made.moved.colwise().mean().transpose();
  out.identifiable_share = identifiable_share_by(made.points, made.moved);
  const auto n = static_cast<double>(off.rows());
  out.scatter = (made.residuals - off * secant.transpose() - x * solved) *
                std::sqrt(n / std::max(1.0, n - 1 - kSlopesFitted * static_cast<double>(m)));
  out.experiments = static_cast<int>(off.rows()), out.exact = 0;
  own.push_back({point, out, experiments});
  return out;
}

// The nearest fingerprint that covers these amplitudes and parameters; null if there is none.
const LearnedFingerprint* ReferenceEnsemble::nearest_of(
    const std::vector<LearnedFingerprint>& learned, const Vector& amplitudes, const Vector& point,
    int experiments) const {
  const LearnedFingerprint* nearest = nullptr;
  double least = 1;
  for (const LearnedFingerprint& one : learned) {
    if (one.experiments < experiments) continue;
    const Vector& at = one.fingerprint.about;
    const double far = (amplitudes - at).cwiseQuotient(apart(at)).cwiseAbs().maxCoeff();
    const double off = solve_lower(spread_, point - one.point).cwiseAbs().maxCoeff();
    if (std::max(far, off) <= least) least = std::max(far, off), nearest = &one;
  }
  return nearest;
}

}  // namespace lilytank
