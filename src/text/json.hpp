// Values as JSON writes them.
#pragma once
#include <string>

namespace lilytank {

/// In quotes, with what must be escaped escaped.
std::string json_quoted(const std::string& text);
/// Six digits; null where there is no finite number, which JSON does not have.
std::string json_number(double value);

}  // namespace lilytank
