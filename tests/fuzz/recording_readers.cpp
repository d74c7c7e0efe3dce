#include "fuzz/readers.hpp"

#include <cmath>
#include <vector>

#include "io/toml_text.hpp"
#include "recording/formats.hpp"
#include "recording/gzip.hpp"
#include "recording/recording_keys.hpp"

namespace lilytank::fuzz {
namespace {

/// What every recording that is read promises.
void check_promises(const CheckedRecording& checked) {
  const Recording& r = checked.recording;
  const auto demand = [](bool right) { fuzz::demand(right, "a recording keeps its promises"); };
  demand(checked.refused() == r.tracks.empty());
  demand(r.tracks.empty() || (r.rate > 0 && std::isfinite(r.start)));
  for (const Track& t : r.tracks) {
    demand(t.first >= 0 && t.last() < r.frames && !t.x.empty() && t.y.size() == t.x.size());
    demand(t.theta.empty() != r.has_heading() && (t.theta.empty() || t.theta.size() == t.x.size()));
    demand(std::isfinite(t.x.front()) && std::isfinite(t.x.back()));
    for (std::size_t i = 0; i < t.x.size(); ++i) {
      demand(std::isnan(t.x[i]) == std::isnan(t.y[i]));
      demand(t.theta.empty() || std::isnan(t.x[i]) == std::isnan(t.theta[i]));
    }
  }
  for (const Finding& finding : checked.findings) demand(!finding.text().empty());
}

/// Reads bytes as a file of a format; `lenient`: no check refuses, so all of them run.
bool read_as(RecordingFormat format, std::string_view bytes, bool lenient) {
  RecordingOptions options;
  options.format = format;
  options.rate = lenient ? 30 : 0;
  options.body_radius = 0.0175;
  options.calibration.circle_radius = 200;
  if (format == RecordingFormat::table) options.columns = {"-", "time", "-", "x", "y", "theta"};
  if (lenient) {
    options.rules[Check::units] = options.rules[Check::clock] = Treatment::mark;
    options.rules[Check::duplicate] = Treatment::split;
  }
  return accepts("track00000007.csv", [&] {
    LineSource lines(bytes, "track00000007.csv");
    Sightings sightings;
    sightings.format = format;
    read_sightings(lines, options, sightings);
    check_promises(process(std::move(sightings), options));
  });
}

template <RecordingFormat format>
bool read_format(std::string_view bytes) {
  const bool strict = read_as(format, bytes, false);
  return read_as(format, bytes, true) || strict;
}

/// A file of these bytes, which may be compressed or not.
bool read_compressed(std::string_view bytes) {
  const std::string file = write_scratch("recording.gz", bytes);
  return accepts(file, [&] { check_promises(check_recording(file)); });
}

/// The [[recording]] tables of an experiment file.
bool read_keys(std::string_view bytes) {
  return accepts("experiment.toml", [&] {
    const toml::table root = parse_toml(std::string(bytes), "experiment.toml");
    RecordingOptions options;
    for (const auto& [key, node] : root) {
      const SourcePlace place = place_of(node.source(), "experiment.toml");
      const Assignment a{{std::string(key.str())}, {place}, value_of(node), place, "", ""};
      accepts("experiment.toml", [&] { assign_recording_option(a, "recording", options); });
    }
  });
}

/// A small recording in a format's own words: two bodies, one gap, one that comes late.
std::string rows(const std::string& head, const std::string& row, char separator) {
  std::string out = head + "\n";
  for (int f = 0; f < 12; ++f) {
    for (int b = 0; b < 2; ++b) {
      if (b == 1 && (f < 2 || f == 6)) continue;
      for (const char c : row) {
        const double angle = 0.2 * f + b;
        switch (c) {
          case 'f':
            out += std::to_string(f);
            break;
          case 't':
            out += std::to_string(f / 30.0);
            break;
          case 'd':
            out += "2009-11-01T12:00:0" + std::to_string(f / 30.0);
            break;
          case 'i':
            out += std::to_string(b);
            break;
          case 'x':
            out += std::to_string((0.05 + 0.05 * b) * std::cos(angle));
            break;
          case 'y':
            out += std::to_string((0.05 + 0.05 * b) * std::sin(angle));
            break;
          case 'a':
            out += std::to_string(std::remainder(angle, 6.28318));
            break;
          default:
            out += c;
        }
        out += separator;
      }
      out.back() = '\n';
    }
  }
  return out;
}

}  // namespace

std::vector<Reader> recording_readers() {
  using enum RecordingFormat;
  const std::string tidy_rows = rows("frame,time,id,x,y,theta", "ftixya", ',');
  return {
      {"automatic", read_format<automatic>, tidy_rows},
      {"tidy", read_format<tidy>, tidy_rows},
      {"swistrack-tracks", read_format<swistrack_tracks>,
       rows("% Frame number  x  y", "fxy", '\t')},
      {"swistrack-particles", read_format<swistrack_particles>,
       rows("% Frame number\tTime\tX (image)\tY (image)\tX (world)\tY (world)\tArea\t"
            "Orientation\tCompactness\t",
            "fd00xy1a1", '\t')},
      {"trackpy", read_format<trackpy>, rows("y,x,mass,frame,particle", "yx1fi", ',')},
      {"idtracker", read_format<idtracker>,
       rows("frame,time,individual,x,y,probability", "ftixy1", ',')},
      {"idtracker-wide", read_format<idtracker_wide>,
       "time,x1,y1,x2,y2\n0,1,2,3,4\n0.1,1,2,nan,nan\n0.2,1,2.5,3,4.5\n0.3,1,2,3,4\n"},
      {"boxes", read_format<boxes>,
       "frame,id,x1,y1,x2,y2,conf\n0,1,1,2,3,4,1\n1,1,1,2,3.5,4,1\n2,,1,2,3,4,1\n4,1,nan,2,3,4,"
       "1\n"},
      {"trex", read_format<trex>,
       rows("frame,X#wcentroid (cm),Y#wcentroid (cm),ANGLE,time,missing", "fxyat0", ',')},
      {"fasttrack", read_format<fasttrack>,
       rows("xBody\tyBody\ttBody\timageNumber\tid", "xyafi", '\t')},
      {"table", read_format<table>, rows("time;x;y;theta;note", "txyai", ';')},
      {"compressed", read_compressed, gzipped(tidy_rows)},
      {"keys", read_keys,
       "file = \"a.csv\"\nformat = \"table\"\ncolumns.x = \"px\"\npixel = \"0.5 mm\"\n"
       "tank_circle = [1, 2.5, 3]\nchecks = {gap = \"split\", fastest = \"1 m/s\"}\n"},
  };
}

}  // namespace lilytank::fuzz
