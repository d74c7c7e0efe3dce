// TOML texts with our errors and our values. Only files in src/io include this: it needs toml++.
#pragma once
#include <toml++/toml.h>

#include <string>

#include "io/scenario_layers.hpp"

namespace lilytank {

/// Where a value or a key stands in `file`.
SourcePlace place_of(const toml::source_region& region, const std::string& file);

/// Throws InputError with line and column of what is not TOML.
toml::table parse_toml(const std::string& text, const std::string& file);

/// A node as a value; a table, whatever is in it, becomes an EmptyTable.
TomlValue value_of(const toml::node& node);

}  // namespace lilytank
