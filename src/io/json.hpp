// JSON as this program's files hold it. Reading and writing are compiled once: they cost every
// source that uses them seconds of compiling.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace lilytank {

using Json = nlohmann::ordered_json;  // keys stay in the order in which they are written

/// A file's content: indented, null where a number is not finite. Bytes that are not UTF-8 become
/// U+FFFD.
std::string json_text(const Json& value);
/// The same on one line, without spaces.
std::string json_line(const Json& value);
/// The value in a text. Throws Json::exception if the text is no JSON.
Json json_of(const std::string& text);
/// The same, but Json::is_discarded() if the text is no JSON.
Json json_or_discarded(const std::string& text);
/// The number at the top level under a key; nothing if the text is no JSON object or holds none.
std::optional<double> json_number_of(const std::string& text, const std::string& key);

}  // namespace lilytank
