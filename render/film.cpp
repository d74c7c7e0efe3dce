// Films and stills: the same frames, sent to ffmpeg or written one by one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

#include "ffmpeg.hpp"
#include "frame.hpp"
#include "io/atomic_file.hpp"
#include "io/temporary_file.hpp"
#include "text/fnv.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

constexpr int kMostPaletteFrames = 24;

// When each frame is.
struct Schedule {
  double from = 0, step = 0, to = 0;  // s of simulated time
  double speed = 0;
  int frames = 0;
  double time(int frame) const { return std::min(to, from + frame * step); }
};

Schedule schedule(const StoredRun& run, const FilmOptions& options) {
  const Trajectory& t = run.trajectory;
  check_time(t, t.time.empty() ? 0 : t.time.back());
  if (!(options.fps >= 1 && options.fps <= 240)) {
    throw InputError("a film has 1 .. 240 frames per second, not " + std::to_string(options.fps));
  }
  if (!(options.speed >= 0) || !std::isfinite(options.speed)) {
    throw InputError("a film's speed must be above 0, or 0 for the usual length");
  }
  Schedule s;
  s.from = std::max(options.from, t.time.front());
  s.to = options.to < 0 ? t.time.back() : options.to;
  check_time(t, options.from > t.time.front() ? options.from : t.time.front());
  check_time(t, s.to);
  if (!(s.to >= s.from)) throw InputError("a film cannot end before it begins");
  const double length = s.to - s.from;
  s.speed = options.speed > 0 ? options.speed : length / options.length;
  if (!(s.speed > 0)) s.speed = 1;  // a single moment
  s.step = s.speed / options.fps;
  const double frames = std::max(1.0, std::round(length / s.step));
  if (frames > 10e6) throw InputError("this film would have more than ten million frames");
  s.frames = static_cast<int>(frames);
  return s;
}

void check_drawing(const JobControl& control) {
  if (control.stop_requested()) throw Stopped("stopped while drawing");
}

void report_frames(const JobControl& control, int done, int frames) {
  control.report(static_cast<double>(done) / frames, "of the film");
}

bool is_gif(const std::string& file) {
  const std::string ending = in_small_letters(fs::path(file).extension().string());
  if (ending == ".gif") return true;
  if (ending == ".mp4") return false;
  throw InputError("cannot determine the film's format from '" + file +
                   "': its name must end in .mp4 or .gif");
}

// A label of the film's speed makes sense only where one is given or follows.
double shown_speed(const Schedule& s) {
  return s.frames > 1 ? s.speed : 0;
}

constexpr const char* kFilmMark = "lilytank film ";

/// Whether a regular file exists and holds a text.
bool holds(const std::string& file, const std::string& text) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored) && read_whole(file).find(text) != std::string::npos;
}

/// What decides every pixel of a film: the run's scenario and poses, and the options.
std::string mark_of(const StoredRun& run, const FilmOptions& options, const Schedule& when) {
  const Trajectory& t = run.trajectory;
  const FrameStyle& style = options.style;
  Fnv hash;
  hash.add(hex(run.scenario.identity));
  hash.add(t.time);
  for (const auto* values : {&t.x, &t.y, &t.theta}) {
    hash.add({reinterpret_cast<const char*>(values->data()), values->size() * sizeof(float)});
  }
  hash.add(std::array{when.from, when.to, when.step, options.fps, style.trail,
                      static_cast<double>(style.size), static_cast<double>(style.flow),
                      static_cast<double>(style.labels), static_cast<double>(style.panel)});
  return kFilmMark + hex(hash.value());
}

std::string still_name(int frame) {
  char name[40];
  std::snprintf(name, sizeof name, "frame_%06d.png", frame);
  return name;
}

/// Numbers of the frames in a directory and their files.
std::map<int, std::string> stills_in(const std::string& dir) {
  std::map<int, std::string> stills;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(dir, ignored)) {
    const std::string name = entry.path().filename().string();
    int frame = 0;
    const bool still = std::sscanf(name.c_str(), "frame_%d.png", &frame) == 1;
    if (still && name == still_name(frame)) stills[frame] = entry.path().string();
  }
  return stills;
}

}  // namespace

void check_film(const StoredRun& run, const FilmOptions& options, const std::string& file) {
  std::error_code ignored;
  if (options.force || !fs::is_regular_file(file, ignored)) return;
  if (!holds(file, mark_of(run, options, schedule(run, options)))) refuse_to_replace(file);
}

void draw_film(const StoredRun& run, const FilmOptions& options, const std::string& file) {
  check_film(run, options, file);
  const bool gif = is_gif(file);
  const Schedule when = schedule(run, options);
  const std::string mark = mark_of(run, options, when);
  // H.264 with half-resolution colour needs even sizes.
  FrameRaster raster(run, options.style, shown_speed(when), options.style.size / 2 * 2);
  TemporaryFile unfinished(file);
  const int palette = gif ? std::min(kMostPaletteFrames, when.frames) : 0;
  Ffmpeg ffmpeg({raster.width(), raster.height(), options.fps, gif, palette, mark},
                unfinished.name());
  for (int k = 0; k < palette; ++k) {
    check_drawing(options);  // ffmpeg and the file go away
    const double share = palette > 1 ? static_cast<double>(k) / (palette - 1) : 0;
    ffmpeg.send(raster.draw(when.time(static_cast<int>(share * (when.frames - 1)))).pixels());
  }
  for (int k = 0; k < when.frames; ++k) {
    check_drawing(options);
    ffmpeg.send(raster.draw(when.time(k)).pixels());
    report_frames(options, k + 1, when.frames);
  }
  ffmpeg.finish();
  unfinished.complete();
  unfinished.publish();
}

bool is_film(const std::string& file) {
  return holds(file, kFilmMark);
}

std::vector<double> film_times(const StoredRun& run, const FilmOptions& options) {
  const Schedule when = schedule(run, options);
  std::vector<double> times;
  for (int k = 0; k < when.frames; ++k) times.push_back(when.time(k));
  return times;
}

void check_stills(const StoredRun& run, const FilmOptions& options, const std::string& dir) {
  if (options.force) return;
  const Schedule when = schedule(run, options);
  FrameRaster raster(run, options.style, shown_speed(when), options.style.size);
  for (const auto& [frame, file] : stills_in(dir)) {
    if (frame >= when.frames || holds_other(file, raster.draw(when.time(frame)).encoded()))
      refuse_to_replace(file);
  }
}

void draw_stills(const StoredRun& run, const FilmOptions& options, const std::string& dir) {
  const Schedule when = schedule(run, options);
  check_stills(run, options, dir);
  if (options.force) {
    for (const auto& [frame, file] : stills_in(dir)) fs::remove(file);
  }
  FrameRaster raster(run, options.style, shown_speed(when), options.style.size);
  make_directory(dir);
  for (int k = 0; k < when.frames; ++k) {
    check_drawing(options);
    write_atomically((fs::path(dir) / still_name(k)).string(), raster.draw(when.time(k)).encoded());
    report_frames(options, k + 1, when.frames);
  }
}

}  // namespace lilytank
