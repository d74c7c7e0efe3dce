// What the base station says to the modules by radio, and how it sets the pumps.
#pragma once
#include <array>
#include <vector>

#include "control/tick.hpp"

namespace lilytank {

/// Speaks once a tick: commands whose time has come, then feedback. All that it knows of the
/// modules are the labels that they report.
class BaseStation {
 public:
  explicit BaseStation(const Model& model);
  /// Carries out the commands that are due in this tick, in their order, then chooses ruleset and
  /// flow by the number of finished copies.
  void speak(Tick& tick) const;
  /// Copies of the target that are finished, by the labels of the final joins of the ruleset in
  /// force; of several final joins the one that was made least often counts.
  int finished_copies(const State& state) const;

 private:
  void obey(Tick& tick, int index) const;
  void follow_copies(Tick& tick) const;

  const Model* model_;
  bool sets_ruleset_ = false, sets_pumps_ = false;             // by feedback
  std::vector<std::vector<std::array<int, 2>>> final_labels_;  // [ruleset]
};

}  // namespace lilytank
