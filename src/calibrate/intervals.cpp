// Intervals by parametric bootstrap, profiles, correlations, what the data cannot tell apart.
#include <algorithm>
#include <cmath>

#include "calibrate/estimate_line.hpp"
#include "calibrate/stages.hpp"
#include "lilytank/random.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::uint64_t kReplicateSeed = 2000;
constexpr double kReplicateSpread = 0.7;  // of their parameters, as a share of the last design's
constexpr int kProfilePoints = 41;
constexpr double kProfileReach = 4;      // standard errors
constexpr double kOneAndTheSame = 0.95;  // correlation beyond which two parameters are one
constexpr double kTellsNothing = 0.5;    // share of the bounds that an interval takes up
constexpr double kMisfits = 0.01;        // probability below which the model does not explain data

FitBounds bounds_for(const Stages& stages) {
  FitBounds bounds = stages.bounds();
  // Estimates of replicates may lie beyond a bound, as the estimate itself might have: otherwise an
  // interval near a bound would be too short. Where the numbers hardly depend on a parameter that
  // would lead anywhere, so the paper's objective stays within.
  if (stages.setup().options.objective != CalibrationObjective::msd) {
    bounds.low.resize(0), bounds.high.resize(0);
  }
  bounds.reach = 5;
  return bounds;
}

void tell_parameters(const Stages& stages, const LocalFit& fit, const Scatter& scatter,
                     CalibrationResult& out) {
  const CalibrationSetup& setup = stages.setup();
  for (std::size_t i = 0; i < setup.parameters.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    CalibratedParameter& p = out.parameters[i];
    const FitParameter& of = p.parameter;
    const double middle = scatter.estimate(k), half = scatter.wide * scatter.deviation(k);
    p.bias = fit.point(k) - middle, p.deviation = scatter.deviation(k);
    const auto within = [&](double at) { return std::clamp(of.from_scale(at), of.low, of.high); };
    p.estimate = within(middle), p.low = within(middle - half), p.high = within(middle + half);
  }
}

// Points of the replicates: about the answer, so that it is seen how estimates follow them. The
// paper's objective has flat directions, along which no line could be turned round.
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

void tell_profiles(const LocalAnswer& answer, const Vector& observed, const FitBounds& bounds,
                   CalibrationResult& out) {
  for (std::size_t i = 0; i < out.parameters.size(); ++i) {
    CalibratedParameter& p = out.parameters[i];
    if (p.parameter.nuisance) continue;
    const auto k = static_cast<Eigen::Index>(i);
    for (int j = 0; j < kProfilePoints; ++j) {
      const double share = 2.0 * j / (kProfilePoints - 1) - 1;
      const double at = answer.fit.point(k) + share * kProfileReach * p.deviation;
      const double value = p.parameter.from_scale(at);
      if (value < p.parameter.low || value > p.parameter.high) continue;
      const LocalFit held = answer.model.fit_with(observed, static_cast<int>(k), at, bounds);
      p.profile_value.push_back(value);
      p.profile_rise.push_back(std::max(0.0, held.misfit - answer.fit.misfit));
    }
  }
}

std::string short_name(const FitParameter& p) {
  return p.path.substr(p.path.rfind('.') + 1);
}

void warn(const Stages& stages, const LocalAnswer& answer, CalibrationResult& out) {
  const std::size_t n = stages.setup().told(), all = out.parameters.size();
  for (std::size_t i = 0; i < n; ++i) {
    const CalibratedParameter& p = out.parameters[i];
    const FitParameter& of = p.parameter;
    const double share =
        (of.to_scale(p.high) - of.to_scale(p.low)) / (of.to_scale(of.high) - of.to_scale(of.low));
    if (share > kTellsNothing) {
      out.warnings.push_back(
          "these data hardly tell " + short_name(of) + ": its interval takes up " +
          std::to_string(static_cast<int>(100 * share)) + " % of the bounds it was looked for in");
    }
    if (p.estimate <= of.low || p.estimate >= of.high) {
      out.warnings.push_back(short_name(of) + " is at a bound, " + shortest(p.estimate) +
                             ": widen it, or the model lacks something");
    }
    for (std::size_t j = 0; j < i; ++j) {
      const double r = out.correlation[i * all + j];
      if (std::fabs(r) <= kOneAndTheSame) continue;
      out.warnings.push_back("these data cannot tell " + short_name(out.parameters[j].parameter) +
                             " and " + short_name(of) + " apart: their correlation is " +
                             without_rounding(std::round(100 * r) / 100) +
                             ", so only a combination of the two is known");
    }
  }
  if (!answer.settled) {
    out.warnings.push_back("the estimate had not settled after " + std::to_string(answer.rounds) +
                           " local models: intervals may be too short");
  }
  if (out.misfit_p < kMisfits) {
    out.warnings.push_back(
        "the model does not explain these data: a misfit as large as this one has probability " +
        without_rounding(std::round(1000 * out.misfit_p) / 1000) +
        " if it were true; intervals are those of the nearest such model");
  }
}

}  // namespace

void find_intervals(Stages& stages, const LocalAnswer& answer, const FlowMaps& maps,
                    const Vector& observed, CalibrationResult& out) {
  const CalibrationSetup& setup = stages.setup();
  const int wanted = setup.options.replicates;
  const Vector centre = stages.to_scale(stages.from_scale(answer.fit.point));
  const std::uint64_t seed = derived_seed(setup.options.seed, kReplicateSeed);
  const Matrix points = replicate_points(stages, answer, centre, seed);
  const auto rows = stages.simulate("replicates", points, seed, maps);
  const FitBounds bounds = bounds_for(stages);
  const auto n = std::count_if(rows.begin(), rows.end(), [](const auto& r) { return !r.empty(); });
  if (2 * n < wanted) throw InputError("worlds at the estimate diverge: is the step too long?");
  Matrix off(n, centre.size()), estimates(n, centre.size()), told(n, observed.size());
  Eigen::Index at = 0;
  int larger = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].empty()) continue;
    told.row(at) = Eigen::Map<const Vector>(rows[i].data(), observed.size());
    const LocalFit fit = answer.model.fit(told.row(at), bounds);
    estimates.row(at) = fit.point;
    off.row(at) = points.row(static_cast<Eigen::Index>(i)) - centre.transpose();
    larger += fit.misfit >= answer.fit.misfit ? 1 : 0;
    ++at;
  }
  const Line line = line_through(off, estimates);
  const Scatter scatter = scatter_of(line, centre, answer.fit.point);
  tell_parameters(stages, answer.fit, scatter, out);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vector of = scatter.estimate + scatter.back * line.residuals.row(i).transpose();
    out.replicate_estimates.emplace_back(of.begin(), of.end());
  }
  out.correlation.assign(scatter.correlation.data(),
                         scatter.correlation.data() + scatter.correlation.size());
  out.misfit = answer.fit.misfit;
  out.misfit_p = (larger + 1.0) / (static_cast<double>(n) + 1.0);
  const Line numbers = line_through(off, told);
  Vector expected = numbers.at_centre;
  if (numbers.inverse.rows() > 1) expected += numbers.slope * (scatter.estimate - centre);
  const std::vector<SummaryEntry> entries = setup.entries();
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    out.numbers.push_back(
        {entries[k], observed(i), expected(i), std::sqrt(numbers.covariance(i, i))});
  }
  tell_profiles(answer, observed, bounds, out);
  warn(stages, answer, out);
}

}  // namespace lilytank
