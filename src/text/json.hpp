// Values as JSON writes them, and as this program reads its own back.
#pragma once
#include <optional>
#include <string>

namespace lilytank {

/// In quotes, with what must be escaped escaped.
std::string json_quoted(const std::string& text);
/// Six digits; null where there is no finite number, which JSON does not have.
std::string json_number(double value);
/// The number that stands under a key in JSON as this program writes it; nothing if none does.
std::optional<double> json_number_of(const std::string& text, const std::string& key);

}  // namespace lilytank
