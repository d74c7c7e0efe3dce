// One [[axis]] table, and what it shares with other tables of paths. Only for src/io.
#pragma once
#include <string>
#include <vector>

#include "io/toml_fields.hpp"
#include "study/study_file.hpp"

namespace lilytank {

/// Reads an axis of a study file in `directory`. Throws InputError.
StudyAxis read_axis(const toml::table& table, const std::string& file,
                    const std::string& directory);

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
/// Which of `words` a key holds. Throws InputError with the nearest one.
std::size_t word_of(const TomlFields& fields, const std::string& name,
                    const std::vector<std::string>& words);
/// The key `scale` of a table: "log" is true, "linear" and none false. Throws InputError.
bool log_scale(const TomlFields& fields);

/// Refuses names that do not fit in tables and file names; `what` is the key for the message.
void check_name(const std::string& name, const std::string& what, const SourcePlace& place);

}  // namespace lilytank
