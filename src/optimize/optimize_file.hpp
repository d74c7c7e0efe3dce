// Files of optimisations as their authors wrote them, before any scenario is built.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "io/scenario_layers.hpp"
#include "io/toml_key.hpp"
#include "lilytank/optimize.hpp"

namespace lilytank {

/// A [[parameter]].
struct OptimizeParameter {
  SourcePlace place;         ///< of its table
  Assignment path;           ///< "*" in the name of a rule stands for any letters
  double low = 0, high = 0;  ///< in the key's unit
  bool logarithmic = false;
  bool whole = false;           ///< rounded
  std::optional<double> start;  ///< else what the scenario says
};

/// [agitation]: pump power in whole per cent.
struct AgitationTable {
  Agitation kind = Agitation::none;
  double low = 0, high = 0;  ///< %
  int pieces = 2;            ///< of a schedule
  SourcePlace place;
};

/// [race]: rulesets of a target by successive halving.
struct RaceTable {
  std::string target;    ///< file
  int rulesets = 16;     ///< that begin, at most
  int evaluations = 12;  ///< of each in the first round, doubled from round to round
  SourcePlace place;
};

/// [compare]: a study of the optimum beside other overlays.
struct CompareTable {
  std::vector<std::string> overlays, labels;
  int replicates = 0;
  std::uint64_t seed = 0;
};

enum class SearchMethod { cma_es, swarm };

struct OptimizeFile {
  std::string name;
  std::vector<std::string> scenarios;
  std::uint64_t seed = 1;
  FitnessRule fitness;
  bool hybrid = false;
  SourcePlace hybrid_place;
  SearchMethod method = SearchMethod::cma_es;
  SwarmOptions swarm;
  bool start_anywhere = false;  ///< the swarm does not begin at the scenario's values
  CmaEsOptions cma_es;
  std::vector<OptimizeParameter> parameters;
  AgitationTable agitation;
  std::optional<RaceTable> race;
  CompareTable compare;
};

/// The keys of an optimisation file.
TomlKeys optimize_file_keys();
/// Throws InputError: unreadable file, TOML syntax, unknown key, wrong kind, out of bounds.
/// `seed` replaces optimize.seed.
OptimizeFile read_optimize_file(const std::string& file, std::optional<std::uint64_t> seed = {});

}  // namespace lilytank
