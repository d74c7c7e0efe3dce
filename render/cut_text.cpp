#include "cut_text.hpp"

namespace lilytank {
namespace {

bool within_character(char c) {
  return (c & 0xC0) == 0x80;  // UTF-8
}

std::string end_within(const std::string& name, double widest, const TextWidth& width) {
  if (width(name) <= widest) return name;
  std::size_t from = 0;
  do {
    do ++from;
    while (from < name.size() && within_character(name[from]));
  } while (from < name.size() && width("…" + name.substr(from)) > widest);
  return "…" + name.substr(from);
}

// Whether two are alike that were not before they were cut.
bool alike(const std::vector<std::string>& cut, const std::vector<std::string>& whole) {
  for (std::size_t i = 0; i < cut.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (cut[i] == cut[j] && whole[i] != whole[j]) return true;
    }
  }
  return false;
}

}  // namespace

std::string begin_within(const std::string& s, double widest, const TextWidth& width) {
  if (width(s) <= widest) return s;
  std::string cut = s;
  do {
    while (!cut.empty() && within_character(cut.back())) cut.pop_back();
    if (!cut.empty()) cut.pop_back();
  } while (!cut.empty() && width(cut + "…") > widest);
  return cut + "…";
}

std::vector<std::string> lines_within(const std::string& s, double widest, const TextWidth& width) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < s.size();) {
    std::size_t end = s.find(' ', at);
    for (std::size_t next = end; next != std::string::npos;) {
      next = s.find(' ', next + 1);
      if (width(s.substr(at, next - at)) > widest) break;
      end = next;
    }
    lines.push_back(begin_within(s.substr(at, end - at), widest, width));
    if (end == std::string::npos) break;
    at = end + 1;
  }
  return lines;
}

std::vector<std::string> cut_apart(const std::vector<std::string>& names, double widest,
                                   const TextWidth& width) {
  std::vector<std::string> cut;
  for (const std::string& name : names) cut.push_back(begin_within(name, widest, width));
  if (!alike(cut, names)) return cut;
  for (std::size_t i = 0; i < cut.size(); ++i) cut[i] = end_within(names[i], widest, width);
  if (!alike(cut, names)) return cut;
  for (std::size_t i = 0; i < cut.size(); ++i) {
    cut[i] = begin_within(std::to_string(i + 1) + ": " + names[i], widest, width);
  }
  return cut;
}

}  // namespace lilytank
