#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_set>

#include "recording/checks.hpp"
#include "recording/column_names.hpp"
#include "recording/formats.hpp"

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

std::int64_t identities_in(const Sightings& s) {
  if (!s.identities) return one_body(s) ? 1 : 0;
  std::unordered_set<std::int64_t> ids;
  for (const Sighting& row : s.rows) ids.insert(row.id);
  return static_cast<std::int64_t>(ids.size());
}

/// Columns that are not used but may matter, and ids that number rows instead of bodies.
void check_columns(const Sightings& s, Report& report) {
  for (const std::string& hint : s.hints) {
    report.add(Check::columns, {s.files.front(), 0, 0}, -1, -1, hint);
  }
  constexpr std::size_t kFewest = 5;
  if (!s.identities || s.rows.size() < kFewest || one_file_a_track(s.format)) return;
  std::unordered_set<std::int64_t> ids;
  const auto first = s.rows.front();
  bool moments = false;  // more than one
  for (const Sighting& row : s.rows) {
    if (!ids.insert(row.id).second) return;
    moments =
        moments || row.frame != first.frame || (row.frame == kNoFrame && row.time != first.time);
  }
  if (!moments) return;
  report.add(Check::columns, {s.files.front(), 0, 0}, -1, -1,
             "every row has an identity of its own: does the column of identities number "
             "sightings? columns.id says which to read; not used: " +
                 short_list(s.unused));
}

std::string unit_text(double seconds) {
  for (const auto& [unit, name] : {std::pair{1.0, "s"}, {1e-3, "ms"}, {1e-6, "us"}, {1e-9, "ns"}}) {
    if (std::fabs(seconds - unit) < 1e-3 * unit) return name;
  }
  return time_text(seconds);
}

/// How times were read, where that is more than numbers of a given unit.
std::string times_text(const Sightings& s, const RecordingOptions& options) {
  switch (s.times.kind()) {
    case TimeText::Kind::epoch:
      return "counts since 1970 in " + unit_text(s.times.unit()) +
             (options.time_unit ? "" : " (by their size)") + ", from the first row on";
    case TimeText::Kind::date:
      return "dates without a zone, from the first row on";
    case TimeText::Kind::zoned_date:
      return "dates, from the first row on";
    case TimeText::Kind::clock:
      return "hours, minutes and seconds";
    default:
      return "";
  }
}

/// Repeats are judged along tracks, which rows without identities do not have yet: they are linked
/// on trial, and rows that the check marks are removed before the rows are linked for good.
void check_unlinked_repeats(Sightings& s, const RecordingOptions& options, Report& report) {
  CheckRules rules = options.rules;
  rules[Check::clock] = rules[Check::link] = Treatment::keep;
  rules.least_jump = 2 * std::max(rules.least_jump, options.body_radius);  // to bridge a held pose
  Report quiet(rules);
  Sightings trial = s;
  const bool numbered = std::all_of(s.rows.begin(), s.rows.end(),
                                    [](const Sighting& row) { return row.frame != kNoFrame; });
  const FrameClock clock = find_clock(trial, options, quiet);
  if (quiet.refused()) return;
  link(trial, clock, options, quiet);
  for (Sighting& row : trial.rows) row.frame = numbered ? clock.number(row.frame) : kNoFrame;
  check_repeats(trial, report);
  std::set<std::pair<std::int32_t, std::int32_t>> marked;
  for (const Sighting& row : trial.rows) {
    if (row.unseen) marked.emplace(row.file, row.line);
  }
  if (marked.empty()) return;
  std::erase_if(s.rows, [&](const Sighting& row) { return marked.contains({row.file, row.line}); });
}

FrameClock make_recording(Sightings& s, const RecordingOptions& options, Report& report,
                          Recording& out) {
  // An empty column of headings is none.
  s.headings = s.headings && std::any_of(s.rows.begin(), s.rows.end(), [](const Sighting& row) {
                 return !std::isnan(row.theta);
               });
  to_metres(s, options, report);
  const bool single = !s.identities && one_body(s);
  if (s.identities || single) {
    check_repeats(s, report);
  } else {
    check_unlinked_repeats(s, options, report);
  }
  check_lengths(s, options, report);
  if (report.refused()) return {};
  const FrameClock clock = find_clock(s, options, report);
  if (report.refused()) return {};
  if (!s.identities && !single) link(s, clock, options, report);
  std::vector<Path> paths = make_paths(s, clock, report);
  if (report.refused()) return {};
  const CheckContext context{s, clock, options, report};
  check_gaps(paths, context);
  if (options.in_tank) check_outside(paths, context);
  check_motion(paths, context);
  if (report.refused()) return {};
  out.rate = clock.rate, out.start = clock.start, out.frames = clock.frames;
  out.tracks = make_tracks(paths, context);
  return clock;
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
  if (sightings.rows.empty()) {
    const std::int64_t read = sightings.counts.read;
    throw InputError(file, "there is no sighting in it" +
                               (read > 0 ? ": " + std::to_string(read) +
                                               " rows were read, none of them has a position"
                                         : ""));
  }
  CheckedRecording out;
  Recording& r = out.recording;
  r.name = name_of(options, file.file);
  r.body = options.body, r.latches = options.latches, r.held_out = options.held_out;
  r.frames = 0;
  out.format = sightings.format, out.files = sightings.files;
  out.rows = static_cast<std::int64_t>(sightings.rows.size());
  out.unused_columns = sightings.unused;
  out.counts = sightings.counts;
  out.identities = identities_in(sightings);
  out.comment_lines = sightings.comment_lines;
  out.names = sightings.names;
  Report report(options.rules);
  check_columns(sightings, report);
  out.times = times_text(sightings, options);
  out.frame_step = make_recording(sightings, options, report, r).step;
  out.findings = report.take();
  for (Finding& finding : out.findings) {
    const auto id = static_cast<std::size_t>(finding.id);
    if (finding.id >= 0 && id < out.names.size()) finding.name = out.names[id];
  }
  if (!report.refused() && r.tracks.empty()) {
    throw InputError(file, "the checks excluded all of its rows");
  }
  return out;
}

}  // namespace lilytank
