#include "io/enough_memory.hpp"
#include "lilytank/recording_io.hpp"
#include "recording/files.hpp"
#include "recording/formats.hpp"
#include "recording/process.hpp"

namespace lilytank {
namespace {

std::size_t count_refused(const std::vector<Finding>& findings, const Finding** first) {
  std::size_t count = 0;
  for (const Finding& finding : findings) {
    if (finding.treatment != Treatment::refuse) continue;
    if (count++ == 0) *first = &finding;
  }
  return count;
}

}  // namespace

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
