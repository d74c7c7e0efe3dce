// Text that came with the input, made safe for a terminal.
#pragma once
#include <string>
#include <string_view>

namespace lilytank {

/// The text on one line, as it may be printed: control characters become "\n", "\t", "\x1b", and so
/// do bytes that are not UTF-8, and characters that end a line or reverse the direction of writing.
/// Printable text stays as it is; applying it twice changes nothing more.
std::string printable(std::string_view text);

}  // namespace lilytank
