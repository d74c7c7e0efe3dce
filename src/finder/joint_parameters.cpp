#include "finder/joint_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lilytank/math.hpp"
#include "lilytank/model_parameter.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// Deviations of the first design: of refined parameters on a log scale, and of places, as a share
// of the width of what is there: farther off, scores about the place are no longer linear in it.
constexpr double kRefined = 0.25, kPlaced = 0.25;
// Prior deviation of an effect's amplitudes about those of the selection, in their root mean
// square. Knots that modules rarely visit have no other constraint.
constexpr double kNamed = 1;
constexpr double kLeast = 1e-3;  // of the model's rate, that a fit tries

// m; of what is not at a place, the range of the parameter.
double place_width(const Effect& effect, const FitParameter& p) {
  return effect.estimated == Estimated::place ? effect.held[2].value : p.high - p.low;
}

// Index of each effect's first amplitude among the parameters.
std::vector<Eigen::Index> places_of(const Stages& stages, const std::vector<JointEffect>& effects) {
  std::vector<Eigen::Index> out;
  auto at = static_cast<Eigen::Index>(stages.setup().parameters.size());
  for (const JointEffect& e : effects) {
    out.push_back(at);
    at += static_cast<Eigen::Index>(e.effect.paths.size() + e.effect.refine.size());
  }
  return out;
}

}  // namespace

Beginning begin(const Stages& stages, const std::vector<JointEffect>& effects,
                const JointStart& baseline, JointFit& fit) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  const CalibrationSetup& setup = stages.setup();
  fit.parameters = setup.parameters, fit.model = setup.model;
  Beginning out;
  for (Eigen::Index k = 0; k < baseline.point.size(); ++k) {
    out.add(baseline.point(k), baseline.deviation(k), kUnknown);
  }
  for (const auto& [effect, amplitudes, shape] : effects) {
    std::vector<double> sizes;
    const double usual =
        std::sqrt(amplitudes.squaredNorm() / static_cast<double>(amplitudes.size()));
    for (std::size_t c = 0; c < effect.paths.size(); ++c) {
      const ModelParameter of = model_parameter(effect.paths[c]);
      const double a = amplitudes(static_cast<Eigen::Index>(c)), size = std::fabs(effect.sizes[c]);
      // Of a rate, no smaller share is tried.
      const double low =
          effect.logarithmic(c) ? std::max(of.low, kLeast * effect.absent(setup.model, c)) : of.low;
      const double value = std::clamp(effect.value(setup.model, c, a), low, of.high);
      const FitParameter p{effect.paths[c], effect.units[c],       low,
                           of.high,         effect.logarithmic(c), false};
      fit.parameters.push_back(p);
      out.add(p.to_scale(value), size * std::max(0.15, 0.25 * std::fabs(a)), kNamed * size * usual);
      sizes.push_back(value);
    }
    fit.model = with_effect(fit.model, effect, sizes);
    for (const FitParameter& p : effect.refine) {
      fit.parameters.push_back(p);
      out.add(p.to_scale(parameter_value(fit.model, p.path)),
              p.logarithmic ? kRefined : kPlaced * place_width(effect, p), kUnknown);
    }
  }
  return out;
}

std::size_t least_supported(const Stages& stages, const std::vector<JointEffect>& effects,
                            const Matrix& covariance, double keep, Vector& point) {
  const std::vector<Eigen::Index> places = places_of(stages, effects);
  const auto size = [&](std::size_t e) {
    return static_cast<Eigen::Index>(effects[e].effect.paths.size());
  };
  const auto off = [&](std::size_t e) {
    Vector out = point.segment(places[e], size(e));
    for (Eigen::Index c = 0; c < out.size(); ++c) {
      const Effect& effect = effects[e].effect;
      const auto k = static_cast<std::size_t>(c);
      const double none = effect.absent(stages.setup().model, k);
      out(c) -= effect.logarithmic(k) ? log_portable(none) : none;
    }
    return out;
  };
  // The inverse of an effect's covariance times its amplitudes.
  const auto weighed = [&](std::size_t e) -> Vector {
    return solve_symmetric(covariance.block(places[e], places[e], size(e), size(e)), off(e));
  };
  std::size_t weakest = effects.size();
  double least = keep * keep;
  for (std::size_t e = 1; e < effects.size(); ++e) {
    const double distance = off(e).dot(weighed(e)) / static_cast<double>(size(e));
    if (distance < least) least = distance, weakest = e;
  }
  if (weakest == effects.size()) return weakest;
  point -= covariance.middleCols(places[weakest], size(weakest)) * weighed(weakest);
  return weakest;
}

void read_point(const Stages& stages, const Vector& point, std::vector<JointEffect>& effects) {
  const std::vector<Eigen::Index> places = places_of(stages, effects);
  for (std::size_t e = 0; e < effects.size(); ++e) {
    Effect& effect = effects[e].effect;
    Eigen::Index at = places[e];
    for (std::size_t c = 0; c < effect.paths.size(); ++c, ++at) {
      effects[e].amplitudes(static_cast<Eigen::Index>(c)) = effect.amplitude(
          stages.setup().model, c, effect.logarithmic(c) ? exp_portable(point(at)) : point(at));
    }
    for (const FitParameter& p : effect.refine) {
      for (auto& [of, value] : effect.held) {
        if (of.path() == p.path) value = std::clamp(p.from_scale(point(at)), p.low, p.high);
      }
      ++at;
    }
  }
}

std::vector<Eigen::Index> placed_parameters(const Stages& stages,
                                            const std::vector<JointEffect>& effects) {
  const std::vector<Eigen::Index> places = places_of(stages, effects);
  std::vector<Eigen::Index> out;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const Effect& effect = effects[e].effect;
    if (effect.estimated != Estimated::place) continue;
    const auto count = static_cast<Eigen::Index>(effect.paths.size() + effect.refine.size());
    for (Eigen::Index k = 0; k < count; ++k) out.push_back(places[e] + k);
  }
  return out;
}

FitBounds bounds_of(const JointFit& fit) {
  FitBounds bounds;
  const auto n = static_cast<Eigen::Index>(fit.parameters.size());
  bounds.low.resize(n), bounds.high.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const FitParameter& p = fit.parameters[static_cast<std::size_t>(k)];
    bounds.low(k) = p.to_scale(p.low), bounds.high(k) = p.to_scale(p.high);
  }
  return bounds;
}

}  // namespace lilytank
