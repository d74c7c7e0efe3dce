// The one table of everything that a scenario can set.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "io/toml_key.hpp"
#include "lilytank/model_parameter.hpp"
#include "lilytank/scenario.hpp"

namespace lilytank {

enum class FlowSource { tank, file, still };

/// A force term and whether it is on.
struct ForceDraft {
  const ForceTerm* term = nullptr;
  bool on = false;
  std::vector<double> p;
};

/// A scenario while it is put together: what files and --set assign, and what is not yet a Model.
/// A fresh one holds every default; numbers of a Model or AnalyticTank have theirs there.
struct ScenarioDraft {
  ScenarioDraft();
  Scenario scenario;
  AnalyticTank tank;
  FlowSource source = FlowSource::tank;
  Interpolation interpolation = Interpolation::bilinear;
  std::vector<ForceDraft> forces;  ///< of the whole library, in its order
  Ruleset rules;                   ///< the first ruleset, once its file is known
  std::string flow_file, ruleset_file, start_file;
};

/// A choice among words, bound to an enum or flag of the draft.
struct WordChoice {
  std::vector<std::string> words;
  std::function<std::size_t()> get;  ///< index of the present word
  std::function<void(std::size_t)> set;
};
/// The name of an input file.
struct FileName {
  std::string* name = nullptr;
};

/// One key: where its value lives in the draft decides its kind.
struct ScenarioKey {
  std::string path;  ///< "forces.face_drag.K_F"
  std::variant<double*, int*, std::uint64_t*, bool*, std::string*, WordChoice, FileName> target;
  std::string unit;                        ///< SI; "" for text, words and switches
  double low = 0, high = 0;                ///< inclusive, of numbers
  std::string meaning;                     ///< one sentence
  bool whole = false;                      ///< a double that must be a whole number
  std::optional<ModelNumber> number = {};  ///< of what may differ among models of one tank
};

/// The table for a draft, in the order of resolved.toml. The draft must stay where it is.
std::vector<ScenarioKey> scenario_keys(ScenarioDraft& draft);
/// The tables of a scenario file, with their keys.
TomlKeys scenario_file_keys();
/// Keys rules.<name>.p of the draft's ruleset.
std::vector<ScenarioKey> rule_keys(ScenarioDraft& draft);

}  // namespace lilytank
