// Text as the content of XML and HTML.
#pragma once
#include <string>
#include <string_view>

namespace lilytank {

/// The text with <, >, & and " as entities, for content and attributes.
std::string escaped(std::string_view text);

}  // namespace lilytank
