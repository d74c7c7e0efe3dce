// One [[axis]] table, and what it shares with other tables of paths. Only for src/io.
#pragma once
#include <string>
#include <vector>

#include "io/toml_fields.hpp"
#include "study/study_file.hpp"

namespace lilytank {

/// The keys of an axis.
TomlKeys axis_keys();
/// Reads an axis of a study file in `directory`. Throws InputError.
StudyAxis read_axis(const TomlFields& fields, const std::string& directory);

/// What a range must know about the key that it runs over.
struct KeyFacts {
  std::string unit;
  bool whole = false;
};
/// Of a number's path. Throws InputError for other keys; of a rule, whose file is not yet known,
/// the facts of a probability.
KeyFacts facts_of(const Assignment& path);
/// The key `path` of a table as a path of a scenario that may be varied. Throws InputError.
Assignment path_of(const TomlFields& fields);
/// The key `scale`, of a range of numbers.
TomlKey scale_key();
/// Its value: "log" is true, "linear" and none false. Throws InputError.
bool log_scale(const TomlFields& fields);

/// Refuses names that do not fit in tables and file names; `what` is the key for the message.
void check_name(const std::string& name, const std::string& what, const SourcePlace& place);

}  // namespace lilytank
