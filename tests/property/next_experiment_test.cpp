// Proposed experiments, recorded in tanks where one of two effects is there: whether they show what
// was predicted, and more than as many minutes of the same recordings.
#include "finder/next_experiment.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "lilytank/flow_maps.hpp"
#include "lilytank/random.hpp"
#include "scores/nuisances.hpp"
#include "scores/scores.hpp"
#include "support/filmed.hpp"

namespace lilytank {
namespace {

using test::drifting;
using test::plan_for;

constexpr int kModules = 15;
constexpr double kWeak = 0.6,
                 kMinutes = 8;  // of the size that some minutes show by ten standard errors

struct Outcome {
  double predicted = 0, measured = 0, repeated = 0;  // nat
};

class Tank {
 public:
  Tank() {
    plan_ = plan_for(model_, test::filmed(model_, 40, 1));
    plan_.nuisances = std::make_shared<const Nuisances>(model_, FlowMaps(model_.field), 1);
    plan_.modules = 2 * kModules;
  }

  // `name`: of the effect that is there.
  Outcome split(const std::string& name, const std::string& other, std::uint64_t seed) const {
    const Effect truth = effect(name);
    std::vector<double> amplitudes;
    for (std::size_t c = 0; c < truth.sizes.size(); ++c) {
      amplitudes.push_back(truth.absent(model_, c) + kWeak * truth.sizes[c]);
    }
    const Model world = with_effect(model_, truth, amplitudes);
    const std::vector<Effect> both{truth, effect(other)};
    const std::vector<Recording> old{filmed(world, kModules, 6, derived_seed(seed, 1))};
    OpenQuestion question;
    for (const JointAmplitudes& one : joint_amplitudes(plan_, old, both)) {
      question.candidates.push_back({both[question.candidates.size()], one.estimate});
    }
    const auto all = propose_experiments({plan_, old}, question, derived_seed(seed, 2));
    if (all.empty()) throw std::logic_error("nothing is proposed");
    const ProposedExperiment& best = all.front();
    const double minutes = std::min(best.minutes, kMinutes);
    const auto ratio_with = [&](int modules, std::uint64_t draw) {
      std::vector<Recording> together = old;
      together.push_back(filmed(world, modules, minutes, derived_seed(seed, draw)));
      return ratio(together, both) - ratio(old, both);
    };
    return {best.information * minutes / best.minutes, ratio_with(best.modules, 3),
            ratio_with(kModules, 4)};
  }

 private:
  Effect effect(const std::string& name) const {
    for (const Effect& one : plan_.effects) {
      if (one.name == name) return one;
    }
    throw std::logic_error("no effect " + name);
  }
  static Recording filmed(Model world, int modules, double minutes, std::uint64_t seed) {
    world.module.count = modules;
    return test::filmed(world, 60 * minutes, seed).front();
  }
  // Log-likelihood ratio of the first effect to the second, each at its best amplitudes.
  double ratio(const std::vector<Recording>& recordings, const std::vector<Effect>& both) const {
    const auto fits = joint_amplitudes(plan_, recordings, both);
    return 0.5 * (fits[0].gain - fits[1].gain);
  }

  const Model model_ = drifting(kModules);
  ScorePlan plan_;
};

// The prediction is that of the pair's least distinguished direction.
TEST(NextExperimentRecorded, ShowsMoreThanMoreOfTheSame) {
  const Tank tank;
  const std::pair<const char*, const char*> pairs[] = {{"magnetic_dipole", "pair_attraction"},
                                                       {"spin_torque", "rotational_drag"}};
  for (const auto& [truth, other] : pairs) {
    const Outcome found = tank.split(truth, other, 1);
    EXPECT_GT(found.measured, 0.5 * found.predicted) << truth;
    EXPECT_GT(found.measured, 1.3 * found.repeated) << truth;
  }
}

}  // namespace
}  // namespace lilytank
