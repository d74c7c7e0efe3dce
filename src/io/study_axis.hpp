// One [[axis]] table. Only for src/io.
#pragma once
#include "io/study_file.hpp"
#include "io/toml_text.hpp"

namespace lilytank {

/// Reads an axis of a study file in `directory`. Throws InputError.
StudyAxis read_axis(const toml::table& table, const std::string& file,
                    const std::string& directory);

/// Refuses names that do not fit in tables and file names; `what` is the key for the message.
void check_name(const std::string& name, const std::string& what, const SourcePlace& place);

}  // namespace lilytank
