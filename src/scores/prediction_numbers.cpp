#include "scores/prediction_numbers.hpp"

#include <algorithm>
#include <cmath>

#include "scores/nuisances.hpp"
#include "scores/scores.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

constexpr double kBarelyKnown = 0.01;      // prior information of a change, in sizes
constexpr double kLongestStep = 1.0 / 30;  // s, of the predictions

}  // namespace

ScorePlan prediction_plan(const Model& model, const std::vector<Recording>& recordings,
                          int bodies) {
  ScorePlan plan;
  plan.model = model;
  plan.predictor = predictor_options(model, recordings);
  plan.rate = recordings.front().rate;
  plan.predictor.substeps =
      std::max(1, static_cast<int>(std::lround(1 / (plan.rate * kLongestStep))));
  plan.modules = std::max(bodies, identities_in(recordings));
  plan.nuisances = std::make_shared<const Nuisances>();
  return plan;
}

std::vector<std::string> prediction_names() {
  std::vector<std::string> out;
  for (const Nuisances::Parameter& p : Nuisances::kModelParameters) {
    out.push_back(std::string("change of ") + p.name);
  }
  return out;
}

std::vector<double> prediction_numbers(const ScorePlan& plan,
                                       const std::vector<Recording>& recordings) {
  ScoreSums sums = score_sums(plan, recordings, {});
  sums.information.diagonal().array() += kBarelyKnown;
  const Eigen::VectorXd changes = solve_symmetric(sums.information, sums.scores);
  std::vector<double> out;
  Eigen::Index k = 0;
  for (const Nuisances::Parameter& p : Nuisances::kModelParameters)
    out.push_back(changes(k++) * p.size);
  return out;
}

}  // namespace lilytank
