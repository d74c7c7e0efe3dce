// Which laws a verdict on point bodies names, from gains that are given and from simulated runs.
#include <gtest/gtest.h>

#include "bodies/simulated_runs.hpp"
#include "bodies/verdict.hpp"

namespace lilytank {
namespace {

using bodies::Comparison;
using bodies::LawTrial;

// An outcome with these gains (nat) in two blocks of time.
LawTrial outcome(const std::vector<const char*>& laws, double first, double second) {
  LawTrial out;
  for (const char* law : laws) out.candidate.laws.push_back(bodies::find_law(law));
  out.by_block = {first, second}, out.gain = first + second;
  return out;
}

Comparison of(std::vector<LawTrial> singles, std::vector<LawTrial> pairs = {}) {
  static const BodyExperiment none;
  Comparison c;
  c.experiment = &none, c.nulls = std::vector<double>(49, 1.0);
  c.singles = std::move(singles), c.pairs = std::move(pairs);
  c.select();
  return c;
}

// All of the difference in one block makes its standard error as large as itself.
TEST(BodyVerdicts, aNameFarWorseThanAnUnnamedLawDoesNotLead) {
  const Comparison c = of({outcome({"curve_of_slip"}, 900, 50), outcome({"linear_drag"}, 21, 50)});
  EXPECT_EQ(c.reported->candidate.name(), "curve_of_slip");
  EXPECT_TRUE(c.alternatives().empty());
}

TEST(BodyVerdicts, aNameNearlyAsGoodAsAnUnnamedLawLeadsAndTheOtherIsListed) {
  const Comparison c = of({outcome({"curve_of_slip"}, 70, 40), outcome({"linear_drag"}, 57, 40)});
  EXPECT_EQ(c.reported->candidate.name(), "linear_drag");
  ASSERT_EQ(c.better_unnamed().size(), 1u);
  EXPECT_EQ(c.better_unnamed()[0]->candidate.name(), "curve_of_slip");
}

TEST(BodyVerdicts, aLawFarWorseThanTheReportedOneIsNoAlternative) {
  const Comparison c = of({outcome({"quadratic_drag"}, 150, 50), outcome({"dry_friction"}, 147, 48),
                           outcome({"linear_drag"}, 45, 50)});
  EXPECT_EQ(c.reported->candidate.name(), "quadratic_drag");
  ASSERT_EQ(c.alternatives().size(), 1u);
  EXPECT_EQ(c.alternatives()[0]->candidate.name(), "dry_friction");
}

// Two named laws are compared with the best named one, not with a better unnamed law.
TEST(BodyVerdicts, twoNamedLawsLeadWhereTheyAreBetterThanAnUnnamedOne) {
  const Comparison c = of(
      {outcome({"rotation"}, 80, 28), outcome({"linear_drag"}, 30, 27), outcome({"tide"}, 20, 10)},
      {outcome({"linear_drag", "tide"}, 100, 52), outcome({"linear_drag", "coriolis"}, 99, 50)});
  EXPECT_EQ(c.reported->candidate.name(), "linear_drag + tide");
  ASSERT_EQ(c.alternatives().size(), 1u);
}

// A null result keeps its warnings, and the noises are those of each axis.
TEST(BodyVerdicts, aNegativeDragOfTheBaselineIsWarnedOfThoughNothingIsMissing) {
  BodyExperiment e;
  e.name = "driven", e.baseline = {{"linear_drag", 0, true, {}}};
  const Acceleration force = [](const double*, const double* v, double* a) { a[0] = 0.7 * v[0]; };
  for (std::uint64_t r = 0; r < 3; ++r) {
    e.runs.push_back(run_of(force, {0}, {0.1 + 0.05 * double(r)}, 0.05, 60, 1e-3, 61 + r, 1));
  }
  const Diagnosis d = diagnosis_of(e);
  EXPECT_EQ(d.verdict, Verdict::complete) << diagnosis_text(d);
  EXPECT_NE(diagnosis_text(d).find("linear_drag comes out negative (-0.7"), std::string::npos)
      << diagnosis_text(d);
}

TEST(BodyVerdicts, theNoiseOfEachAxisIsReported) {
  BodyExperiment e;
  e.name = "axes", e.dimensions = 2;
  const Acceleration none = [](const double*, const double*, double* a) { a[0] = a[1] = 0; };
  for (std::uint64_t r = 0; r < 2; ++r) {
    BodyRun run = run_of(none, {0, 0}, {1, 0.3}, 0.1, 100, 2e-3, 71 + r, 1);
    for (std::size_t k = 0; k < run.samples(); ++k) {
      double& y = run.position[2 * k + 1];
      y += 24 * (y - 0.3 * run.time[k]);  // 5 cm
    }
    e.runs.push_back(std::move(run));
  }
  const Diagnosis d = diagnosis_of(e);
  double x = 0, y = 0;
  for (const MovedParameter& p : d.parameters) {
    if (p.path == "tracking noise of x") x = p.with_effects;
    if (p.path == "tracking noise of y") y = p.with_effects;
  }
  EXPECT_NEAR(x, 2e-3, 4e-4) << diagnosis_text(d);
  EXPECT_NEAR(y, 5e-2, 1e-2) << diagnosis_text(d);
}

// Two radians a sample: a single step of Runge and Kutta would dissipate, as a drag does.
TEST(BodyVerdicts, aSpringFastAgainstTheSamplesHasNoDrag) {
  BodyExperiment e;
  e.name = "fast", e.noise = 2e-3;
  const Acceleration force = [](const double* x, const double*, double* a) { a[0] = -400 * x[0]; };
  for (std::uint64_t r = 0; r < 2; ++r) {
    e.runs.push_back(run_of(force, {0.1}, {static_cast<double>(r)}, 0.1, 100, 2e-3, 31 + r, 1));
  }
  const Diagnosis d = diagnosis_of(e);
  ASSERT_EQ(d.findings.size(), 1u) << diagnosis_text(d);
  EXPECT_EQ(d.findings[0].effect, "linear_spring") << diagnosis_text(d);
  EXPECT_NEAR(d.findings[0].parameters.at(0).value, 400, 2) << diagnosis_text(d);
}

// Velocities that turn at `rate`, clockwise, beside f of 55 degrees.
Diagnosis turning_at(double rate) {
  BodyExperiment e;
  e.name = "turning", e.dimensions = 2, e.noise = 20, e.turning = 1.19e-4;
  const Acceleration force = [=](const double*, const double* v, double* a) {
    a[0] = rate * v[1], a[1] = -rate * v[0];
  };
  e.runs.push_back(run_of(force, {0, 0}, {0.3, 0.1}, 1800, 100, 20, 41, 1));
  e.runs.push_back(run_of(force, {0, 0}, {-0.1, -0.2}, 1800, 100, 20, 42, 1));
  return diagnosis_of(e);
}

TEST(BodyVerdicts, aRotationOfEitherSenseIsReportedWithItsRateBesideF) {
  for (const double rate : {-1.19e-4, 4e-4}) {
    const Diagnosis d = turning_at(rate);
    ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
    const DiagnosisFinding& f = d.findings.at(0);
    EXPECT_EQ(f.effect, "unnamed") << diagnosis_text(d);
    const FoundParameter& found = parameter(f, "rate of a free rotation, clockwise");
    EXPECT_LT(found.low, rate);
    EXPECT_GT(found.high, rate);
    EXPECT_LT(found.high - found.low, 2e-6);
    EXPECT_EQ(parameter(f, "f of the latitude, clockwise").value, 1.19e-4);
  }
}

TEST(BodyVerdicts, aTideOfTheOtherSenseIsATide) {
  const Diagnosis d = turning_at(-bodies::kTideRate);
  ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  EXPECT_EQ(d.findings.at(0).effect, "tide") << diagnosis_text(d);
  EXPECT_EQ(parameter(d.findings[0], "sense").value, -1);
}

}  // namespace
}  // namespace lilytank
