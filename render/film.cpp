// Films and stills: the same frames, sent to ffmpeg or written one by one.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "ffmpeg.hpp"
#include "frame.hpp"
#include "io/atomic_file.hpp"
#include "io/temporary_file.hpp"

namespace lilytank {
namespace {

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

bool stopped(const FilmOptions& options) {
  return options.stop && options.stop->load();
}

void report(const FilmOptions& options, int done, int frames) {
  if (options.progress) options.progress(static_cast<double>(done) / frames);
}

bool is_gif(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending == ".gif") return true;
  if (ending == ".mp4") return false;
  throw InputError("cannot determine the film's format from '" + file +
                   "': its name must end in .mp4 or .gif");
}

// A label of the film's speed makes sense only where one was asked for or follows.
double shown_speed(const Schedule& s) {
  return s.frames > 1 ? s.speed : 0;
}

}  // namespace

void draw_film(const StoredRun& run, const FilmOptions& options, const std::string& file) {
  const bool gif = is_gif(file);
  const Schedule when = schedule(run, options);
  // H.264 with half-resolution colour needs even sizes.
  FrameRaster raster(run, options.style, shown_speed(when), options.style.size / 2 * 2);
  TemporaryFile unfinished(file);
  const int palette = gif ? std::min(kMostPaletteFrames, when.frames) : 0;
  Ffmpeg ffmpeg({raster.width(), raster.height(), options.fps, gif, palette}, unfinished.name());
  for (int k = 0; k < palette; ++k) {
    if (stopped(options)) return;  // ffmpeg and the file go away
    const double share = palette > 1 ? static_cast<double>(k) / (palette - 1) : 0;
    ffmpeg.send(raster.draw(when.time(static_cast<int>(share * (when.frames - 1)))).pixels());
  }
  for (int k = 0; k < when.frames; ++k) {
    if (stopped(options)) return;
    ffmpeg.send(raster.draw(when.time(k)).pixels());
    report(options, k + 1, when.frames);
  }
  ffmpeg.finish();
  unfinished.complete();
  unfinished.publish();
}

std::vector<double> film_times(const StoredRun& run, const FilmOptions& options) {
  const Schedule when = schedule(run, options);
  std::vector<double> times;
  for (int k = 0; k < when.frames; ++k) times.push_back(when.time(k));
  return times;
}

void draw_stills(const StoredRun& run, const FilmOptions& options, const std::string& dir) {
  const Schedule when = schedule(run, options);
  FrameRaster raster(run, options.style, shown_speed(when), options.style.size);
  make_directory(dir);
  for (int k = 0; k < when.frames && !stopped(options); ++k) {
    char name[40];
    std::snprintf(name, sizeof name, "frame_%06d.png", k);
    write_atomically((std::filesystem::path(dir) / name).string(),
                     raster.draw(when.time(k)).encoded());
    report(options, k + 1, when.frames);
  }
}

}  // namespace lilytank
