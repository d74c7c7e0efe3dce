// Recordings and experiments through the library's readers.
#include "lilytank/recording.hpp"

#include <pybind11/stl.h>

#include <cmath>

#include "lilytank/experiment.hpp"
#include "lilytank/metrics.hpp"
#include "module.hpp"
#include "recording/recording_keys.hpp"
#include "refusals.hpp"
#include "views.hpp"

namespace lilytank::python {
namespace {

using namespace py::literals;

std::string word_of(BodyKind body) {
  constexpr const char* words[] = {"lily", "ball", "point"};
  return words[static_cast<std::size_t>(body)];
}

py::list finding_dicts(const std::vector<Finding>& findings) {
  py::list out;
  for (const Finding& f : findings) {
    out.append(py::dict("check"_a = check_word(f.check),
                        "treatment"_a = treatment_word(f.treatment), "file"_a = f.place.file,
                        "line"_a = f.place.line, "frame"_a = f.frame, "id"_a = f.id,
                        "what"_a = f.what, "text"_a = f.text()));
  }
  return out;
}

/// The arrays belong to the recording, which they keep alive.
py::dict recording_dict(const std::shared_ptr<Recording>& recording) {
  const py::capsule owner(new std::shared_ptr<Recording>(recording), [](void* kept) {
    delete static_cast<std::shared_ptr<Recording>*>(kept);
  });
  py::list tracks;
  for (const Track& t : recording->tracks) {
    tracks.append(py::make_tuple(
        t.id, t.first, view(t.x, owner), view(t.y, owner),
        t.theta.empty() ? py::object(py::none()) : py::object(view(t.theta, owner))));
  }
  return py::dict("name"_a = recording->name, "body"_a = word_of(recording->body),
                  "rate"_a = recording->rate, "start"_a = recording->start,
                  "frames"_a = recording->frames, "latches"_a = recording->latches,
                  "held_out"_a = recording->held_out, "tracks"_a = tracks);
}

RecordingOptions options_of(const std::vector<std::string>& read,
                            const std::vector<std::string>& sets) {
  RecordingOptions options;
  for (const Assignment& a : read_assignments(read, "--read")) {
    assign_recording_option(a, "recording", options);
  }
  take_sizes(load_scenario({}, sets).model, options);
  return options;
}

/// One recording and its findings; a refused recording has no tracks.
py::dict read_one(const std::vector<std::string>& files, const std::vector<std::string>& read,
                  const std::vector<std::string>& sets, bool refuse) {
  CheckedRecording checked;
  with_command("recording", files, [&] {
    const py::gil_scoped_release release;
    checked = check_recording(files, options_of(read, sets));
    if (refuse) checked.throw_if_refused();
  });
  const bool refused = checked.refused();
  const auto recording = std::make_shared<Recording>(std::move(checked.recording));
  py::dict out = recording_dict(recording);
  out["findings"] = finding_dicts(checked.findings);
  out["format"] = format_word(checked.format);
  out["rows"] = checked.rows, out["refused"] = refused;
  out["unused_columns"] = checked.unused_columns;
  return out;
}

py::dict read_experiment(const std::vector<std::string>& files,
                         const std::vector<std::string>& sets) {
  Experiment experiment;
  with_command("recording", files, [&] {
    const py::gil_scoped_release release;
    experiment = load_experiment(files, sets);
  });
  py::list recordings;
  for (Recording& r : experiment.recordings) {
    recordings.append(recording_dict(std::make_shared<Recording>(std::move(r))));
  }
  return py::dict("name"_a = experiment.name, "recordings"_a = recordings,
                  "findings"_a = finding_dicts(experiment.findings),
                  "scenario"_a = std::make_shared<Scenario>(std::move(experiment.base)));
}

}  // namespace

void bind_recording(py::module_& m) {
  m.def("read_recording", &read_one, py::arg("files"), py::arg("read"), py::arg("sets"),
        py::arg("refuse"));
  m.def("read_experiment", &read_experiment, py::arg("files"), py::arg("sets"));
}

}  // namespace lilytank::python
