// Intervals by parametric bootstrap, profiles, correlations, non-identifiable combinations.
#include <algorithm>
#include <cmath>

#include "calibrate/cross_fit.hpp"
#include "calibrate/design.hpp"
#include "calibrate/estimate_line.hpp"
#include "calibrate/stages.hpp"
#include "lilytank/random.hpp"
#include "statistics/linear.hpp"
#include "statistics/quantiles.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::uint64_t kReplicateSeed = 2000;
constexpr double kReplicateSpread = 0.8;  // of their parameters, as a share of the last design's
constexpr double kEstimateReach = 5;      // deviations of the points that an estimate may be off
constexpr double kLeastSlope = 0.1;       // of an estimate in the truth: less is noise
constexpr int kProfilePoints = 41;
constexpr double kProfileReach = 4;      // standard errors
constexpr double kDrawnRise = 20;        // of the misfit, that figures show
constexpr double kOneAndTheSame = 0.95;  // correlation beyond which two parameters are one
constexpr double kTellsNothing = 0.5;    // share of the bounds that an interval takes up
constexpr double kMisfits = 0.01;        // probability below which the model does not explain data

// Simulated experiments of known parameters, estimated as the data are.
struct Replicates {
  Design made;
  Matrix errors;  ///< of their estimates, a row each
  Vector misfits;
  Vector middle;  ///< what the data's estimate says of their parameters
  Matrix covariance;
  double wide;  ///< half width of a 95 % interval in deviations
  double misfit;
  ResponseSurface model;  ///< of all simulations that count
};

// Cross-fitted, over all simulations about the estimate. The regression of their estimates on the
// truth corrects the bias by noise in the slopes.
// Estimates are made of the fitted statistics. All show whether the model fits.
Replicates by_others(const Stages& stages, const LocalAnswer& answer, Design made) {
  const CalibrationSetup& setup = stages.setup();
  const std::vector<Eigen::Index> fitted = stages.fitted();
  const Slopes slopes = setup.slopes();
  const Eigen::Index n = made.points.rows();
  const Design whole = joined(answer.design, made), all = with_columns(whole, fitted);
  const CrossFit fit = cross_fit(all, answer.observed(fitted), Misfit::covariance, slopes);
  const CrossFit whole_fit =
      setup.predicted() ? cross_fit(whole, answer.observed, Misfit::covariance, slopes) : fit;
  const BiasCorrectedFit corrected = setup.predicted() ? bias_corrected(all, fit, setup.prior())
                                                       : bias_corrected(all, fit, kLeastSlope);
  return {std::move(made),           corrected.errors.bottomRows(n),
          whole_fit.misfits.tail(n), corrected.point,
          corrected.covariance,      corrected.wide,
          whole_fit.misfit,          ResponseSurface(all, Misfit::covariance, slopes)};
}

// The paper's objective has flat directions, along which no regression can be inverted: its
// estimates stay within the bounds, and all replicates are simulated at the estimate.
Replicates by_the_answer(const Stages& stages, const LocalAnswer& answer, Design made) {
  FitBounds bounds = stages.bounds();
  bounds.reach = kEstimateReach;
  const Eigen::Index n = made.points.rows();
  Replicates out{
      std::move(made), Matrix(n, answer.fit.point.size()), Vector(n), {}, {}, 0, answer.fit.misfit,
      answer.model};
  for (Eigen::Index i = 0; i < n; ++i) {
    const LocalFit fit = answer.model.fit(out.made.numbers.row(i).transpose(), bounds);
    out.errors.row(i) = fit.point.transpose() - out.made.points.row(i);
    out.misfits(i) = fit.misfit;
  }
  const Vector bias = out.errors.colwise().mean().transpose();
  out.errors.rowwise() -= bias.transpose();
  const auto count = static_cast<double>(n);
  out.covariance = out.errors.transpose() * out.errors / (count - 1);
  out.wide = student_half_width(count - 1) * std::sqrt(1 + 1 / count);
  out.middle = answer.fit.point - bias;
  return out;
}

void set_parameters(const Stages& stages, const LocalAnswer& answer, const Replicates& replicates,
                    const Vector& chosen, CalibrationResult& out) {
  const CalibrationSetup& setup = stages.setup();
  const Vector deviation = replicates.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  for (std::size_t i = 0; i < setup.parameters.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    CalibratedParameter& p = out.parameters[i];
    const FitParameter& of = p.parameter;
    const double middle = replicates.middle(k), half = replicates.wide * deviation(k);
    p.bias = answer.fit.point(k) - middle, p.deviation = deviation(k);
    const auto within = [&](double at) { return std::clamp(of.from_scale(at), of.low, of.high); };
    p.estimate = within(chosen(k)), p.middle = within(middle);
    p.low = within(middle - half), p.high = within(middle + half);
    for (Eigen::Index l = 0; l < deviation.size(); ++l) {
      out.correlation.push_back(replicates.covariance(k, l) /
                                std::max(deviation(k) * deviation(l), 1e-300));
    }
  }
  for (Eigen::Index i = 0; i < replicates.errors.rows(); ++i) {
    const Vector of = replicates.middle + replicates.errors.row(i).transpose();
    out.replicate_estimates.emplace_back(of.begin(), of.end());
  }
  const auto n = static_cast<double>(replicates.misfits.size());
  const auto larger = (replicates.misfits.array() >= replicates.misfit).count();
  out.misfit = replicates.misfit;
  out.misfit_p = (static_cast<double>(larger) + 1) / (n + 1);
}

// Observed statistics and their expectation at the estimate, by a linear fit to the replicates.
void set_numbers(const Stages& stages, const Replicates& replicates, const Vector& centre,
                 const Vector& observed, CalibrationResult& out) {
  const Line line =
      line_through(replicates.made.points.rowwise() - centre.transpose(), replicates.made.numbers);
  Vector estimate(centre.size());
  for (Eigen::Index k = 0; k < centre.size(); ++k) {
    const CalibratedParameter& p = out.parameters[static_cast<std::size_t>(k)];
    estimate(k) = p.parameter.to_scale(p.estimate);
  }
  Vector expected = line.at_centre;
  if (line.inverse.rows() > 1) expected += line.slope * (estimate - centre);
  const std::vector<SummaryEntry> entries = stages.entries();
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    out.numbers.push_back({entries[k], observed(i), expected(i), std::sqrt(line.covariance(i, i))});
  }
}

// Points of the replicates: scattered about the estimate, so that the regression has a slope. The
// paper's objective has flat directions, along which no regression can be inverted.
Matrix replicate_points(const Stages& stages, const LocalAnswer& answer, const Vector& centre,
                        std::uint64_t seed) {
  const CalibrationOptions& o = stages.setup().options;
  Matrix points = centre.transpose().replicate(o.replicates, 1);
  if (o.objective == CalibrationObjective::msd) return points;
  const Matrix spread = kReplicateSpread * answer.spread;
  for (int i = 0; i < o.replicates; ++i) {
    Vector z(centre.size());
    for (Eigen::Index k = 0; k < z.size(); ++k) {
      z(k) = normal_pair({seed, Stream::calibrate, i, static_cast<std::uint32_t>(k), 5})[0];
    }
    points.row(i) = stages.to_scale(stages.from_scale(centre + spread * z));
  }
  return points;
}

// The values between which a profile is below kDrawnRise, and one more on each side; equal where
// that is most of it.
std::pair<double, double> low_part(const CalibratedParameter& p) {
  const std::vector<double>& rise = p.profile_rise;
  std::size_t first = rise.size(), last = 0, low = 0;
  for (std::size_t j = 0; j < rise.size(); ++j) {
    if (rise[j] > kDrawnRise) continue;
    first = std::min(first, j), last = j, ++low;
  }
  if (low == 0 || 2 * low > rise.size()) return {0, 0};
  return {p.profile_value[first > 0 ? first - 1 : 0],
          p.profile_value[std::min(last + 1, rise.size() - 1)]};
}

void set_profiles(const Stages& stages, const Replicates& replicates, const Vector& observed,
                  CalibrationResult& out) {
  FitBounds bounds = stages.bounds();
  bounds.reach = kEstimateReach;
  const LocalFit best = replicates.model.fit(observed, bounds);
  for (std::size_t i = 0; i < out.parameters.size(); ++i) {
    CalibratedParameter& p = out.parameters[i];
    if (p.parameter.nuisance) continue;
    const auto k = static_cast<Eigen::Index>(i);
    const auto add = [&](double from, double to) {
      p.profile_value.clear(), p.profile_rise.clear();
      for (int j = 0; j < kProfilePoints; ++j) {
        const double at = from + j * (to - from) / (kProfilePoints - 1);
        const double value = p.parameter.from_scale(at);
        if (value < p.parameter.low || value > p.parameter.high) continue;
        const LocalFit held = replicates.model.fit_with(observed, static_cast<int>(k), at, bounds);
        p.profile_value.push_back(value);
        p.profile_rise.push_back(std::max(0.0, held.misfit - best.misfit));
      }
    };
    const double reach = kProfileReach * p.deviation, middle = replicates.middle(k);
    add(middle - reach, middle + reach);
    // A profile may be much narrower than the interval: then again, as far as it can be drawn.
    const auto [from, to] = low_part(p);
    if (from < to) add(p.parameter.to_scale(from), p.parameter.to_scale(to));
  }
}

// Of the first `n` parameters, those that are strongly correlated with `first`, directly or in a
// chain.
std::vector<std::size_t> entangled_with(std::size_t first, std::size_t n,
                                        const CalibrationResult& out) {
  std::vector<std::size_t> group{first};
  for (std::size_t k = 0; k < group.size(); ++k) {
    for (std::size_t j = 0; j < n; ++j) {
      const double r = out.correlation[group[k] * out.parameters.size() + j];
      const bool known = std::find(group.begin(), group.end(), j) != group.end();
      if (!known && std::fabs(r) > kOneAndTheSame) group.push_back(j);
    }
  }
  std::sort(group.begin(), group.end());
  return group;
}

// One warning for each set of parameters of which only a combination is identifiable.
void warn_of_entangled(std::size_t n, CalibrationResult& out) {
  for (std::size_t i = 0; i < n; ++i) {
    const std::vector<std::size_t> group = entangled_with(i, n, out);
    if (group.size() < 2 || group.front() != i) continue;
    std::vector<std::string> names;
    double closest = 0;
    for (std::size_t k = 0; k < group.size(); ++k) {
      names.push_back(own_name(out.parameters[group[k]].parameter.path));
      for (std::size_t l = 0; l < k; ++l) {
        const double r = out.correlation[group[k] * out.parameters.size() + group[l]];
        if (std::fabs(r) > std::fabs(closest)) closest = r;
      }
    }
    const std::string r = without_rounding(std::round(1000 * closest) / 1000);
    out.warnings.push_back(
        "these data do not distinguish " + listed(names) + ": " +
        (group.size() == 2
             ? "their correlation is " + r + ", so only a combination of the two is"
             : "two of them correlate by " + r + ", so only combinations of them are") +
        " known");
  }
}

void warn(const Stages& stages, const LocalAnswer& answer, CalibrationResult& out) {
  out.warnings = stages.setup().warnings_of_begin();
  const std::size_t n = stages.setup().reported_count();
  for (std::size_t i = 0; i < n; ++i) {
    const CalibratedParameter& p = out.parameters[i];
    const FitParameter& of = p.parameter;
    const double share =
        (of.to_scale(p.high) - of.to_scale(p.low)) / (of.to_scale(of.high) - of.to_scale(of.low));
    if (share > kTellsNothing) {
      out.warnings.push_back(
          "these data hardly constrain " + own_name(of.path) + ": its interval spans " +
          std::to_string(static_cast<int>(100 * share)) + " % of the range searched");
    }
    if (p.estimate <= of.low || p.estimate >= of.high) {
      out.warnings.push_back(own_name(of.path) + " is at a bound, " + shortest(p.estimate) +
                             ": widen it, or the model lacks something");
    }
  }
  warn_of_entangled(n, out);
  if (!answer.settled) {
    out.warnings.push_back("the estimate had not settled after " + std::to_string(answer.rounds) +
                           " response surfaces: intervals may be too short");
  }
  if (out.misfit_p < kMisfits) {
    out.warnings.push_back(
        "the model does not explain these data: a misfit as large as this one has probability " +
        without_rounding(std::round(1000 * out.misfit_p) / 1000) +
        " if it were true; intervals are those of the nearest such model");
  }
}

// Warnings about an estimate selected by the MSD.
void warn_of_choice(const Stages& stages, const NearestPoint& chosen, CalibrationResult& out) {
  if (!chosen.settled) {
    out.warnings.push_back("the choice by displacements had not settled after " +
                           std::to_string(chosen.rounds) +
                           " rounds: others among these parameters may be nearer by Eq. 9");
  }
  std::vector<std::string> outside;
  for (std::size_t i = 0; i < stages.setup().reported_count(); ++i) {
    const CalibratedParameter& p = out.parameters[i];
    if (p.estimate < p.low || p.estimate > p.high) outside.push_back(own_name(p.parameter.path));
  }
  if (outside.empty()) return;
  out.warnings.push_back("the recorded displacements fit best with " + listed(outside) +
                         " outside the interval from all summary statistics: the model omits an "
                         "effect, or the flow is wrong");
}

}  // namespace

void find_intervals(Stages& stages, const LocalAnswer& answer, const FlowMaps& maps,
                    CalibrationResult& out) {
  const CalibrationSetup& setup = stages.setup();
  const Vector& observed = answer.observed;
  const Vector centre = stages.to_scale(stages.from_scale(answer.fit.point));
  const std::uint64_t seed = derived_seed(setup.options.seed, kReplicateSeed);
  const Matrix points = replicate_points(stages, answer, centre, seed);
  Design made = design_of(points, stages.simulate("replicates", points, seed, maps));
  const Replicates replicates = setup.options.objective == CalibrationObjective::msd
                                    ? by_the_answer(stages, answer, std::move(made))
                                    : by_others(stages, answer, std::move(made));
  NearestPoint chosen{replicates.middle, 0, true};
  if (setup.chosen_by_displacements()) {
    chosen = nearest_displacements(stages, replicates.middle, replicates.covariance, centre);
  }
  set_parameters(stages, answer, replicates, chosen.point, out);
  set_numbers(stages, replicates, centre, observed, out);
  set_profiles(stages, replicates, observed(stages.fitted()), out);
  warn(stages, answer, out);
  warn_of_choice(stages, chosen, out);
}

}  // namespace lilytank
