// What `lilytank analyze` is given: runs, experiments and recordings, as sources of an analysis.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "lilytank/analysis.hpp"

namespace lilytank::cli {

/// How sources are read.
struct SourceOptions {
  std::optional<BodyKind> body;      ///< only these; not given: all kinds there are
  std::vector<std::string> names;    ///< in the order of the words
  std::string label, panel;          ///< scenario keys whose values name runs, and their plots
  double from = 0, to = -1;          ///< s of a recording's clock that count; to < 0: all
  double tank_radius = 0, size = 0;  ///< m, of recordings without experiment; 0: the defaults
};

/// The sources that a word of the command line names: a run's directory, an experiment's TOML file,
/// or a recording. Sources of one name, panel and kind of body are taken together. Adds what was
/// read to `files`. Throws InputError.
std::vector<AnalysisSource> read_sources(const std::vector<std::string>& words,
                                         const SourceOptions& options,
                                         std::vector<std::string>& files);

}  // namespace lilytank::cli
