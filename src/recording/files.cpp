#include "recording/files.hpp"

#include <algorithm>
#include <filesystem>

#include "lilytank/error.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

bool fits(std::string_view name, std::string_view pattern) {
  if (pattern.empty()) return name.empty();
  if (pattern.front() != '*') {
    return !name.empty() && name.front() == pattern.front() &&
           fits(name.substr(1), pattern.substr(1));
  }
  // Runs of '*' are one.
  const std::string_view rest =
      pattern.substr(std::min(pattern.find_first_not_of('*'), pattern.size()));
  if (rest.empty()) return true;
  for (std::size_t i = 0; i <= name.size(); ++i) {
    if (fits(name.substr(i), rest)) return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> files_of(const std::string& name) {
  std::error_code problem;
  const bool directory = fs::is_directory(name, problem);
  const bool pattern = name.find('*') != std::string::npos && !fs::exists(name, problem);
  if (!directory && !pattern) return {name};
  const fs::path path(name);
  const fs::path folder = directory ? path : path.parent_path();
  const std::string wanted = directory ? "*" : path.filename().string();
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, problem)) {
    const std::string file = entry.path().filename().string();
    const bool hidden = file.starts_with('.');
    if (!hidden && entry.is_regular_file(problem) && fits(file, wanted)) {
      files.push_back((folder / file).string());
    }
  }
  if (files.empty())
    throw InputError({name, 0, 0}, directory ? "there are no files in it" : "no file fits this");
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace lilytank
