// Putting one assignment into a draft, with every check that needs no other value.
#pragma once
#include <string>

#include "io/scenario_keys.hpp"
#include "io/scenario_layers.hpp"

namespace lilytank {

/// Checks kind, unit and bounds and stores the value. Throws InputError.
void assign(const ScenarioKey& key, const Assignment& from);

/// The present value as TOML: 0.3, true, "bilinear".
std::string value_text(const ScenarioKey& key);
/// The bounds or the allowed words: "0.05 .. 5", "tank | file | still".
std::string bounds_text(const ScenarioKey& key);
/// Text as a TOML string with its quotes.
std::string toml_quoted(const std::string& text);

/// The error for a path that is not in the table, with the nearest right name.
InputError unknown_key(const Assignment& from, const std::vector<ScenarioKey>& keys);
/// For words in general: "flow.gusts = 'per_pont' is not one of per_point, per_module - did ..."
InputError unknown_word(const SourcePlace& place, const std::string& path, const std::string& word,
                        const std::vector<std::string>& words);

/// The text of an assignment that must be text. Throws InputError.
std::string text_of(const Assignment& from, const std::string& path);
/// The place of its text among the words that it may be. Throws InputError, by unknown_word().
std::size_t index_of_word(const Assignment& from, const std::string& path,
                          const std::vector<std::string>& words);
/// A number in SI units, given plainly or with a unit. Throws InputError if it is not finite.
double number_of(const Assignment& from, const std::string& path, const std::string& unit);

}  // namespace lilytank
