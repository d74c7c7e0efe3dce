#include <algorithm>
#include <filesystem>

#include "recording/formats.hpp"

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

std::size_t count_refused(const std::vector<Finding>& findings, const Finding** first) {
  std::size_t count = 0;
  for (const Finding& finding : findings) {
    if (finding.treatment != Treatment::refuse) continue;
    if (count++ == 0) *first = &finding;
  }
  return count;
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

bool CheckedRecording::refused() const {
  const Finding* first = nullptr;
  return count_refused(findings, &first) > 0;
}

void CheckedRecording::throw_if_refused() const {
  const Finding* first = nullptr;
  const std::size_t count = count_refused(findings, &first);
  if (count == 0) return;
  throw InputError(first->text() +
                   (count > 1 ? ", and " + std::to_string(count - 1) + " more" : "") + "; checks." +
                   check_word(first->check) + " says what is done about it");
}

CheckedRecording check_recording(const std::string& file, const RecordingOptions& options) {
  return check_recording(std::vector{file}, options);
}

CheckedRecording check_recording(const std::vector<std::string>& names,
                                 const RecordingOptions& options) {
  std::vector<std::string> files;
  for (const std::string& name : names) {
    for (std::string& file : files_of(name)) files.push_back(std::move(file));
  }
  return with_enough_memory(files.front(),
                            [&] { return process(read_sightings(files, options), options); });
}

Recording read_recording(const std::string& file, const RecordingOptions& options) {
  CheckedRecording checked = check_recording(file, options);
  checked.throw_if_refused();
  return std::move(checked.recording);
}

}  // namespace lilytank
