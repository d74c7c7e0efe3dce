// Which effects recordings of a prepared tank show.
#pragma once
#include <string>
#include <vector>

#include "finder/prepared_tank.hpp"

namespace lilytank {

/// The vector of an experiment, and what a verdict needs beside it.
struct MeasuredVectors {
  Vectors observed;
  ScoreDetails details;
};

/// What recordings show, before anything is fitted to them.
struct Judged {
  std::vector<Recording> recordings;
  Vectors observed;
  ScoreDetails details;
  SelectedModel selected;
  /// Effects of which each alone may be the strongest finding (report_selection).
  std::vector<EffectFit> open;
  std::string tag;  ///< for the names of what is kept of these recordings
};

/// Adds to `out` which effects recordings of the tank show: verdict, findings, maps, ranking,
/// smallest detectable sizes. The recordings are of the same kind as the setup's. Throws Stopped.
Judged judge(PreparedTank& tank, const std::vector<Recording>& recordings, Diagnosis& out);
/// The same where their vectors are known already.
Judged judge(PreparedTank& tank, MeasuredVectors measured, const std::vector<Recording>& recordings,
             Diagnosis& out);

}  // namespace lilytank
