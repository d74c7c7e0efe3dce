// A small tank diagnosed from begin to end: nothing is found where nothing is missing, what is
// planted is named, a law that no effect has is called unnamed.
#include <gtest/gtest.h>

#include <algorithm>

#include "finder/fitted_model.hpp"
#include "lilytank/emulator.hpp"
#include "lilytank/model_parameter.hpp"

namespace lilytank {
namespace {

constexpr int kModules = 6, kFrames = 30 * 30 + 1, kFewFrames = 12 * 30 + 1;

Model small_tank() {
  Model model = standard_model();
  model.module.count = kModules, model.control.latches = false;
  model.steps_per_tick = 2, model.dt = kTick / 2;
  return model;
}

// `tilt`: rad, how far the camera leans towards +x.
std::vector<Recording> filmed(const Model& model, std::uint64_t seed, double tilt = 0,
                              int frames = kFrames) {
  RecordingShape shape;
  shape.name = "simulated", shape.bodies = kModules, shape.frames = frames;
  EmulatorOptions options;
  options.moment_matched = false;
  const std::vector<double> values{tilt};
  return *Emulator(model, {kTiltX}, {shape, shape, shape}, options).record(values, seed);
}

Model with(const std::string& path, double value) {
  return with_parameters(small_tank(), std::vector<std::string>{path}, std::vector<double>{value});
}

// A compass needle in every module: torque at a knot of the headings, N m.
constexpr double kNeedle = 6e-5;
double needle(int knot) {
  return kNeedle * rotation(2 * kPi * knot / kKnots).s;
}
Model with_compass(const std::vector<Shape>& shapes) {
  Shape compass;
  for (const Shape& s : shapes) {
    if (s.curve.along == Along::heading && s.curve.toward == Toward::torque) compass = s;
  }
  std::vector<double> values;
  for (int k = 0; k < kKnots; ++k) values.push_back(needle(k));
  return with_effect(small_tank(), effect_of(compass), values);
}

// Share of what the held-out numbers differ beyond 1, chance's mean square, that the model took
// away: of all groups, as so short a recording leaves none of them clear.
double removed_beyond_one(const Diagnosis& d) {
  double before = 0, after = 0;
  for (const GroupFit& g : d.held_out) {
    before += std::max(0.0, g.before - 1), after += std::max(0.0, g.after - 1);
  }
  return 1 - after / before;
}

Experiment small_experiment(int frames) {
  Experiment experiment;
  experiment.name = "small";
  experiment.base.model = small_tank();
  experiment.recordings = filmed(small_tank(), 11, 0, frames);
  return experiment;
}

DiagnosisOptions least_budget() {
  DiagnosisOptions options;
  options.hold_out = 0, options.minutes = 1;
  return options;
}

// Experiments with an effect serve near their amplitudes; farther away there are new ones.
void expect_that_experiments_serve_nearby(PreparedTank& tank) {
  ReferenceEnsemble& ensemble = tank.ensemble;
  const Effect& effect = ensemble.plan().effects.front();
  LearnedFingerprints learned;
  const auto about = [&](double spreads) {
    const Eigen::VectorXd at = Eigen::VectorXd::Ones(std::ssize(effect.paths));
    ensemble.fingerprint_about(at + spreads * apart(effect, at), ensemble.fingerprints().front(),
                               effect, tank.baseline.point, "probe", learned);
    return learned["probe"].size();
  };
  EXPECT_EQ(about(0), 1u);
  EXPECT_EQ(about(0.8 * kBeside), 1u);
  EXPECT_EQ(about(1.2 * kBeside), 2u);
}

// Strong effects in short recordings: a complete model, a force and a camera get the right
// verdicts.
TEST(SmallTank, StrongEffectsInShortRecordings) {
  DiagnosisSetup setup(small_experiment(kFewFrames), least_budget());
  PreparedTank tank(setup);
  expect_that_experiments_serve_nearby(tank);
  const auto of = [&](const Model& model, std::uint64_t seed, double tilt) {
    Diagnosis out;
    judge(tank, filmed(model, seed, tilt, kFewFrames), out);
    return out;
  };
  const Diagnosis complete = of(small_tank(), 21, 0);
  EXPECT_EQ(complete.verdict, Verdict::complete) << diagnosis_text(complete);
  const Diagnosis torque = of(with("forces.spin_torque.torque", 2e-4), 31, 0);
  ASSERT_EQ(torque.verdict, Verdict::missing) << diagnosis_text(torque);
  EXPECT_EQ(torque.findings.front().effect, "spin_torque") << diagnosis_text(torque);
  // Between the places of the catalogue: the scan of all places shows it, the scores hardly do.
  const Model patchy =
      with_parameters(small_tank(),
                      std::vector<std::string>{"forces.drag_patch.strength", "forces.drag_patch.x",
                                               "forces.drag_patch.y", "forces.drag_patch.radius"},
                      std::vector<double>{4, 0, -0.07, 0.06});
  const Diagnosis patch = of(patchy, 31, 0);
  ASSERT_EQ(patch.verdict, Verdict::missing) << diagnosis_text(patch);
  EXPECT_EQ(patch.findings.front().effect, "drag_patch") << diagnosis_text(patch);
  EXPECT_GT(patch.findings.front().z, 5) << diagnosis_text(patch);
  EXPECT_NE(patch.findings.front().text.find("about (x, y) = (0.006, -0.07"), std::string::npos)
      << patch.findings.front().text;
  const Diagnosis camera = of(small_tank(), 61, 0.1);
  ASSERT_EQ(camera.verdict, Verdict::measurement) << diagnosis_text(camera);
  EXPECT_EQ(camera.findings.front().effect, "camera_tilt") << diagnosis_text(camera);
}

// Null experiments hold for as many recordings of the same length only.
TEST(SmallTank, ServesOnlyRecordingsOfItsKind) {
  const DiagnosedTank tank{small_experiment(kFewFrames), ""};
  try {
    diagnose(small_experiment(kFewFrames / 2), tank, least_budget());
    FAIL() << "shorter recordings were taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("its null experiments do not hold for these"),
              std::string::npos)
        << error.what();
  }
}

// One test: nulls and fingerprints of the tank take most of the time and serve every question.
TEST(LongSmallTank, IsDiagnosed) {
  DiagnosisSetup setup(small_experiment(kFrames), least_budget());
  PreparedTank tank(setup);
  const auto of = [&](const Model& model, std::uint64_t seed) {
    Diagnosis out;
    judge(tank, filmed(model, seed), out);
    return out;
  };
  int held = 0;
  for (const std::uint64_t seed : {21, 22, 23}) {
    Diagnosis d;
    const Judged complete = judge(tank, filmed(small_tank(), seed), d);
    EXPECT_EQ(d.verdict, Verdict::complete) << diagnosis_text(d);
    EXPECT_FALSE(d.detectable.empty());
    report_baseline(tank, complete, d);
    ASSERT_EQ(d.parameters.size(), 5u);
    for (const MovedParameter& p : d.parameters) {
      const double truth = parameter_value(small_tank(), p.path);
      EXPECT_LT(p.low, p.high) << p.path;
      held += p.low <= truth && truth <= p.high ? 1 : 0;
    }
  }
  EXPECT_GE(held, 13);  // of 15
  const Diagnosis torque = of(with("forces.spin_torque.torque", 1e-4), 31);
  ASSERT_EQ(torque.verdict, Verdict::missing) << diagnosis_text(torque);
  EXPECT_EQ(torque.findings.front().effect, "spin_torque") << diagnosis_text(torque);
  const Model pulsating = with("forces.flow_pulsation.share", 0.25);
  const Diagnosis pumps = of(pulsating, 41);
  ASSERT_EQ(pumps.verdict, Verdict::missing) << diagnosis_text(pumps);
  EXPECT_EQ(pumps.findings.front().effect, "flow_pulsation") << diagnosis_text(pumps);
  // Eddies that live as long as none of the catalogue's.
  const Model swirling = with_parameters(
      small_tank(),
      std::vector<std::string>{"forces.correlated_gusts.share", "forces.correlated_gusts.time",
                               "forces.correlated_gusts.length"},
      std::vector<double>{0.5, 0.5, 0.05});
  const Diagnosis eddies = of(swirling, 81);
  ASSERT_EQ(eddies.verdict, Verdict::missing) << diagnosis_text(eddies);
  EXPECT_EQ(eddies.findings.front().effect, "correlated_gusts") << diagnosis_text(eddies);
  // What was simulated for one question serves the next ones: asked again, the same answer.
  Diagnosis fitted;
  const Judged judged = judge(tank, filmed(pulsating, 41), fitted);
  EXPECT_EQ(diagnosis_text(fitted), diagnosis_text(pumps));
  // Fitted together with the baseline, and shown on recordings that had no part in it.
  const Model later = with_parameters(
      pulsating, std::vector<std::string>{"forces.flow_pulsation.phase"}, std::vector<double>{2});
  fit_findings(tank, judged, filmed(later, 42), fitted);
  const FoundParameter& share = fitted.findings.front().parameters.front();
  EXPECT_LT(share.low, 0.25) << diagnosis_text(fitted);
  EXPECT_GT(share.high, 0.25) << diagnosis_text(fitted);
  EXPECT_GT(fitted.removed(), 0.7) << diagnosis_text(fitted);
  EXPECT_GT(fitted.findings.front().gain_low, 0) << diagnosis_text(fitted);
  Diagnosis camera;
  judge(tank, filmed(small_tank(), 61, 0.06), camera);
  EXPECT_EQ(camera.verdict, Verdict::measurement) << diagnosis_text(camera);
  EXPECT_EQ(camera.findings.front().effect, "camera_tilt") << diagnosis_text(camera);
  // A compass needle in every module.
  const Model compass = with_compass(tank.ensemble.plan().shapes);
  Diagnosis odd;
  fit_findings(tank, judge(tank, filmed(compass, 51), odd), filmed(compass, 52), odd);
  ASSERT_EQ(odd.verdict, Verdict::missing) << diagnosis_text(odd);
  // Strong odd laws may leave a named one beside them; the curve over headings must be there.
  const auto law = std::find_if(
      odd.findings.begin(), odd.findings.end(),
      [](const DiagnosisFinding& f) { return f.effect == "unnamed" && f.variable == "heading"; });
  ASSERT_NE(law, odd.findings.end()) << diagnosis_text(odd);
  for (std::size_t k = 0; k < kKnots; ++k) {
    EXPECT_NEAR(law->curve.value[k], needle(static_cast<int>(k)), kNeedle) << diagnosis_text(odd);
  }
  EXPECT_GT(law->gain_low, 0) << diagnosis_text(odd);
  EXPECT_GT(removed_beyond_one(odd), 0.7) << diagnosis_text(odd);
}

}  // namespace
}  // namespace lilytank
