#include "study/study_inputs.hpp"

#include <algorithm>
#include <filesystem>

namespace lilytank {
namespace {

void add(const Assignment& value, std::vector<std::string>& files) {
  files.push_back(value.place.file);
  const auto* name = std::get_if<std::string>(&value.value);
  if (name == nullptr || value.keys.back() != "file") return;
  files.push_back((std::filesystem::path(value.directory) / *name).string());
}

}  // namespace

std::vector<std::string> with_files_of(const std::vector<Layer>& layers,
                                       std::vector<std::string> files) {
  for (const Layer& layer : layers) {
    for (const Assignment& value : layer.values) add(value, files);
    for (const CommandTable& command : layer.commands) {
      files.push_back(command.place.file);
      for (const Assignment& field : command.fields) add(field, files);
    }
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

}  // namespace lilytank
