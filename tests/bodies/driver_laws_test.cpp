// Forces by what was recorded beside the bodies: at once, later, by the square or the amplitude.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "bodies/driver_history.hpp"
#include "bodies/simulated_runs.hpp"

namespace lilytank {
namespace {

using Signal = double (*)(double time, double phase);

// A cart that is pushed for so many frames while two drivers are recorded, of which the voltage is
// the first.
Diagnosis pushed_by(Signal force, Signal voltage, int frames) {
  BodyExperiment e;
  e.name = "pushed", e.noise = 1e-3, e.drivers = {"voltage", "temperature"};
  for (std::uint64_t r = 1; r <= 2; ++r) {
    BodyRun run;
    run.name = std::to_string(r), run.bodies = {"cart"}, run.mass = {1}, run.radius = {0};
    double x = 0, v = 0;
    for (int k = 0; k < frames; ++k) {
      const double h = 0.1, t = h * k, phase = static_cast<double>(r), a = force(t, phase);
      run.time.push_back(t);
      run.position.push_back(x + 1e-3 * normal_pair({r, Stream::camera, k, 0, 0})[0]);
      run.drivers.push_back(voltage(t, phase)), run.drivers.push_back(std::cos(t + phase));
      x += h * v + 0.5 * h * h * a, v += h * a;
    }
    e.runs.push_back(run);
  }
  return diagnosis_of(e);
}

double steady(double time, double phase) {
  return std::sin(2 * time + phase);
}
Diagnosis steadily_pushed_by(Signal force) {
  return pushed_by(force, steady, 60);
}

TEST(Drivers, HaveTheirNamesInTheReport) {
  const Diagnosis d =
      steadily_pushed_by([](double t, double phase) { return 0.3 * steady(t, phase); });
  ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  const DiagnosisFinding& f = d.findings.front();
  EXPECT_EQ(f.effect, "driver_1") << diagnosis_text(d);
  EXPECT_EQ(f.text, "by voltage");
  EXPECT_EQ(f.parameters[0].name, "voltage");
  EXPECT_NEAR(f.parameters[0].value, 0.3, 0.02);
}

TEST(Drivers, ActByTheirSquare) {
  const Diagnosis d = steadily_pushed_by(
      [](double t, double phase) { return 0.3 * std::pow(steady(t, phase), 2); });
  ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  const DiagnosisFinding& f = d.findings.front();
  EXPECT_EQ(f.effect, "driver_1_squared") << diagnosis_text(d);
  EXPECT_NEAR(f.parameters[0].value, 0.3, 0.02);
}

// Amplitude and value of a voltage that oscillates and swells.
double amplitude(double time, double phase) {
  return 1 + 0.6 * std::sin(0.3 * time + 2 * phase);
}

double voltage(double time, double phase) {
  return amplitude(time, phase) * std::sin(2 * time + phase);
}

Diagnosis pushed_by(Signal force) {
  return pushed_by(force, voltage, 200);
}

TEST(Drivers, ActAtOnceWhereALagIsPossible) {
  const Diagnosis d = pushed_by([](double t, double phase) { return 0.3 * voltage(t, phase); });
  ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  const DiagnosisFinding& f = d.findings.front();
  EXPECT_EQ(f.effect, "driver_1") << diagnosis_text(d);
  EXPECT_EQ(f.text, "by voltage");
  EXPECT_EQ(f.parameters[0].name, "voltage");
  EXPECT_NEAR(f.parameters[0].value, 0.3, 0.02);
  // Without a lag, the law with one is no alternative.
  EXPECT_EQ(std::ranges::count(f.alternatives, "driver_1_lagged"), 0) << diagnosis_text(d);
}

TEST(Drivers, ActByTheSquareOfAnOscillation) {
  const Diagnosis d =
      pushed_by([](double t, double phase) { return 0.3 * std::pow(voltage(t, phase), 2); });
  ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  const DiagnosisFinding& f = d.findings.front();
  EXPECT_EQ(f.effect, "driver_1_squared") << diagnosis_text(d);
  EXPECT_NEAR(f.parameters[0].value, 0.3, 0.02);
}

TEST(Drivers, ActLater) {
  const Diagnosis d =
      pushed_by([](double t, double phase) { return 0.3 * voltage(t - 0.55, phase); });
  ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  const DiagnosisFinding& f = d.findings.front();
  EXPECT_EQ(f.effect, "driver_1_lagged") << diagnosis_text(d);
  EXPECT_NEAR(f.parameters[0].value, 0.3, 0.03);
  EXPECT_EQ(f.parameters[1].name, "lag");
  EXPECT_LT(f.parameters[1].low, 0.6);
  EXPECT_GT(f.parameters[1].high, 0.5);
}

TEST(Drivers, ActByTheirAmplitude) {
  const Diagnosis d = pushed_by([](double t, double phase) { return 0.3 * amplitude(t, phase); });
  ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  EXPECT_EQ(d.findings.front().effect, "driver_1_envelope") << diagnosis_text(d);
}

TEST(Drivers, AreKnownBetweenSamples) {
  BodyRun run;
  for (int k = 0; k < 400; ++k) {
    run.time.push_back(0.05 * k), run.drivers.push_back(3 + 2 * std::sin(4 * 0.05 * k));
  }
  EXPECT_DOUBLE_EQ(bodies::driver_at(run, 0, -1), run.drivers.front());
  EXPECT_DOUBLE_EQ(bodies::driver_at(run, 0, 50), run.drivers.back());
  EXPECT_NEAR(bodies::driver_at(run, 0, 0.075), (run.drivers[1] + run.drivers[2]) / 2, 1e-12);
  const double period = bodies::period_of({&run}, 0);
  EXPECT_NEAR(period, std::numbers::pi / 2, 0.05 * period);  // 25 or 26 crossings in 20 s
  EXPECT_NEAR(bodies::amplitude_at(run, 0, 12, 2 * period), 2, 0.1);
  EXPECT_NEAR(bodies::amplitude_at(run, 0, 0, 2 * period), 2, 0.1);
}

}  // namespace
}  // namespace lilytank
