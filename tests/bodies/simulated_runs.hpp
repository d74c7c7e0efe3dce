// Runs of point bodies with known accelerations, and their diagnosis.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>

#include "lilytank/bodies.hpp"
#include "lilytank/random.hpp"

namespace lilytank {

using Acceleration = std::function<void(const double* x, const double* v, double* a)>;

// A run of bodies with these accelerations, seen with noise.
inline BodyRun run_of(const Acceleration& force, std::vector<double> x, std::vector<double> v,
                      double dt, int samples, double noise, std::uint64_t seed,
                      std::size_t bodies) {
  constexpr int kParts = 50;
  BodyRun run;
  run.name = "run " + std::to_string(seed);
  run.mass.assign(bodies, 1), run.radius.assign(bodies, 0);
  for (std::size_t b = 0; b < bodies; ++b) run.bodies.push_back("body");
  std::vector<double> a(x.size());
  for (int k = 0; k < samples; ++k) {
    run.time.push_back(k * dt);
    for (std::size_t i = 0; i < x.size(); ++i) {
      run.position.push_back(x[i] + noise * normal_pair({seed, Stream::camera, k,
                                                         static_cast<std::uint32_t>(i), 0})[0]);
    }
    for (int part = 0; part < kParts; ++part) {
      // Midpoint rule.
      const double h = dt / kParts;
      std::vector<double> xm = x, vm = v;
      force(x.data(), v.data(), a.data());
      for (std::size_t i = 0; i < x.size(); ++i) xm[i] += h / 2 * v[i], vm[i] += h / 2 * a[i];
      force(xm.data(), vm.data(), a.data());
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += h * vm[i], v[i] += h * a[i];
    }
  }
  return run;
}

// Three falls from rest, from a little throw and from a harder one.
inline BodyExperiment falls(double linear, double quadratic, double noise, std::uint64_t seed) {
  BodyExperiment e;
  e.name = "falls", e.noise = noise;
  e.baseline = {{"gravity", 9.81, false, {}}};
  const Acceleration force = [=](const double*, const double* v, double* a) {
    a[0] = -9.81 - linear * v[0] - quadratic * std::fabs(v[0]) * v[0];
  };
  for (int r = 0; r < 3; ++r) {
    e.runs.push_back(run_of(force, {50}, {-6.0 * r}, 0.08, 28, noise,
                            100 * seed + static_cast<std::uint64_t>(r), 1));
  }
  return e;
}

inline Diagnosis diagnosis_of(const BodyExperiment& e, double false_alarms = 0.05) {
  DiagnosisOptions options;
  options.minutes = 2, options.false_alarms = false_alarms;
  return diagnose_bodies(e, options);
}

inline bool has(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// A parameter of a finding.
inline const FoundParameter& parameter(const DiagnosisFinding& f, const std::string& name) {
  for (const FoundParameter& p : f.parameters) {
    if (p.name == name) return p;
  }
  throw std::runtime_error("no parameter " + name);
}

}  // namespace lilytank
