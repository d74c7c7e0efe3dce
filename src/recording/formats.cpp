#include "recording/formats.hpp"

#include <algorithm>

#include "io/table.hpp"
#include "recording/columns.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

bool has(const std::vector<std::string_view>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool all_of(const std::vector<std::string_view>& names,
            std::initializer_list<std::string_view> wanted) {
  return std::all_of(wanted.begin(), wanted.end(), [&](auto name) { return has(names, name); });
}

RecordingFormat format_of_header(const std::vector<std::string_view>& names) {
  using enum RecordingFormat;
  if (all_of(names, {"xBody", "yBody", "imageNumber", "id"})) return fasttrack;
  if (all_of(names, {"frame", "individual", "x", "y"})) return idtracker;
  if (all_of(names, {"frame", "particle", "x", "y"})) return trackpy;
  if (all_of(names, {"id", "x", "y"}) && (has(names, "frame") || has(names, "time"))) return tidy;
  if (has(names, "x1") && has(names, "y1")) return idtracker_wide;
  const auto centroid = [&](char axis) {
    return std::any_of(names.begin(), names.end(), [&](std::string_view name) {
      const std::string_view rest = name.substr(std::min<std::size_t>(1, name.size()));
      return name.starts_with(axis) &&
             (rest.empty() || rest.starts_with('#') || rest.starts_with(" ("));
    });
  };
  if (has(names, "frame") && centroid('X') && centroid('Y')) return trex;
  return automatic;
}

/// Names that would be those of the tidy format in small letters: "; in small letters 'X' ..."
std::string tidy_if_small(const std::vector<std::string_view>& names) {
  std::vector<std::string> small;
  std::string changed;
  for (const std::string_view name : names) {
    small.push_back(in_small_letters(name));
    if (small.back() != name) changed += (changed.empty() ? "'" : ", '") + std::string(name) + "'";
  }
  const bool tidy = format_of_header({small.begin(), small.end()}) == RecordingFormat::tidy;
  return tidy ? "; with " + changed + " in small letters it would be tidy" : "";
}

}  // namespace

bool one_file_a_track(RecordingFormat format) {
  return format == RecordingFormat::swistrack_tracks || format == RecordingFormat::trex;
}

RecordingFormat detect_format(const Table& table) {
  const std::vector<std::string_view> names(table.names().begin(), table.names().end());
  auto format = RecordingFormat::automatic;
  if (trimmed(table.header()).starts_with("% Frame number")) {
    const bool particles = table.header().find("(world)") != std::string::npos;
    format = particles ? RecordingFormat::swistrack_particles : RecordingFormat::swistrack_tracks;
  } else {
    format = format_of_header(names);
  }
  if (format == RecordingFormat::automatic) {
    throw InputError({table.file(), table.header_line(), 1},
                     "these columns are of no format that is known: name the format, or say what "
                     "the columns mean (format = \"table\")" +
                         tidy_if_small(names));
  }
  return format;
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
