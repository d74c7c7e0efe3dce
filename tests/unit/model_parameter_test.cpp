// Numbers of a model by their scenario paths.
#include "lilytank/model_parameter.hpp"

#include <gtest/gtest.h>

#include "io/scenario_keys.hpp"
#include "lilytank/error.hpp"
#include "lilytank/scenario.hpp"
#include "lilytank/start.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

using Texts = std::vector<std::string>;

TEST(ModelParameter, pathsReachNumbersAndNothingElseChanges) {
  const Model model = standard_model();
  const Texts paths{"flow.K_v", "forces.face_drag.K_F", "module.mass"};
  const std::vector<double> values{1.1, 0.6, 0.03};
  const Model changed = with_parameters(model, paths, values);
  EXPECT_EQ(changed.flow.K_v, 1.1);
  EXPECT_EQ(changed.module.mass, 0.03);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    EXPECT_EQ(parameter_value(changed, paths[i]), values[i]);
  }
  EXPECT_EQ(changed.field, model.field);
  EXPECT_EQ(changed.forces.size(), model.forces.size());
  EXPECT_EQ(parameter_value(changed, "forces.damping.D_linear"),
            parameter_value(model, "forces.damping.D_linear"));
  EXPECT_EQ(parameter_value(model, "flow.K_v"), 1.365);
}

TEST(ModelParameter, namingAParameterOfAForceThatIsOffSwitchesItOn) {
  const Model model = standard_model();
  const Texts paths{"forces.body_force.force_x"};
  const Model changed = with_parameters(model, paths, std::vector<double>{0.001});
  EXPECT_EQ(changed.forces.size(), model.forces.size() + 1);
  EXPECT_EQ(parameter_value(changed, paths[0]), 0.001);
}

// A model set by a parameter has the bits of one that a scenario sets.
TEST(ModelParameter, everyParameterSetsWhatAScenarioSets) {
  const Model standard = load_scenario({}, {}).model;
  ScenarioDraft draft;
  const std::vector<ScenarioKey> keys = scenario_keys(draft);
  int compared = 0;
  for (const ScenarioKey& key : keys) {
    if (!key.number || key.whole) continue;
    const ModelParameter parameter = model_parameter(key.path);
    const double now = parameter.get(standard);
    const double value = now + 1e-7 * ((now < key.high ? key.high : key.low) - now);
    Model changed = standard;
    parameter.set(changed, value);
    const Model loaded = load_scenario({}, {key.path + "=" + shortest(value)}).model;
    for (const ScenarioKey& other : keys) {
      if (!other.number) continue;
      EXPECT_EQ(other.number->get(changed), other.number->get(loaded))
          << other.path << " by " << key.path;
    }
    ASSERT_EQ(changed.forces.size(), loaded.forces.size()) << key.path;
    for (std::size_t i = 0; i < loaded.forces.size(); ++i) {
      EXPECT_EQ(changed.forces[i].term, loaded.forces[i].term) << key.path;
      EXPECT_EQ(changed.forces[i].p, loaded.forces[i].p) << key.path;
    }
    EXPECT_EQ(changed.dt, loaded.dt);
    ++compared;
  }
  EXPECT_GT(compared, 50);
}

TEST(ModelParameter, unitsAndBoundsAreThoseOfTheScenario) {
  const ModelParameter p = model_parameter("forces.stochastic.sigma_stoch");
  EXPECT_EQ(p.unit, "N");
  EXPECT_EQ(p.low, 0);
  EXPECT_EQ(p.high, 1);
}

TEST(ModelParameter, refusesWithTheNearestRightPath) {
  const struct {
    std::string path, message;
  } cases[] = {
      {"forces.face_drag.K_f", "did you mean 'forces.face_drag.K_F'?"},
      {"run.dt", "is not a number that can be varied in recordings of one tank"},
      {"flow.gusts", "is not a number that can be varied"},
      {"nothing", "is not a parameter of the model"},
  };
  for (const auto& c : cases) {
    try {
      model_parameter(c.path);
      ADD_FAILURE() << c.path;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(c.message), std::string::npos) << e.what();
    }
  }
  const Texts paths{"flow.K_v"};
  EXPECT_THROW(with_parameters(standard_model(), paths, std::vector<double>{-1}), InputError);
}

}  // namespace
}  // namespace lilytank
