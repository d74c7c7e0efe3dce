#include "io/scenario_text.hpp"

#include <algorithm>

#include "io/scenario_values.hpp"
#include "text/number.hpp"

namespace lilytank {

void ScenarioText::comment(const std::string& lines) {
  for (std::size_t at = 0; at < lines.size();) {
    const auto end = std::min(lines.find('\n', at), lines.size());
    text_ += "# " + lines.substr(at, end - at) + "\n";
    at = end + 1;
  }
}

void ScenarioText::table(const std::string& header) {
  text_ += (begun_ ? "\n[" : "[") + header + "]\n";
  begun_ = true;
}

void ScenarioText::line(const std::string& key, const std::string& toml,
                        const std::string& remark) {
  text_ += key + " = " + toml + (remark.empty() ? "" : "  # " + remark) + "\n";
  begun_ = true;
}

void ScenarioText::number(const std::string& key, double value, const std::string& remark) {
  line(key, shortest(value), remark);
}

void ScenarioText::quoted(const std::string& key, const std::string& text) {
  line(key, toml_quoted(text));
}

}  // namespace lilytank
