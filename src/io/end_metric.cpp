#include "io/end_metric.hpp"

#include "lilytank/error.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {

EndMetric end_metric(const std::string& text, int modules) {
  using Of = EndMetric::Of;
  const std::size_t at = text.find_first_of("<>");
  const bool compares = at != text.npos && at + 1 < text.size() && text[at + 1] == '=';
  const auto bound =
      compares ? parse_number(trimmed(std::string_view(text).substr(at + 2))) : std::nullopt;
  if (!bound) {
    throw InputError("'" + text + "' is not a name, >= or <=, and a number, as \"singles <= 2\"");
  }
  EndMetric out;
  out.at_least = text[at] == '>', out.bound = *bound;
  const std::string name(trimmed(std::string_view(text).substr(0, at)));
  if (const auto size = name.starts_with("size_") ? parse_whole(name.substr(5)) : std::nullopt;
      size && *size >= 1 && *size <= modules) {
    out.of = Of::size, out.size = static_cast<int>(*size);
    return out;
  }
  const std::vector<std::string> names{"copies", "most_copies", "illegal", "largest", "singles"};
  constexpr Of kinds[] = {Of::copies, Of::most_copies, Of::illegal, Of::largest, Of::size};
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (name != names[k]) continue;
    out.of = kinds[k], out.size = out.of == Of::size ? 1 : 0;
    return out;
  }
  throw InputError("'" + name + "' is none of " + joined(names, ", ") + ", size_1 to size_" +
                   std::to_string(modules) + did_you_mean(name, names));
}

}  // namespace lilytank
