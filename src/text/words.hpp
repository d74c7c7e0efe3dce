// Names in a sentence or a cell.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace lilytank {

/// "r3", "r3 and r5", "r1, r3 and r5"; "" of none.
inline std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t k = 0; k < names.size(); ++k)
    out += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + names[k];
  return out;
}

/// "r1 + r3" for " + "; "" of none.
inline std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string out;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (k > 0) out += between;
    out += words[k];
  }
  return out;
}

}  // namespace lilytank
