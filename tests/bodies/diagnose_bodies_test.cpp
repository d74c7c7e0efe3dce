// Does the finder for point bodies name what was planted, keep quiet where nothing was, and say so
// where data cannot tell?
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>

#include "bodies/simulated_runs.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

TEST(DiagnoseBodies, namesQuadraticDragWhereNoiseIsSmall) {
  const Diagnosis d = diagnosis_of(falls(0, 0.02, 1e-3, 1));
  ASSERT_EQ(d.verdict, Verdict::missing);
  ASSERT_EQ(d.findings.size(), 1u);
  const DiagnosisFinding& f = d.findings.front();
  EXPECT_EQ(f.effect, "quadratic_drag");
  EXPECT_FALSE(has(f.alternatives, "linear_drag"));
  EXPECT_LT(f.parameters.at(0).low, 0.0202);
  EXPECT_GT(f.parameters.at(0).high, 0.0198);
  EXPECT_GT(f.gain, 20);
}

TEST(DiagnoseBodies, namesLinearDragWhereNoiseIsSmall) {
  const Diagnosis d = diagnosis_of(falls(0.25, 0, 1e-3, 2));
  ASSERT_FALSE(d.findings.empty());
  EXPECT_EQ(d.findings.front().effect, "linear_drag");
  EXPECT_FALSE(has(d.findings.front().alternatives, "quadratic_drag"));
}

TEST(DiagnoseBodies, tellsBothDragsWhereNoiseHidesTheDifference) {
  const Diagnosis d = diagnosis_of(falls(0, 0.008, 0.15, 3));
  ASSERT_FALSE(d.findings.empty());
  std::vector<std::string> all = d.findings.front().alternatives;
  all.push_back(d.findings.front().effect);
  EXPECT_TRUE(has(all, "linear_drag"));
  EXPECT_TRUE(has(all, "quadratic_drag"));
}

// A body of which no run is held out says nothing of whether it feels the law.
TEST(DiagnoseBodies, bodiesOfWhichNothingIsHeldOutAreNotAsked) {
  BodyExperiment e = falls(0, 0.02, 1e-3, 1);
  const BodyExperiment more = falls(0, 0.02, 1e-3, 2);
  e.runs.insert(e.runs.end(), more.runs.begin(), more.runs.end());
  e.coefficients = Coefficients::each_body;
  for (std::size_t r = 0; r < e.runs.size(); ++r) {
    e.runs[r].bodies = {r < 3 ? "P" : "Q"}, e.runs[r].held_out = r == 2;
  }
  const Diagnosis d = diagnosis_of(e);
  ASSERT_EQ(d.verdict, Verdict::missing);
  EXPECT_EQ(d.findings.at(0).text,
            "seen in P; not tested, because none of their runs is held out: Q");
}

// The drag of five balls falls with the square of their radius.
TEST(DiagnoseBodies, tellsHowACoefficientGrowsWithTheRadius) {
  BodyExperiment e;
  for (int body = 0; body < 5; ++body) {
    const double radius = 0.02 * std::pow(1.3, body);
    BodyExperiment one = falls(2e-4 / (radius * radius), 0, 2e-3, 10 + body);
    for (BodyRun& run : one.runs) run.bodies = {std::to_string(body)}, run.radius = {radius};
    one.runs.insert(one.runs.begin(), e.runs.begin(), e.runs.end());
    e = std::move(one);
  }
  e.coefficients = Coefficients::each_body;
  const Diagnosis d = diagnosis_of(e);
  ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  ASSERT_EQ(d.findings.at(0).effect, "linear_drag") << diagnosis_text(d);
  const FoundParameter& p = parameter(d.findings[0], "coefficient, exponent over the radius");
  EXPECT_LT(p.low, -2);
  EXPECT_GT(p.high, -2);
  EXPECT_LT(p.high - p.low, 1);
}

// Runs that are not held out have no part in what is compared, not even as zeros.
TEST(DiagnoseBodies, oneHeldOutRunTellsAsWell) {
  BodyExperiment e = falls(0.3, 0, 2e-3, 3);
  e.runs.back().held_out = true;
  const Diagnosis d = diagnosis_of(e);
  EXPECT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  ASSERT_FALSE(d.findings.empty());
  EXPECT_GT(d.findings[0].gain_low, 0);
}

// Nothing would be left to fit to, and a gain over the very data of the fit says nothing.
TEST(DiagnoseBodies, allRunsHeldOutAreRefused) {
  BodyExperiment e = falls(0.3, 0, 2e-3, 3);
  e.name = "falls";
  for (BodyRun& run : e.runs) run.held_out = true;
  try {
    diagnosis_of(e);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& refused) {
    EXPECT_STREQ(refused.what(),
                 "experiment falls: every recording is held out: none is left to fit a law to");
  }
}

// Forty complete experiments at five per cent: seven alarms or more have a probability of 0.3 %.
int false_alarms(std::uint64_t experiments) {
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < experiments; ++seed) {
    BodyExperiment e = falls(0, 0, 0.02, 50 + seed);
    for (BodyRun& run : e.runs) {
      run.time.resize(14), run.position.resize(14);
    }
    if (diagnosis_of(e).verdict != Verdict::complete) ++alarms;
  }
  return alarms;
}

// At 5 % a fair test fails once in 400 times.
TEST(DiagnoseBodies, keepsItsRateOfFalseAlarms) {
  EXPECT_LE(false_alarms(20), 4);
}

TEST(LongDiagnoseBodies, keepsItsRateOfFalseAlarms) {
  EXPECT_LE(false_alarms(40), 6);
}

TEST(DiagnoseBodies, seesThatBodiesActAtADistance) {
  BodyExperiment e;
  e.name = "gliders", e.noise = 1e-3, e.baseline = {{"contact", 1, false, {}}};
  const Acceleration force = [](const double* x, const double*, double* a) {
    const double f = 4e-7 / std::pow(x[1] - x[0], 4);
    a[0] = -f, a[1] = f;
  };
  for (std::uint64_t r = 0; r < 2; ++r) {
    e.runs.push_back(run_of(force, {0, 0.3}, {0.2 + 0.1 * static_cast<double>(r), -0.1}, 0.03, 60,
                            1e-3, 7 + r, 2));
  }
  const Diagnosis d = diagnosis_of(e);
  ASSERT_EQ(d.verdict, Verdict::missing);
  EXPECT_EQ(d.findings.front().variable, "pair");
  std::vector<std::string> all = d.findings.front().alternatives;
  all.push_back(d.findings.front().effect);
  EXPECT_TRUE(has(all, "pair_dipoles") || has(all, "pair_power_law"));
}

// Where the tide's period is not the latitude's, the two are told apart; at 74.5 degrees it is.
TEST(DiagnoseBodies, turningIsCoriolisOnlyWhereTheTideIsElsewhere) {
  for (const bool alike : {false, true}) {
    BodyExperiment e;
    e.name = "drift", e.dimensions = 2, e.noise = 5;
    e.turning = alike ? 2 * 3.14159265358979 / (12.4206 * 3600) : 1.117e-4;  // or 50 degrees
    const Acceleration force = [&](const double*, const double* v, double* a) {
      a[0] = e.turning * v[1], a[1] = -e.turning * v[0];
    };
    // Twice: one circle alone might be a spring's.
    e.runs.push_back(run_of(force, {0, 0}, {0.3, 0.1}, 1800, 80, 5, 5, 1));
    e.runs.push_back(run_of(force, {0, 0}, {-0.1, -0.2}, 1800, 80, 5, 6, 1));
    const Diagnosis d = diagnosis_of(e);
    ASSERT_EQ(d.verdict, Verdict::missing);
    std::vector<std::string> all = d.findings.front().alternatives;
    all.push_back(d.findings.front().effect);
    EXPECT_TRUE(has(all, "coriolis")) << diagnosis_text(d);
    EXPECT_EQ(has(all, "tide"), alike) << diagnosis_text(d);
  }
}

// Buoys that drift straight, fixed every `step` seconds with 100 m of noise.
BodyExperiment straight_drift(double step, int samples) {
  BodyExperiment e;
  e.name = "buoys", e.dimensions = 2;
  const Acceleration none = [](const double*, const double*, double* a) { a[0] = a[1] = 0; };
  e.runs.push_back(run_of(none, {0, 0}, {0.3, 0.1}, step, samples, 100, 11, 1));
  e.runs.push_back(run_of(none, {0, 0}, {0.2, -0.2}, step, samples, 100, 12, 1));
  return e;
}

// Hours or a day between fixes are as long as the tide's period.
TEST(DiagnoseBodies, fixesHoursApartOfAStraightDriftAreComplete) {
  for (const double hours : {6, 24}) {
    const Diagnosis d = diagnosis_of(straight_drift(3600 * hours, 40));
    EXPECT_EQ(d.verdict, Verdict::complete) << diagnosis_text(d);
  }
}

// 60 days apart the tide cannot be integrated from fix to fix; other laws are judged without it.
TEST(DiagnoseBodies, lawsWithoutAFitAreNotEvaluatedAndNamed) {
  const Diagnosis d = diagnosis_of(straight_drift(60 * 86400.0, 20));
  EXPECT_NE(d.verdict, Verdict::missing) << diagnosis_text(d);
  const std::string text = diagnosis_text(d);
  EXPECT_NE(text.find("not evaluated: tide gives no finite predictions from any start: samples are "
                      "5.18e+06 s apart"),
            std::string::npos)
      << text;
  for (const RankedEffect& r : d.ranking) EXPECT_EQ(r.effect.find("tide"), std::string::npos);
  for (const Detectable& one : d.detectable) EXPECT_NE(one.effect, "tide");
}

TEST(DiagnoseBodies, aBaselineThatTurnsOnALineIsRefused) {
  BodyExperiment e = falls(0, 0, 0.02, 1);
  e.baseline = {{"tide", 1, false, {"e.toml", 3, 1}}};
  try {
    diagnosis_of(e);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& refused) {
    EXPECT_STREQ(refused.what(), "e.toml:3:1: tide turns velocities, which takes two dimensions");
  }
}

// Loops of the tide over a straight drift, three hours between fixes, noise not given: the drift
// alone with noise of the loops' size fits well, and the tide with the tracker's noise better.
TEST(DiagnoseBodies, loopsAreNotTakenForNoise) {
  constexpr double kTurn = 2 * 3.14159265358979 / (12.4206 * 3600);
  BodyExperiment e;
  e.name = "loops", e.dimensions = 2;
  const double u[2] = {0.15, -0.1};
  for (std::uint64_t r = 0; r < 2; ++r) {
    const double loop = r == 0 ? 0.25 : -0.3;
    const Acceleration turning = [&](const double*, const double* v, double* a) {
      a[0] = kTurn * (v[1] - u[1]), a[1] = -kTurn * (v[0] - u[0]);
    };
    e.runs.push_back(run_of(turning, {0, 0}, {u[0] + loop, u[1]}, 3 * 3600, 80, 50, 21 + r, 1));
  }
  const Diagnosis d = diagnosis_of(e);
  ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  EXPECT_EQ(d.findings.front().variable, "turn");
  EXPECT_GT(d.msd_removed, 0.8) << diagnosis_text(d);
  EXPECT_GT(d.msd_floor, 40 * 40);
  EXPECT_LT(d.msd_floor, 60 * 60);
}

TEST(DiagnoseBodies, sameSeedSameReport) {
  const BodyExperiment e = falls(0, 0.02, 0.02, 4);
  EXPECT_EQ(diagnosis_json(diagnosis_of(e)), diagnosis_json(diagnosis_of(e)));
}

// What is left of a run is every third row, its drivers with it.
TEST(BodyExperiment, takesEveryThirdRow) {
  const TemporaryDirectory here;
  {
    std::ofstream table(here.path("t.csv"));
    table << "t,h,wind\n";
    for (int k = 0; k < 31; ++k) table << 0.1 * k << "," << k * k << "," << -k << "\n";
    std::ofstream(here.path("e.toml"))
        << "[experiment]\nbody = \"point\"\n[[recording]]\nfile = \"t.csv\"\ntime = \"t\"\n"
           "x = \"h\"\ndrivers = [\"wind\"]\nevery = 3\n";
  }
  const BodyExperiment e = load_body_experiment(here.path("e.toml"));
  ASSERT_EQ(e.runs.size(), 1u);
  const BodyRun& run = e.runs[0];
  ASSERT_EQ(run.time.size(), 11u);
  for (std::size_t k = 0; k < run.time.size(); ++k) {
    const auto row = static_cast<double>(3 * k);
    EXPECT_NEAR(run.time[k] - run.time[0], 0.1 * row, 1e-12);
    EXPECT_EQ(run.position[k], row * row);
    EXPECT_EQ(run.drivers[k], -row);
  }
}

// Stopped among its simulated baselines, it goes on to the report that it would have given.
TEST(DiagnoseBodies, goesOnWhereItWasStopped) {
  const TemporaryDirectory here;
  const BodyExperiment e = falls(0, 0.02, 0.02, 4);
  std::atomic<bool> stop = false;
  DiagnosisOptions options;
  options.minutes = 2, options.false_alarms = 0.05;
  options.out = here.path("d"), options.stop = &stop;
  options.progress = [&](double done, const std::string&) { stop = done > 0.7; };
  ASSERT_THROW(diagnose_bodies(e, options), Stopped);
  stop = false;
  int steps = 0;
  options.progress = [&](double done, const std::string&) { steps += done > 0.6 ? 1 : 0; };
  EXPECT_EQ(diagnosis_json(diagnose_bodies(e, options)), diagnosis_json(diagnosis_of(e)));
  EXPECT_LT(steps, 10);  // of its ten baselines some were kept
}

// A group that was as good as chance before counts for nothing.
TEST(Diagnosis, shareRemovedIsOfWhatIsBeyondChance) {
  Diagnosis d;
  d.held_out = {{"motion", 9, 1.5}, {"contacts", 3, 1.5}, {"spin", 0.9, 1}};
  EXPECT_DOUBLE_EQ(d.removed(), 0.9);
  EXPECT_DOUBLE_EQ(d.held_out[0].removed(), 1 - 0.5 / 8);
  EXPECT_EQ(d.held_out[2].removed(), 0);
  EXPECT_TRUE(std::isnan(Diagnosis{}.removed()));
  // Where experiments told how chance scatters, what is within three deviations of it is not clear.
  d.held_out = {{"motion", 9, 1.5, 1.2, 0.4}, {"turning", 3, 5, 1.1, 0.9}};
  EXPECT_FALSE(d.held_out[1].clear());
  EXPECT_DOUBLE_EQ(d.removed(), 1 - 0.3 / 7.8);
}

TEST(DiagnoseBodies, realGlidersActAtADistanceByALawThatIsNotIdentified) {
  const Diagnosis d = diagnosis_of(
      load_body_experiment(LILYTANK_SOURCE_DIR "/scenarios/experiments/real/gliders.toml"));
  ASSERT_EQ(d.verdict, Verdict::missing);
  EXPECT_EQ(d.findings.front().variable, "pair");
  EXPECT_GE(d.findings.front().alternatives.size(), 2u);
}

TEST(DiagnoseBodies, realDropsHaveDragByALawThatIsNotIdentified) {
  const Diagnosis d = diagnosis_of(
      load_body_experiment(LILYTANK_SOURCE_DIR "/scenarios/experiments/real/drops.toml"));
  ASSERT_EQ(d.verdict, Verdict::missing);
  const DiagnosisFinding& f = d.findings.front();
  EXPECT_EQ(f.variable, "slip");
  EXPECT_TRUE(has(f.alternatives, "quadratic_drag") || f.effect == "quadratic_drag");
  EXPECT_NE(f.text.find("Whiffle_Ball_1"), std::string::npos);
  EXPECT_GT(f.text.find("Bowling_Ball"), f.text.find("not in"));
  ASSERT_FALSE(d.warnings.empty());
  EXPECT_NE(d.warnings.front().find("suspect the measurement"), std::string::npos);
}

TEST(BodyExperiment, refusesWhatItCannotUseInOneLineWithThePlace) {
  const TemporaryDirectory here;
  const std::string head = "[experiment]\nbody = \"point\"\n";
  const std::string rec = "[[recording]]\nfile = \"t.csv\"\ntime = \"t\"\nx = \"h\"\n";
  const struct {
    std::string toml, message;
  } cases[] = {
      {head + "[baseline]\ngravty = 9.81\n" + rec, "did you mean 'gravity'"},
      {head + "[baseline]\ngravity = \"free\"\n" + rec, "neither a number nor \"fit\""},
      {head + "[[recording]]\nfile = \"t.csv\"\ntime = \"t\"\nx = \"hh\"\n",
       "t.csv has no column 'hh'"},
      {head + "noise = \"2 s\"\n" + rec, "noise"},
      {head, "there is no [[recording]]"},
      {"[experiment]\nbody = \"point\"\ndimensions = 3\n" + rec, "dimensions"},
      {head + rec + "mass = -1\n", "mass"},
      {head + rec + "hold = 1\n", "unknown key"},
  };
  {
    std::ofstream table(here.path("t.csv"));
    table << "t,h\n";
    for (int k = 0; k < 12; ++k) table << 0.1 * k << "," << k * k << "\n";
  }
  for (const auto& c : cases) {
    std::ofstream(here.path("e.toml")) << c.toml;
    try {
      load_body_experiment(here.path("e.toml"));
      ADD_FAILURE() << c.toml;
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find(c.message), std::string::npos) << what;
      EXPECT_NE(what.find("e.toml:"), std::string::npos) << what;
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    }
  }
}

}  // namespace
}  // namespace lilytank
