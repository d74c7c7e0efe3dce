// Files of optimisations over tiny scenarios, what they are read as and how they end.
#pragma once
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "io/atomic_file.hpp"
#include "lilytank/optimize.hpp"
#include "support/study_rig.hpp"

namespace lilytank::test {

inline const std::string kHead = "[optimize]\nscenario = \"pair.toml\"\n";
inline const std::string kPart = "[[parameter]]\npath = \"rules.part.p\"\nlow = 0.001\nhigh = 1\n";
inline const std::string kSearch = "evaluations = 24\npopulation = 4\nfinal_evaluations = 6\n";

struct OptimizeRig : StudyRig {
  Optimization read(const std::string& text, const std::vector<std::string>& sets = {}) const {
    return Optimization(here.write("optimize.toml", text), {}, sets);
  }
  std::string refused(const std::string& text, const std::vector<std::string>& sets = {}) const {
    return refusal_of([&] { read(text, sets); });
  }
};

inline std::string all_of(const std::string& dir, const std::vector<std::string>& files) {
  std::string out;
  for (const std::string& file : files) {
    const std::string path = dir + "/" + file;
    out += std::filesystem::exists(path) ? read_whole(path) : "(absent)";
  }
  return out;
}

/// Runs it whole by two threads, then stopped again and again by one, and expects the same files.
inline OptimizationResult expect_same_files(const OptimizeRig& rig, const std::string& text,
                                            const std::vector<std::string>& files) {
  OptimizationOptions options;
  options.threads = 2;
  options.out = rig.here.path("whole");
  run_optimization(rig.read(text), options);
  const std::string whole = all_of(options.out, files);
  EXPECT_EQ(whole.find("(absent)"), std::string::npos);
  options.out = rig.here.path("parts");
  std::atomic<bool> stop{false};
  options.stop = &stop;
  options.threads = 1;
  std::optional<OptimizationResult> result;
  for (int calls = 0; !result && calls < 60; ++calls) {
    stop = false;
    int told = 0;  // of a race what is done already is told again
    options.progress = [&](double, const std::string&) {
      if (++told > calls / 2) stop = true;
    };
    try {
      result = run_optimization(rig.read(text), options);
    } catch (const Stopped&) {
    }
  }
  EXPECT_EQ(all_of(options.out, files), whole);
  return result.value_or(OptimizationResult{});
}

}  // namespace lilytank::test
