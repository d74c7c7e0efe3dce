#include "recording/process.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "recording/checks.hpp"

namespace lilytank {
namespace {

/// Rows without ids are one body if no frame has two of them.
bool one_body(const Sightings& s) {
  std::set<std::pair<std::int64_t, double>> instants;
  return std::all_of(s.rows.begin(), s.rows.end(), [&](const Sighting& row) {
    const bool timed = row.frame == kNoFrame;
    return instants.emplace(row.frame, timed ? row.time : 0).second;
  });
}

void make_recording(Sightings& s, const RecordingOptions& options, Report& report, Recording& out) {
  // An empty column of headings is none.
  s.headings = s.headings && std::any_of(s.rows.begin(), s.rows.end(), [](const Sighting& row) {
                 return !std::isnan(row.theta);
               });
  to_metres(s, options, report);
  if (report.refused()) return;
  const bool single = !s.identities && one_body(s);
  const FrameClock clock = find_clock(s, options, report);
  if (report.refused()) return;
  if (!s.identities && !single) link(s, clock, options, report);
  std::vector<Path> paths = make_paths(s, clock, report);
  if (report.refused()) return;
  const CheckContext context{s, clock, options, report};
  check_gaps(paths, context);
  if (options.in_tank) check_outside(paths, context);
  check_motion(paths, context);
  if (report.refused()) return;
  out.rate = clock.rate, out.start = clock.start, out.frames = clock.frames;
  out.tracks = make_tracks(paths, context);
}

std::string name_of(const RecordingOptions& options, const std::string& file) {
  if (!options.name.empty()) return options.name;
  std::string name = file.substr(file.find_last_of('/') + 1);
  for (const char* ending : {".gz", ".csv", ".tsv", ".txt"}) {
    if (name.size() > std::string(ending).size() && name.ends_with(ending)) {
      name.resize(name.size() - std::string(ending).size());
    }
  }
  return name;
}

}  // namespace

CheckedRecording process(Sightings sightings, const RecordingOptions& options) {
  const SourcePlace file{sightings.files.front(), 0, 0};
  if (sightings.rows.empty()) throw InputError(file, "there is no sighting in it");
  CheckedRecording out;
  Recording& r = out.recording;
  r.name = name_of(options, file.file);
  r.body = options.body, r.latches = options.latches, r.held_out = options.held_out;
  r.frames = 0;
  out.format = sightings.format, out.files = sightings.files;
  out.rows = static_cast<std::int64_t>(sightings.rows.size());
  out.unused_columns = sightings.unused;
  out.comment_lines = sightings.comment_lines;
  out.names = sightings.names;
  Report report(options.rules);
  make_recording(sightings, options, report, r);
  out.findings = report.take();
  if (!report.refused() && r.tracks.empty()) {
    throw InputError(file, "nothing is left of it after what the checks marked");
  }
  return out;
}

}  // namespace lilytank
