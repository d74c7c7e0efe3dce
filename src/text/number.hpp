// Numbers as text: read without locale or surprises, written so that they read back the same.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lilytank {

/// The shortest decimal text that reads back as the same number: "0.3", "1e-05".
std::string shortest(double value);
std::string shortest(float value);
/// With 15 digits at most: "1.45" where a product such as 58 * 0.025 has rounding at the end. For
/// times in tables; reads back to within one part in 10^15.
std::string without_rounding(double value);

/// With that many significant digits, for reports: "0.0123", "1.2e-05".
std::string significant(double value, int digits);

/// The whole of `text` as a finite decimal number; nothing if it is not one (empty, "nan", "1 ",
/// "0x1", out of the range of double). A leading '+' is allowed.
std::optional<double> parse_number(std::string_view text);
std::optional<float> parse_float(std::string_view text);
/// The whole of `text` as a whole number.
std::optional<std::int64_t> parse_whole(std::string_view text);

/// `text` without blanks at both ends.
std::string_view trimmed(std::string_view text);

}  // namespace lilytank
