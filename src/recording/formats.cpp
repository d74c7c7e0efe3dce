#include "recording/formats.hpp"

#include <algorithm>

#include "recording/column_names.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

using Names = std::vector<std::string>;

bool has(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool all_of(const Names& names, std::initializer_list<std::string_view> wanted) {
  return std::all_of(wanted.begin(), wanted.end(), [&](auto name) { return has(names, name); });
}

/// Whether there is a column of identities or of scores, as in tables of bounding boxes: then rows
/// are detections, not frames.
bool has_detections(const Names& names) {
  return find_role(names, ColumnRole::identity) >= 0 || find_role(names, ColumnRole::score) >= 0;
}

/// Whether there are columns "X", "X (cm)", "X#wcentroid", ...
bool has_centroid(const Names& names, char axis) {
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    const std::string_view rest =
        std::string_view(name).substr(std::min<std::size_t>(1, name.size()));
    return name.starts_with(axis) &&
           (rest.empty() || rest.starts_with('#') || rest.starts_with(" ("));
  });
}

RecordingFormat format_of_header(const Names& names) {
  using enum RecordingFormat;
  if (all_of(names, {"xBody", "yBody", "imageNumber", "id"})) return fasttrack;
  if (all_of(names, {"frame", "individual", "x", "y"})) return idtracker;
  if (all_of(names, {"frame", "particle", "x", "y"})) return trackpy;
  if (all_of(names, {"id", "x", "y"}) && (has(names, "frame") || has(names, "time"))) return tidy;
  const bool box = find_box(names).has_value();
  if (has(names, "x1") && has(names, "y1")) {
    const bool more = has(names, "x3") || (has(names, "x0") && has(names, "x2"));
    return box && !more && has_detections(names) ? boxes : idtracker_wide;
  }
  if (has(names, "frame") && has_centroid(names, 'X') && has_centroid(names, 'Y')) return trex;
  return box && find_role(names, ColumnRole::frame) >= 0 ? boxes : automatic;
}

/// Names that would be those of the tidy format in small letters: "; in small letters 'X' ..."
std::string tidy_if_small(const Names& names) {
  Names small, changed;
  for (const std::string& name : names) {
    small.push_back(in_small_letters(name));
    if (small.back() != name) changed.push_back(name);
  }
  const bool tidy = format_of_header(small) == RecordingFormat::tidy && !changed.empty();
  return tidy ? "; with " + quoted_names(changed) + " in small letters it would be tidy" : "";
}

/// What a table without names may be.
std::string without_names(const Table& table) {
  if (!table.header().empty()) return "";
  const bool mot = table.names().size() >= 6;
  return std::string("; it has no line of names") +
         (mot ? "; format = \"boxes\" reads frame, id, left, top, width, height, ... of MOT "
                "challenge"
              : "");
}

/// x and y beside a width and a height may be the middle of a box or its corner.
void refuse_ambiguous_box(const Names& names, const SourcePlace& place) {
  if (!has_ambiguous_box(names)) return;
  throw InputError(
      place,
      "x, y beside a width and a height may be the middle of a box or a corner: "
      "format = \"table\" reads the middle, format = \"boxes\" the corner of least x and "
      "y; there are " +
          short_list(names));
}

}  // namespace

bool one_file_a_track(RecordingFormat format) {
  return format == RecordingFormat::swistrack_tracks || format == RecordingFormat::trex;
}

RecordingFormat detect_format(const Table& table) {
  using Format = RecordingFormat;
  if (trimmed(table.header()).starts_with("% Frame number")) {
    const bool particles = table.header().find("(world)") != std::string::npos;
    return particles ? Format::swistrack_particles : Format::swistrack_tracks;
  }
  const SourcePlace place{table.file(), table.header_line(), 1};
  const Names& names = table.names();
  const RecordingFormat format = format_of_header(names);
  refuse_ambiguous_box(names, place);
  if (format != Format::automatic) return format;
  throw InputError(place,
                   "these columns are of no format that is known: name the format, or say what "
                   "the columns mean (format = \"table\")" +
                       tidy_if_small(names) + without_names(table) + suggested_keys(names) +
                       "; there are " + short_list(names));
}

void read_sightings(LineSource& lines, const RecordingOptions& options, Sightings& out) {
  Table table(lines, options.layout);
  if (out.format == RecordingFormat::automatic) out.format = detect_format(table);
  out.files.push_back(lines.file());
  out.most_rows = options.most_rows;
  read_columns(table, options, out);
  out.comment_lines += table.comment_lines();
}

Sightings read_sightings(const std::vector<std::string>& files, const RecordingOptions& options) {
  Sightings out;
  out.format = options.format;
  for (const std::string& file : files) {
    LineSource lines(file);
    read_sightings(lines, options, out);
  }
  return out;
}

}  // namespace lilytank
