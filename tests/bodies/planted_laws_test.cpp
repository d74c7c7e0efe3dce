// Laws that are planted in simulated runs are named, with intervals that contain their numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bodies/simulated_runs.hpp"

namespace lilytank {
namespace {

// Allows for 95 % intervals of the fixed seeds that miss by a little.
void expect_near(const DiagnosisFinding& f, const std::string& name, double truth) {
  const FoundParameter& p = parameter(f, name);
  const double half = (p.high - p.low) / 2;
  EXPECT_NEAR(p.value, truth, 1.6 * half) << name;
  EXPECT_LT(half, 0.3 * std::fabs(truth)) << name;
}

// The first finding of a diagnosis, which is to be this effect.
DiagnosisFinding first_finding(const BodyExperiment& e, const std::string& effect) {
  const Diagnosis d = diagnosis_of(e);
  EXPECT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  if (d.findings.empty()) return {};
  EXPECT_EQ(d.findings.front().effect, effect) << diagnosis_text(d);
  return d.findings.front();
}

// Rayleigh and Helmholtz: from rest and from twice the speed, bodies end at 0.2 m/s.
TEST(PlantedLaws, BodiesThatDriveThemselvesAreNotDragged) {
  BodyExperiment e;
  e.name = "drivers", e.dimensions = 2, e.noise = 1e-3;
  const Acceleration force = [](const double*, const double* v, double* a) {
    const double by = 1.5 * (1 - (v[0] * v[0] + v[1] * v[1]) / 0.04);
    a[0] = by * v[0], a[1] = by * v[1];
  };
  e.runs = {run_of(force, {0, 0}, {0.03, 0.01}, 0.1, 40, 1e-3, 1, 1),
            run_of(force, {0, 0}, {-0.3, 0.25}, 0.1, 40, 1e-3, 2, 1),
            run_of(force, {0, 0}, {0.05, -0.1}, 0.1, 40, 1e-3, 3, 1)};
  const DiagnosisFinding f = first_finding(e, "self_propulsion");
  expect_near(f, "coefficient", 1.5);
  expect_near(f, "speed", 0.2);
}

// Two bodies on a line that stay about 0.1 m apart.
TEST(PlantedLaws, PairsThatKeepTheirDistanceAreNamed) {
  BodyExperiment e;
  e.name = "pairs", e.noise = 5e-4;
  const Acceleration force = [](const double* x, const double*, double* a) {
    const double u = std::exp(-(x[1] - x[0] - 0.1) / 0.04), f = 0.05 * (u - 1) * u;
    a[0] = -f, a[1] = f;
  };
  for (std::uint64_t r = 0; r < 3; ++r) {
    const double apart = 0.08 + 0.04 * static_cast<double>(r);
    e.runs.push_back(run_of(force, {0, apart}, {0.02, 0}, 0.05, 80, 5e-4, 10 + r, 2));
  }
  const DiagnosisFinding f = first_finding(e, "pair_morse");
  expect_near(f, "s", 0.1);
}

// Bodies that cross a round tank and turn at its wall.
TEST(PlantedLaws, AWallIsNamed) {
  BodyExperiment e;
  e.name = "tank", e.dimensions = 2, e.noise = 1e-3;
  const Acceleration force = [](const double* x, const double*, double* a) {
    const double r = std::hypot(x[0] - 0.05, x[1]), f = 0.2 * std::exp((r - 0.3) / 0.02) / r;
    a[0] = -f * (x[0] - 0.05), a[1] = -f * x[1];
  };
  for (std::uint64_t r = 0; r < 3; ++r) {
    const double angle = 0.7 + 2.0 * static_cast<double>(r);
    e.runs.push_back(run_of(force, {0.05, 0.02 * static_cast<double>(r)},
                            {0.1 * std::cos(angle), 0.1 * std::sin(angle)}, 0.1, 150, 1e-3, 20 + r,
                            1));
  }
  const DiagnosisFinding f = first_finding(e, "wall");
  expect_near(f, "range", 0.02);
  expect_near(f, "x0", 0.05);
}

// Flights with a spin of their own: the curvature of each, and what they have in common.
TEST(PlantedLaws, EveryFlightHasItsOwnLift) {
  BodyExperiment e;
  e.name = "flights", e.dimensions = 2, e.noise = 5e-3;
  e.coefficients = Coefficients::each_run;
  e.baseline = {{"gravity", 9.81, false, {}}};
  const std::vector<double> rates{0.5, -0.8, 1.2, 0.1};
  for (std::uint64_t r = 0; r < rates.size(); ++r) {
    const double w = rates[r];
    const Acceleration force = [w](const double*, const double* v, double* a) {
      a[0] = w * v[1], a[1] = -9.81 - w * v[0];
    };
    e.runs.push_back(run_of(force, {0, 1}, {12, 9}, 0.03, 60, 5e-3, 30 + r, 1));
  }
  const DiagnosisFinding f = first_finding(e, "spin_lift");
  int seen = 0;
  for (const FoundParameter& p : f.parameters) {
    if (p.path != "spin_lift.rate") continue;
    EXPECT_NEAR(p.value, rates[static_cast<std::size_t>(seen++)], 0.02) << p.name;
  }
  EXPECT_EQ(seen, 4);
}

// Noises are fitted for each of fourteen flights: a second law must not gain by leading to better
// ones. A report has the distribution of the rates instead of a line for each.
TEST(LongPlantedLaws, ManyFlightsHaveOneLawAndADistribution) {
  BodyExperiment e;
  e.name = "flights", e.dimensions = 2, e.noise = 5e-3;
  e.coefficients = Coefficients::each_run;
  e.baseline = {{"gravity", 9.81, true, {}}};
  for (std::uint64_t r = 0; r < 14; ++r) {
    const double w = normal_pair({7, Stream::camera, static_cast<std::int64_t>(r), 0, 0})[0];
    const Acceleration force = [w](const double*, const double* v, double* a) {
      a[0] = w * v[1], a[1] = -9.81 - w * v[0];
    };
    e.runs.push_back(run_of(force, {0, 1}, {12, 9}, 0.03, 60, 5e-3, 30 + r, 1));
  }
  const Diagnosis d = diagnosis_of(e);
  ASSERT_EQ(d.findings.size(), 1u) << diagnosis_text(d);
  EXPECT_EQ(d.findings[0].effect, "spin_lift") << diagnosis_text(d);
  const FoundParameter& between = parameter(d.findings[0], "rate, standard deviation between runs");
  EXPECT_LT(between.low, 1);
  EXPECT_GT(between.high, 1);
  EXPECT_EQ(d.findings[0].parameters.size(), 5u);
  EXPECT_LT(d.parameters.size(), 8u) << diagnosis_text(d);
}

// A drifter that is dragged, turned and pushed.
TEST(PlantedLaws, ThreeAtOnceAreAllNamed) {
  BodyExperiment e;
  e.name = "drifters", e.dimensions = 2, e.noise = 0.02, e.turning = 0.05;
  const Acceleration force = [](const double*, const double* v, double* a) {
    a[0] = 0.05 * v[1] - 0.02 * v[0] + 0.004, a[1] = -0.05 * v[0] - 0.02 * v[1];
  };
  for (std::uint64_t r = 0; r < 3; ++r) {
    const double angle = 2.0 * static_cast<double>(r);
    e.runs.push_back(run_of(force, {0, 0}, {0.5 * std::cos(angle), 0.5 * std::sin(angle)}, 1, 80,
                            0.02, 50 + r, 1));
  }
  const Diagnosis d = diagnosis_of(e);
  ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  ASSERT_EQ(d.findings.size(), 3u) << diagnosis_text(d);
  std::vector<std::string> names;
  for (const DiagnosisFinding& f : d.findings) names.push_back(f.effect);
  EXPECT_TRUE(has(names, "coriolis") && has(names, "linear_drag") && has(names, "constant_force"))
      << diagnosis_text(d);
  for (const DiagnosisFinding& f : d.findings) {
    if (f.effect == "linear_drag") expect_near(f, "coefficient", 0.02);
    EXPECT_GT(f.gain_low, 0) << f.effect;
  }
}

// Two bodies in a plane that move straight, beside two recorded drivers: all laws, pairs of laws
// and triples may be found by chance. Of 20 at five per cent, five alarms have a probability of 0.3
// %.
TEST(LongPlantedLaws, NoneIsNamedWhereNothingActs) {
  const Acceleration none = [](const double*, const double*, double* a) { std::fill_n(a, 4, 0.0); };
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    BodyExperiment e;
    e.name = "straight", e.dimensions = 2, e.drivers = {"voltage", "temperature"};
    for (std::int64_t r = 0; r < 2; ++r) {
      std::vector<double> v;
      for (std::uint32_t i = 0; i < 4; ++i) {
        v.push_back(0.1 * normal_pair({seed, Stream::start_pose, r, i, 0})[0]);
      }
      const std::uint64_t own = 1000 + 2 * seed + static_cast<std::uint64_t>(r);
      BodyRun run = run_of(none, {0, 0, 0.2, 0.3}, v, 0.1, 30, 2e-3, own, 2);
      for (const double t : run.time) {
        run.drivers.push_back(std::sin(3 * t + static_cast<double>(seed)));
        run.drivers.push_back(0.1 * t);
      }
      e.runs.push_back(std::move(run));
    }
    alarms += diagnosis_of(e).verdict == Verdict::complete ? 0 : 1;
  }
  EXPECT_LE(alarms, 4);
}

}  // namespace
}  // namespace lilytank
