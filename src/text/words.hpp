// Names in a sentence or a cell.
#pragma once
#include <cstdint>
#include <functional>
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

/// "1 run", "2 runs".
inline std::string counted(std::int64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// ASCII letters alone.
inline std::string in_small_letters(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

/// Text as a part of a file name: letters, digits, '_' and '.', the rest as '-'; it does not begin
/// with '.' or '-'. `otherwise` where nothing is left.
inline std::string file_name_of(const std::string& text, const std::string& otherwise) {
  std::string out;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '_' || c == '.';
    if (plain && !(out.empty() && c == '.')) {
      out += c;
    } else if (!out.empty() && out.back() != '-') {
      out += '-';
    }
  }
  while (out.ends_with('-')) out.pop_back();
  return out.empty() ? otherwise : out;
}

/// "K_F" of "forces.face_drag.K_F".
inline std::string own_name(const std::string& path) {
  return path.substr(path.rfind('.') + 1);
}

/// "r1 + r3" for " + ", each by `text`; "" of none.
template <class List, class Text = std::identity>
std::string joined(const List& list, std::string_view between, Text&& text = {}) {
  std::string out;
  bool first = true;
  for (const auto& one : list) {
    if (!first) out += between;
    out += text(one), first = false;
  }
  return out;
}

/// Text as the content of XML and HTML, also in attributes: <, >, & and " as entities.
inline std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '"') {
      out += "&quot;";
    } else {
      out += c;
    }
  }
  return out;
}

/// A text with spaces up to a width.
inline std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text;
}

}  // namespace lilytank
