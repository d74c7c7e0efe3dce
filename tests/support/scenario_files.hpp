// Scenario files in a temporary directory, what they load as and why they are refused.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "lilytank/scenario.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank::test {

using Texts = std::vector<std::string>;

class ScenarioTest : public testing::Test {
 protected:
  /// Loads one file of this content.
  Scenario load(const std::string& content, const Texts& sets = {}) const {
    return load_scenario({dir_.write("s.toml", content)}, sets);
  }
  std::string refusal(const std::string& content, const Texts& sets = {}) const {
    try {
      load(content, sets);
    } catch (const InputError& e) {
      // Without the temporary directory's name.
      std::string what = e.what();
      for (auto at = what.find(dir_.path()); at != std::string::npos; at = what.find(dir_.path())) {
        what.erase(at, dir_.path().size());
      }
      return what;
    }
    return "(accepted)";
  }
  static const ScenarioEntry& entry(const Scenario& scenario, const std::string& path) {
    const auto found = std::find_if(scenario.entries.begin(), scenario.entries.end(),
                                    [&](const ScenarioEntry& e) { return e.path == path; });
    EXPECT_NE(found, scenario.entries.end()) << path;
    return *found;
  }
  static double parameter(const Scenario& scenario, const std::string& term, std::size_t i) {
    for (const ActiveForce& force : scenario.model.forces) {
      if (force.term->name() == term) return force.p.at(i);
    }
    ADD_FAILURE() << term << " is not on";
    return 0;
  }
  static bool is_on(const Scenario& scenario, const std::string& term) {
    return std::any_of(scenario.model.forces.begin(), scenario.model.forces.end(),
                       [&](const ActiveForce& force) { return force.term->name() == term; });
  }
  TemporaryDirectory dir_;
};

inline const std::string kRules =
    "lilytank ruleset 1\nname pair\nhops counter-clockwise\ntarget\n  ##\nend\n"
    "join: (0,0) (0,0) -> (1,1)-(2,1)  p=1\npart: (1,1)-(2,1) -> (0,0) (0,0)  p=0.5\n";

}  // namespace lilytank::test
