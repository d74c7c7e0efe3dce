// Recordings in other formats, and simulated runs as a camera would have recorded them.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "cli/inputs.hpp"
#include "cli/recording_verb.hpp"
#include "io/atomic_file.hpp"
#include "jobs/run_directory.hpp"
#include "lilytank/camera.hpp"
#include "lilytank/run.hpp"
#include "recording/formats.hpp"
#include "recording/recording_keys.hpp"

namespace lilytank::cli {
namespace {

namespace fs = std::filesystem;

bool is_run(const std::string& name) {
  std::error_code ignored;
  return fs::exists(fs::path(name) / "resolved.toml", ignored);
}

Camera camera_of(const VerbOptions& options) {
  Camera camera;
  for (const Assignment& a : read_assignments(options.list("camera"), "--camera")) {
    assign_camera_option(a, camera);
  }
  return camera;
}

/// What to know of a film that shows poses between the stored ones; empty if there is nothing.
std::string between_poses(const StoredRun& run, const Camera& camera) {
  const Trajectory& t = run.trajectory;
  if (t.frames() < 2) return "";
  const double ratio = stored_rate(t) / camera.rate;
  if (ratio < 0.999)
    return seldom_stored(t, "the camera sees straight lines", "40 to store every step");
  if (!run.scenario.model.control.latches || std::fabs(ratio - std::round(ratio)) < 1e-3) return "";
  return "poses were stored " + significant(stored_rate(t), 3) +
         " times a second: frames between them show modules that latch approach too slowly (film "
         "with --camera rate=" +
         significant(stored_rate(t) / std::floor(ratio + 1e-3), 3) + ")\n";
}

/// What a camera records of a stored run.
Recording filmed(const StoredRun& run, const Camera& camera, const VerbOptions& options) {
  const Trajectory& t = run.trajectory;
  RecordingOptions reading;
  reading.body = t.modules > 0 ? BodyKind::lily : BodyKind::ball;
  for (const Assignment& a : read_assignments(options.list("read"), "--read")) {
    assign_recording_option(a, "recording", reading);
  }
  Recording out = film(t, camera, reading.body);
  out.latches = run.scenario.model.control.latches;
  return out;
}

/// Scale and origin of what is written: those given to --write.
Calibration calibration_of(const VerbOptions& options, double tank_radius) {
  RecordingOptions out;
  for (const Assignment& a : read_assignments(options.list("write"), "--write")) {
    assign_recording_option(a, "write", out);
  }
  if (out.calibration.circle_radius > 0) {
    out.calibration.pixel = tank_radius / out.calibration.circle_radius;
  }
  return out.calibration;
}

std::string stem_of(const std::string& file) {
  const std::string name = fs::path(file).filename().string();
  return name.substr(0, name.find('.'));
}

/// The file of one of several recordings in the directory `out`.
std::string file_in(const std::string& out, const std::string& name, RecordingFormat format) {
  const std::string ending = one_file_a_track(format)               ? ""
                             : format == RecordingFormat::fasttrack ? ".txt"
                                                                    : ".csv";
  return (fs::path(out) / (stem_of(name) + ending)).string();
}

/// Recordings as they are to be written: all of them, or none.
class Output {
 public:
  void add(const Recording& recording, const std::string& file, RecordingFormat format,
           const Calibration& calibration) {
    for (auto& named : recording_files(recording, file, format, calibration)) {
      files_.push_back(std::move(named));
    }
    lines_ += file + ": " + std::to_string(recording.tracks.size()) + " tracks, " +
              std::to_string(recording.frames) + " frames\n";
  }

  void write(bool force) const {
    for (const auto& [file, content] : files_) {
      const std::string folder = fs::path(file).parent_path().string();
      if (!folder.empty()) make_directory(folder);
    }
    write_results(files_, force);
    std::cerr << lines_;
  }

 private:
  NamedContents files_;
  std::string lines_;
};

void add_writing_options(VerbOptions& options) {
  options.add({"out",
               "file to write; a directory for several recordings, or for formats with one "
               "file a track",
               "FILE"});
  options.add({"to",
               "format: tidy (default), swistrack-tracks, swistrack-particles, trackpy, idtracker, "
               "idtracker-wide, trex, fasttrack",
               "FORMAT"});
  options.add_list({"write",
                    "scale of what is written: pixel='0.66 mm', origin=[640,480], "
                    "tank_circle=[640,480,455], y_axis=down, angle_unit=deg",
                    "KEY=VALUE"});
  options.add_list({"camera",
                    "of a run: rate, position_noise, heading_noise, dropped, missed, latency, "
                    "swaps, swap_distance, lens, tilt, tilt_direction, height, headings, seed",
                    "KEY=VALUE"});
  options.add({"force", "replace files of other contents"});
}

/// Whether a file lies where those of single tracks are to be written, and is named as they are.
bool is_among_tracks(const std::string& file, const std::string& folder, RecordingFormat format) {
  const fs::path path(file);
  std::error_code absent;
  if (!fs::equivalent(path.has_parent_path() ? path.parent_path() : ".", folder, absent) || absent)
    return false;
  const std::string name = path.filename().string();
  return format == RecordingFormat::trex ? name.find("_id") != std::string::npos
                                         : name.starts_with("track");
}

/// The file to write for each recording; none of them is read, and none is written twice.
std::vector<std::string> files_to_write(const VerbOptions& options,
                                        const std::vector<NamedRecording>& all,
                                        const std::string& out, RecordingFormat format) {
  const std::vector<std::string> inputs = files_read(all, options.positional());
  std::vector<std::string> files;
  for (const NamedRecording& named : all) {
    const std::string file = all.size() == 1 ? out : file_in(out, named.files.front(), format);
    if (std::find(files.begin(), files.end(), file) != files.end()) {
      options.refuse("two recordings would be written to '" + file + "': convert them one by one");
    }
    options.spare_inputs("out", file, inputs);
    for (const std::string& input : inputs) {
      const bool risky = one_file_a_track(format) && is_among_tracks(input, file, format);
      if (risky) options.spare_inputs("out", input, {input});
    }
    files.push_back(file);
  }
  return files;
}

void convert_files(const VerbOptions& options, const std::string& out, RecordingFormat format) {
  const std::vector<NamedRecording> all = named_recordings(options, options.positional());
  const std::vector<std::string> files = files_to_write(options, all, out, format);
  Output output;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const NamedRecording& named = all[i];
    const CheckedRecording checked = check_recording(named.files, named.options);
    checked.throw_if_refused();
    if (!checked.findings.empty()) {
      std::cerr << named.name << ": " << checked.findings.size()
                << " findings; lilytank recording check names them\n";
    }
    output.add(checked.recording, files[i], format,
               calibration_of(options, named.options.tank_radius));
  }
  output.write(options.has("force"));
}

void convert_run(const VerbOptions& options, const std::string& dir, const std::string& out,
                 RecordingFormat format) {
  options.spare_inputs("out", out, files_of_run(dir));
  const std::string scenario = (fs::path(dir) / run_file::resolved).string();
  const double radius = load_scenario({scenario}, {}).model.tank.radius;
  Output output;
  const StoredRun run = load_run(dir);
  const Camera camera = camera_of(options);
  output.add(filmed(run, camera, options), out, format, calibration_of(options, radius));
  output.write(options.has("force"));
  std::cerr << between_poses(run, camera);
}

}  // namespace

int recording_convert(const Arguments& arguments) {
  VerbOptions options(
      "recording convert", "FILE...|RUN_DIR",
      "Writes recordings in another format; what a check refuses is not written, what it\nmarks or "
      "cuts is missing or has a gap there. The directory of a run is filmed by a camera.");
  add_reading_options(options);
  add_writing_options(options);
  if (!options.parse(arguments)) return Exit::done;
  if (!options.has("out") || options.text("out").empty()) {
    options.refuse("where to? give --out FILE");
  }
  const RecordingFormat format = format_to_write(options.text("to", "tidy"), {"--to", 0, 0});
  const std::string out = options.text("out");
  const auto& words = options.positional();
  if (words.size() == 1 && is_run(words[0])) {
    convert_run(options, words[0], out, format);
    return Exit::done;
  }
  if (options.has("camera")) options.refuse("--camera goes with the directory of one run");
  convert_files(options, out, format);
  return Exit::done;
}

}  // namespace lilytank::cli
