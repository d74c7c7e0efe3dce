// JSON Schema (draft 7) of TOML files, for editors.
#pragma once
#include <string>

#include "io/json.hpp"
#include "io/toml_key.hpp"

namespace lilytank {

/// The schema of a file with these keys and no others. A number may be given as a text with a unit.
Json json_schema(const std::string& title, const TomlKeys& keys);

}  // namespace lilytank
