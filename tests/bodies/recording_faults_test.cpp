// Faulty recordings of point bodies are reported as such, and no force is named.
#include <gtest/gtest.h>

#include "bodies/checks.hpp"
#include "bodies/simulated_runs.hpp"

namespace lilytank {
namespace {

// Three runs of a body that drifts in a plane.
BodyExperiment drift() {
  BodyExperiment e;
  e.name = "drift", e.dimensions = 2;
  const Acceleration none = [](const double*, const double*, double* a) { a[0] = a[1] = 0; };
  for (std::uint64_t r = 0; r < 3; ++r) {
    const double u = 1 - 0.4 * static_cast<double>(r);
    e.runs.push_back(run_of(none, {0, 0}, {u, 0.3}, 0.1, 100, 5e-3, 51 + r, 1));
  }
  return e;
}

// Kinds of faults, each with the runs that have it.
std::vector<std::string> faults_of(const BodyExperiment& e) {
  std::vector<std::string> out;
  for (const DiagnosisFinding& f : bodies::recording_faults(e)) out.push_back(f.effect);
  return out;
}

using Names = std::vector<std::string>;

TEST(BodyRecordingFaults, aSoundRecordingHasNone) {
  EXPECT_EQ(faults_of(drift()), Names{});
  // Bounces change velocities within a row.
  BodyExperiment e;
  const Acceleration wall = [](const double* x, const double*, double* a) {
    a[0] = x[0] > 1 ? -1e4 * (x[0] - 1) : x[0] < 0 ? -1e4 * x[0] : 0;
  };
  e.runs.push_back(run_of(wall, {0.5}, {1.3}, 0.05, 200, 1e-3, 5, 1));
  EXPECT_EQ(faults_of(e), Names{});
  // A body at rest, with the noise stated.
  const Acceleration none = [](const double*, const double*, double* a) { a[0] = 0; };
  BodyExperiment rest;
  rest.noise = 1e-3;
  rest.runs.push_back(run_of(none, {0.5}, {0}, 0.05, 200, 1e-3, 5, 1));
  EXPECT_EQ(faults_of(rest), Names{});
}

TEST(BodyRecordingFaults, shuffledRowsGiveNoForce) {
  BodyExperiment e = drift();
  for (BodyRun& run : e.runs) {
    const std::vector<double> before = run.position;
    for (std::size_t k = 0; k < run.samples(); ++k) {
      const std::size_t from = 37 * (k + k * k) % 101 % 100;
      run.position[2 * k] = before[2 * from], run.position[2 * k + 1] = before[2 * from + 1];
    }
  }
  const Diagnosis d = diagnosis_of(e);
  EXPECT_EQ(d.verdict, Verdict::measurement);
  ASSERT_EQ(d.findings.size(), 1u);
  EXPECT_EQ(d.findings[0].effect, "row order");
  EXPECT_NE(diagnosis_text(d).find("forces were not tested"), std::string::npos);
}

TEST(BodyRecordingFaults, jumpsRepeatsStuckAxesAndRepeatedRunsAreFound) {
  BodyExperiment jump = drift();
  for (std::size_t k = 60; k < 100; ++k) jump.runs[1].position[2 * k] += 0.8;
  EXPECT_EQ(faults_of(jump), Names{"position jumps"});

  BodyExperiment repeats = drift();
  for (std::size_t k = 4; k < 100; k += 5) {
    for (std::size_t i = 0; i < 2; ++i) {
      repeats.runs[0].position[2 * k + i] = repeats.runs[0].position[2 * k - 2 + i];
    }
  }
  EXPECT_EQ(faults_of(repeats), Names{"repeated rows"});

  BodyExperiment stuck = drift();
  for (std::size_t k = 0; k < 100; ++k) stuck.runs[2].position[2 * k + 1] = 0.3;
  EXPECT_EQ(faults_of(stuck), Names{"stuck axis"});

  BodyExperiment twice = drift();
  twice.runs.push_back(twice.runs[0]);
  EXPECT_EQ(faults_of(twice), Names{"repeated run"});
}

}  // namespace
}  // namespace lilytank
