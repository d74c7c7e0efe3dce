#include "cli/options.hpp"

#ifdef LILYTANK_HAS_RENDER
#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <iostream>
#include <limits>

#include "cli/progress.hpp"
#include "cli/stored_poses.hpp"
#include "io/atomic_file.hpp"
#include "io/units.hpp"
#include "lilytank/render.hpp"
#endif

namespace lilytank::cli {
#ifdef LILYTANK_HAS_RENDER
namespace {

FlowStyle flow_style(const VerbOptions& options) {
  const std::vector<std::string> words{"none", "arrows", "streamlines"};
  const std::string word = options.text("flow", "streamlines");
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (word == words[i]) return static_cast<FlowStyle>(i);
  }
  options.refuse("--flow " + word + " is none of none, arrows, streamlines" +
                 did_you_mean(word, words));
}

FilmOptions film_options(const VerbOptions& options) {
  FilmOptions film;
  film.from = options.number("from", 0, 0, kLongest, "s");
  film.to = options.number("to", -1, 0, kLongest, "s");
  film.fps = options.number("fps", film.fps, 1, 240);
  film.speed = options.number("speed", film.speed, 1e-3, 1e6);
  film.style.size = static_cast<int>(options.whole("size", film.style.size, 120, 4320));
  film.style.flow = flow_style(options);
  film.style.trail = options.number("trail", film.style.trail, 0, 3600, "s");
  film.style.labels = !options.has("no-labels");
  film.force = options.has("force");
  if (film.to >= 0 && film.to <= film.from) options.refuse("--to is not after --from");
  return film;
}

void check_ending(const VerbOptions& options, const std::string& name) {
  const std::string file = options.text(name);
  if (options.has(name) && !file.ends_with("." + name)) {
    options.refuse("--" + name + " " + file + " does not end with ." + name);
  }
}

bool asks_for(const VerbOptions& options, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(), [&](const char* n) { return options.has(n); });
}

/// Says so where poses were stored too seldom for the requested frame or film.
void warn_if_seldom(const VerbOptions& options, const StoredRun& run, const FilmOptions& film,
                    double at) {
  const bool frame = asks_for(options, {"png", "svg"});
  std::string note;
  if (frame) note = too_seldom_to_draw(run, {at});
  if (note.empty() && (!frame || asks_for(options, {"mp4", "gif", "stills"}))) {
    note = too_seldom_to_draw(run, film_times(run, film));
  }
  std::cerr << note;
}

/// Draws the requested pictures and films. A picture that would be refused is found before a film
/// is drawn, and written after it.
void draw_all(const VerbOptions& options, const std::string& dir, FilmOptions film) {
  const StoredRun run = load_run(dir);
  const double at = options.number("at", run.trajectory.time.back(), 0, kLongest, "s");
  warn_if_seldom(options, run, film, at);
  Progress progress(options.has("quiet"));
  progress.watch(film);
  NamedContents pictures;
  std::vector<std::string> made;
  for (const char* name : {"png", "svg"}) {
    if (!options.has(name)) continue;
    const std::string file = options.text(name);
    pictures.emplace_back(file, frame_picture(run, at, film.style, file));
    if (!film.force && holds_other(file, pictures.back().second)) refuse_to_replace(file);
    made.push_back(file);
  }
  std::vector<std::string> films;
  for (const char* name : {"mp4", "gif"}) {
    if (options.has(name)) films.push_back(options.text(name));
  }
  if (made.empty() && films.empty() && !options.has("stills")) {
    films.push_back((std::filesystem::path(dir) / "video.mp4").string());
  }
  for (const std::string& file : films) check_film(run, film, file);
  for (const std::string& file : films) {
    draw_film(run, film, file);
    made.push_back(file);
  }
  if (options.has("stills")) {
    draw_stills(run, film, options.text("stills"));
    made.push_back(options.text("stills"));
  }
  write_results(pictures, film.force);
  progress.clear();
  for (const std::string& file : made) std::cout << file << "\n";
}

}  // namespace
#endif

int render_verb(const Arguments& arguments) {
  VerbOptions options("render", "RUN", "Draws a run's directory: a film, stills or one frame.");
  const auto text = [] { return cxxopts::value<std::string>(); };
  options.add()("from", "begin of the film", text(), "TIME")("to", "its end", text(), "TIME")(
      "fps", "frames per second of the film (30)", text(), "N")(
      "speed", "simulated seconds per second of film (default: the film takes a minute)", text(),
      "X")("size", "height in pixels (1080)", text(), "N")("mp4", "a film", text(), "FILE")(
      "gif", "a film", text(), "FILE")("stills", "the film's frames as PNG files", text(), "DIR")(
      "png", "one frame", text(), "FILE")("svg", "one frame", text(), "FILE")(
      "at", "the frame's time (default: the end)", text(), "TIME")(
      "flow", "none, arrows or streamlines", text(), "WORD")("no-labels", "no states on modules")(
      "trail", "time of path drawn behind each body (4 s)", text(), "TIME")(
      "force", "replace files of other contents")("quiet", "no progress");
  if (!options.parse(arguments)) return Exit::done;
#ifdef LILYTANK_HAS_RENDER
  if (options.positional().size() != 1) {
    options.refuse("which run? write lilytank render RUN, as out/chain5-seed1");
  }
  for (const char* name : {"png", "svg", "mp4", "gif"}) check_ending(options, name);
  if (options.has("at") && !options.has("png") && !options.has("svg")) {
    options.refuse("--at goes with --png or --svg");
  }
  const FilmOptions film = film_options(options);
  draw_all(options, options.positional().front(), film);
  return Exit::done;
#else
  options.refuse("this program was built without the renderer (Cairo was not found)");
#endif
}

}  // namespace lilytank::cli
