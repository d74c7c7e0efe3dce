// lilytank schema: JSON Schemas of its TOML files, for editors.
#include <iostream>

#include "bodies/bodies_file.hpp"
#include "cli/options.hpp"
#include "io/json_schema.hpp"
#include "io/scenario_keys.hpp"
#include "lilytank/error.hpp"
#include "optimize/optimize_file.hpp"
#include "recording/recording_keys.hpp"
#include "study/study_file.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

const std::vector<std::string> kKinds{"scenario", "experiment", "bodies", "study", "optimize"};

TomlKeys keys_of(const std::string& kind) {
  if (kind == "bodies") return body_file_keys(baseline_laws());
  if (kind == "study") return study_file_keys();
  if (kind == "optimize") return optimize_file_keys();
  TomlKeys keys = scenario_file_keys();
  if (kind == "experiment") {
    for (TomlKey& table : experiment_tables()) keys.push_back(std::move(table));
  }
  return keys;
}

}  // namespace

int schema_verb(const Arguments& arguments, const Host&) {
  VerbOptions options("schema", "scenario|experiment|bodies|study|optimize",
                      "Prints the JSON Schema of a kind of file: editors then complete keys, show "
                      "their meanings, and mark what the program would refuse.");
  if (!options.parse(arguments, "of which kind? there are " + joined(kKinds, ", "))) {
    return Exit::done;
  }
  const std::string& kind = options.only("one kind at a time: " + joined(kKinds, ", "));
  if (std::find(kKinds.begin(), kKinds.end(), kind) == kKinds.end()) {
    options.refuse("'" + kind + "' is none of " + joined(kKinds, ", ") +
                   did_you_mean(kind, kKinds));
  }
  std::cout << json_text(json_schema("lilytank " + kind, keys_of(kind)));
  return Exit::done;
}

}  // namespace lilytank::cli
