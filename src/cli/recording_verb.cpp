#include "cli/recording_verb.hpp"

#include <filesystem>
#include <iostream>

#include "cli/inputs.hpp"
#include "io/standard_input.hpp"
#include "lilytank/experiment.hpp"
#include "recording/formats.hpp"
#include "recording/recording_keys.hpp"

namespace lilytank::cli {
namespace {

namespace fs = std::filesystem;

/// What --read says, over other options; body sizes come from the scenario's keys.
RecordingOptions with_options(const VerbOptions& options, const Model& model,
                              RecordingOptions out) {
  for (const Assignment& a : read_assignments(options.list("read"), "--read")) {
    assign_recording_option(a, "recording", out);
  }
  take_sizes(model, out);
  return out;
}

/// Whether a file is one track of several.
bool is_one_track(const std::string& file, const RecordingOptions& options) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return false;
  if (options.format != RecordingFormat::automatic) return one_file_a_track(options.format);
  LineSource lines(file);
  return one_file_a_track(detect_format(Table(lines, options.layout)));
}

void add_experiment(const std::string& file, const VerbOptions& options,
                    std::vector<NamedRecording>& out) {
  const auto none = [](const RecordingSource&) { return false; };
  const Experiment experiment = load_experiment({file}, options.list("set"), none);
  for (const RecordingSource& s : experiment.sources) {
    out.push_back({s.file, {s.file}, with_options(options, experiment.base.model, s.options)});
  }
}

}  // namespace

void add_reading_options(VerbOptions& options) {
  options.add_list({"read",
                    "how files are read, as a [[recording]] of an experiment says it: "
                    "format=trackpy, rate=25, tank_circle=[640,480,455], columns.x=px, "
                    "checks.swap=mark",
                    "KEY=VALUE"});
  options.add_list({"set", "a value of the tank or the bodies, as tank.radius=0.3", "PATH=VALUE"});
}

std::vector<NamedRecording> named_recordings(const VerbOptions& options,
                                             const std::vector<std::string>& arguments) {
  if (arguments.empty()) options.refuse("which recording? write a file or an experiment file");
  refuse_point_bodies(arguments);
  std::vector<NamedRecording> out;
  const RecordingOptions reading =
      with_options(options, load_scenario({}, options.list("set")).model, {});
  bool together = false;
  for (const std::string& file : arguments) {
    if (is_toml(file)) {
      add_experiment(file, options, out);
      together = false;
      continue;
    }
    // A file that cannot be read is complained about when its turn comes.
    bool track = false;
    try {
      track = is_one_track(file, reading);
    } catch (const InputError&) {
    }
    const bool same_place =
        together && fs::path(out.back().files.back()).parent_path() == fs::path(file).parent_path();
    if (track && same_place) {
      out.back().files.push_back(file);
      out.back().name = out.back().files.front() + " and " +
                        std::to_string(out.back().files.size() - 1) + " more";
    } else {
      out.push_back({file, {file}, reading});
    }
    together = track;
  }
  return out;
}

std::vector<std::string> files_read(const std::vector<NamedRecording>& recordings,
                                    const std::vector<std::string>& arguments) {
  std::vector<std::string> out = arguments;
  for (const NamedRecording& named : recordings) {
    for (const std::string& name : named.files) {
      try {
        for (std::string& file : files_of(name)) out.push_back(std::move(file));
      } catch (const InputError&) {  // complained about when its turn comes
      }
    }
  }
  return out;
}

int recording_verb(const Arguments& arguments, const Host&) {
  const std::string word = arguments.empty() ? "" : arguments[0];
  const Arguments rest(arguments.begin() + (arguments.empty() ? 0 : 1), arguments.end());
  if (word == "info") return recording_info(rest);
  if (word == "check") return recording_check(rest);
  if (word == "convert") return recording_convert(rest);
  if (word == "--help" || word == "-h") {
    std::cout << "Trackers' files: what is in them, what is wrong with them, and other formats.\n"
                 "Usage:\n"
                 "  lilytank recording info FILE...     what was recorded\n"
                 "  lilytank recording check FILE...    everything that looks wrong, and what is "
                 "done about it\n"
                 "  lilytank recording convert FILE...  to another format; or a run, through a "
                 "camera\n\n"
                 "Each has --help. FILE is a tracker's file, a directory with one file a "
                 "track, or an experiment (*.toml).\n"
              << examples_of("recording");
    return Exit::done;
  }
  throw InputError(
      "lilytank recording: say info, check or convert" +
      (word.empty() ? "" : ", not '" + word + "'" + did_you_mean(word, kRecordingVerbs)));
}

}  // namespace lilytank::cli
