#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>

#include "io/atomic_file.hpp"
#include "lilytank/math.hpp"
#include "lilytank/recording_io.hpp"
#include "recording/formats.hpp"
#include "recording/gzip.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

constexpr double kPlaces = 1e-7;  // m, how fine positions are written
constexpr int kAngleDigits = 6;
constexpr int kTimeDigits = 4;

/// Text that grows by cells.
class Cells {
 public:
  explicit Cells(char separator) : separator_(separator) {}
  Cells& word(std::string_view text) {
    begin();
    text_ += text;
    return *this;
  }
  Cells& whole(std::int64_t value) { return word(std::to_string(value)); }
  Cells& fixed(double value, int digits) {
    char buffer[400];
    const auto end =
        std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, digits).ptr;
    return word({buffer, static_cast<std::size_t>(end - buffer)});
  }
  void end_row() { text_ += '\n', first_ = true; }
  std::string take() { return std::move(text_); }

 private:
  void begin() {
    if (!first_) text_ += separator_;
    first_ = false;
  }
  std::string text_;
  char separator_;
  bool first_ = true;
};

/// A body in a frame, in the file's units.
struct Seen {
  int frame;
  double time;
  std::int64_t id;
  double x, y, theta;
};

class Writer {
 public:
  Writer(const Recording& recording, RecordingFormat format, const Calibration& calibration)
      : r_(recording), format_(format), c_(calibration) {
    using enum RecordingFormat;
    const bool pixels =
        format == trackpy || format == idtracker || format == idtracker_wide || format == fasttrack;
    if (pixels && !(c_.pixel > 0)) {
      throw InputError("the format " + format_word(format) +
                       " is in pixels: say how large one is, and where the tank is, as by --write "
                       "pixel='0.66 mm' --write origin=[640,480]");
    }
    if (format == trex && c_.pixel == 0) c_.pixel = 0.01;
    if (c_.pixel == 0) c_.pixel = 1;
    const bool down = pixels || format == trex;
    y_ = c_.y_axis == YAxis::down || (c_.y_axis == YAxis::by_format && down) ? -1 : 1;
    angle_ = format == fasttrack && c_.y_axis == YAxis::by_format ? 1 : y_;
    if (c_.angles == AngleUnit::degrees) angle_ *= 180 / kPi;
    digits_ = std::clamp(static_cast<int>(std::ceil(std::log10(c_.pixel / kPlaces) - 1e-9)), 0, 12);
  }

  /// Names and contents of the files; the one without a name is the whole recording.
  std::map<std::string, std::string> files() const {
    using enum RecordingFormat;
    switch (format_) {
      case swistrack_tracks:
        return by_track(&Writer::swistrack_track, "track", 8);
      case swistrack_particles:
        return {{"", particles_text()}};
      case trackpy:
        return {{"", trackpy_text()}};
      case idtracker:
        return {{"", idtracker_text()}};
      case idtracker_wide:
        return {{"", wide_text()}};
      case trex:
        return by_track(&Writer::trex_track, r_.name + "_id", 0);
      case fasttrack:
        return {{"", fasttrack_text()}};
      default:
        return {{"", tidy_text()}};
    }
  }

 private:
  Seen at(const Track& track, std::size_t i) const {
    const int frame = track.first + static_cast<int>(i);
    const double x = track.x[i] / c_.pixel + c_.origin_x;
    const double y = y_ * track.y[i] / c_.pixel + c_.origin_y;
    return {frame, r_.time(frame), track.id, x, y, track.theta.empty() ? 0 : track.theta[i]};
  }
  /// In (-half a turn, half a turn].
  double heading(double theta) const {
    return angle_ * (theta - 2 * kPi * std::ceil(theta / (2 * kPi) - 0.5));
  }

  /// Calls visit(seen) by frame, then id.
  template <class Visit>
  void for_each_seen(const Visit& visit) const {
    for (int f = 0; f < r_.frames; ++f) {
      for (const Track& track : r_.tracks) {
        if (f < track.first || f > track.last()) continue;
        const auto i = static_cast<std::size_t>(f - track.first);
        if (!std::isnan(track.x[i])) visit(at(track, i));
      }
    }
  }

  std::string tidy_text() const {
    const bool headings = r_.has_heading();
    Cells out(',');
    for (const char* name : {"frame", "time", "id", "x", "y"}) out.word(name);
    if (headings) out.word("theta");
    out.end_row();
    for_each_seen([&](const Seen& s) {
      out.whole(s.frame).fixed(s.time, kTimeDigits).whole(s.id);
      out.fixed(s.x, digits_).fixed(s.y, digits_);
      if (headings) out.fixed(heading(s.theta), kAngleDigits);
      out.end_row();
    });
    return out.take();
  }

  std::string trackpy_text() const {
    Cells out(',');
    for (const char* name : {"", "y", "x", "frame", "particle"}) out.word(name);
    out.end_row();
    std::int64_t row = 0;
    for_each_seen([&](const Seen& s) {
      out.whole(row++).fixed(s.y, digits_).fixed(s.x, digits_).whole(s.frame).whole(s.id);
      out.end_row();
    });
    return out.take();
  }

  std::string idtracker_text() const {
    Cells out(',');
    for (const char* name : {"frame", "time", "individual", "x", "y", "probability"}) {
      out.word(name);
    }
    out.end_row();
    for_each_seen([&](const Seen& s) {
      out.whole(s.frame).fixed(s.time, kTimeDigits).whole(s.id);
      out.fixed(s.x, digits_).fixed(s.y, digits_).word("1.0").end_row();
    });
    return out.take();
  }

  // Bodies are columns; tracks of one body are never in the same frame.
  std::string wide_text() const {
    std::map<std::int64_t, std::vector<const Track*>> bodies;
    for (const Track& track : r_.tracks) bodies[track.id].push_back(&track);
    Cells out(',');
    out.word("time");
    for (const auto& [id, tracks] : bodies) {
      out.word("x" + std::to_string(id)).word("y" + std::to_string(id));
    }
    out.end_row();
    for (int f = 0; f < r_.frames; ++f) {
      out.fixed(r_.time(f), kTimeDigits);
      for (const auto& [id, tracks] : bodies) wide_cells(tracks, f, out);
      out.end_row();
    }
    return out.take();
  }

  void wide_cells(const std::vector<const Track*>& tracks, int f, Cells& out) const {
    for (const Track* track : tracks) {
      if (f < track->first || f > track->last()) continue;
      const auto i = static_cast<std::size_t>(f - track->first);
      if (std::isnan(track->x[i])) break;
      const Seen s = at(*track, i);
      out.fixed(s.x, digits_).fixed(s.y, digits_);
      return;
    }
    out.word("nan").word("nan");
  }

  // Head, tail and body are one place; what lilytank does not know is 0.
  std::string fasttrack_text() const {
    Cells out('\t');
    for (const char* part : {"Head", "Tail", "Body"}) {
      for (const char* of : {"x", "y", "t"}) out.word(std::string(of) + part);
    }
    for (const char* name : {"curvature", "areaBody", "perimeterBody"}) out.word(name);
    for (const char* part : {"head", "tail", "body"}) {
      for (const char* of : {"MajorAxisLength", "MinorAxisLength", "Excentricity"}) {
        out.word(std::string(part) + of);
      }
    }
    out.word("imageNumber").word("id").end_row();
    for_each_seen([&](const Seen& s) {
      const double theta = heading(s.theta);
      for (int part = 0; part < 3; ++part) {
        out.fixed(s.x, digits_).fixed(s.y, digits_);
        out.fixed(theta < 0 ? theta + 2 * kPi * std::fabs(angle_) : theta, kAngleDigits);
      }
      for (int i = 0; i < 12; ++i) out.word("0");
      out.whole(s.frame).whole(s.id).end_row();
    });
    return out.take();
  }

  std::string particles_text() const {
    Cells out('\t');
    for (const char* name : {"% Frame number", "Time", "X (image)", "Y (image)", "X (world)",
                             "Y (world)", "Area", "Orientation", "Compactness", ""}) {
      out.word(name);
    }
    out.end_row();
    for_each_seen([&](const Seen& s) {
      out.whole(s.frame).word(date_text(s.time)).word("0").word("0");
      out.fixed(s.x, digits_).fixed(s.y, digits_).word("0").fixed(s.theta, kAngleDigits).word("0");
      out.end_row();
    });
    return out.take();
  }

  /// A moment of the first day of 1970 and after it, to a millisecond.
  static std::string date_text(double seconds) {
    const auto ms = static_cast<std::int64_t>(std::floor(1000 * seconds + 0.5));
    const std::int64_t of_day = ((ms % 86400000) + 86400000) % 86400000;
    char text[64];
    std::snprintf(text, sizeof text, "1970-01-%02dT%02d:%02d:%02d.%03d",
                  static_cast<int>(1 + (ms / 86400000) % 28), static_cast<int>(of_day / 3600000),
                  static_cast<int>(of_day / 60000 % 60), static_cast<int>(of_day / 1000 % 60),
                  static_cast<int>(of_day % 1000));
    return text;
  }

  /// One file an id, "track00000003.csv": the numbers with at least so many digits.
  std::map<std::string, std::string> by_track(
      std::string (Writer::*text)(const std::vector<const Track*>&) const, const std::string& name,
      std::size_t digits) const {
    std::map<std::int64_t, std::vector<const Track*>> bodies;
    for (const Track& track : r_.tracks) bodies[track.id].push_back(&track);
    std::map<std::string, std::string> out;
    for (const auto& [id, tracks] : bodies) {
      std::string number = std::to_string(id);
      if (number.size() < digits) number.insert(0, digits - number.size(), '0');
      out[name + number + ".csv"] = (this->*text)(tracks);
    }
    return out;
  }

  std::string swistrack_track(const std::vector<const Track*>& tracks) const {
    Cells out('\t');
    out.word("% Frame number  x  y").end_row();
    for (const Track* track : tracks) {
      for (std::size_t i = 0; i < track->x.size(); ++i) {
        if (std::isnan(track->x[i])) continue;
        const Seen s = at(*track, i);
        out.whole(s.frame).fixed(s.x, digits_).fixed(s.y, digits_).end_row();
      }
    }
    return out.take();
  }

  std::string trex_track(const std::vector<const Track*>& tracks) const {
    Cells out(',');
    for (const char* name :
         {"frame", "X#wcentroid (cm)", "Y#wcentroid (cm)", "ANGLE", "time", "missing"}) {
      out.word(name);
    }
    out.end_row();
    int next = tracks.front()->first;
    for (const Track* track : tracks) {
      for (; next <= track->last(); ++next) {
        const auto i = static_cast<std::size_t>(std::max(0, next - track->first));
        const bool seen = next >= track->first && !std::isnan(track->x[i]);
        out.whole(next);
        if (seen) {
          const Seen s = at(*track, i);
          out.fixed(s.x, digits_).fixed(s.y, digits_).fixed(heading(s.theta), kAngleDigits);
        } else {
          out.word("inf").word("inf").word("inf");
        }
        out.fixed(r_.time(next), kTimeDigits).word(seen ? "0" : "1").end_row();
      }
    }
    return out.take();
  }

  const Recording& r_;
  RecordingFormat format_;
  Calibration c_;
  double y_ = 1, angle_ = 1;
  int digits_ = 7;
};

/// A directory is read whole: what is there beside the new files would be taken for tracks of
/// theirs.
void refuse_others(const std::string& dir, const std::map<std::string, std::string>& files) {
  std::error_code problem;
  std::string first;
  for (const auto& entry : fs::directory_iterator(dir, problem)) {
    const std::string name = entry.path().filename().string();
    const bool read = entry.is_regular_file(problem) && !name.starts_with('.');
    if (!read || files.contains(name)) continue;
    if (first.empty() || name < first) first = name;
  }
  if (first.empty()) return;
  throw InputError("'" + dir + "' holds '" + first +
                   "', which would be read as one of the new tracks: choose a directory without "
                   "other files, or remove them");
}

}  // namespace

NamedContents recording_files(const Recording& recording, const std::string& file,
                              RecordingFormat format, const Calibration& calibration) {
  auto files = Writer(recording, format, calibration).files();
  const bool many = one_file_a_track(format);
  if (many) refuse_others(file, files);
  NamedContents out;
  for (auto& [name, text] : files) {
    std::string path = many ? (fs::path(file) / name).string() : file;
    if (path.ends_with(".gz")) text = gzipped(text);
    out.emplace_back(std::move(path), std::move(text));
  }
  return out;
}

void write_recording(const Recording& recording, const std::string& file, RecordingFormat format,
                     const Calibration& calibration) {
  const NamedContents files = recording_files(recording, file, format, calibration);
  if (one_file_a_track(format)) make_directory(file);
  write_together(files);
}

}  // namespace lilytank
