#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <iostream>

#include "cli/inputs.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/results.hpp"
#include "io/atomic_file.hpp"
#include "io/units.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

#ifdef LILYTANK_HAS_RENDER
void take_style(const VerbOptions& options, const std::string& flow, FilmOptions& film) {
  if (flow == "none") film.style.flow = FlowStyle::none;
  if (flow == "arrows") film.style.flow = FlowStyle::arrows;
  film.style.labels = !options.has("no-labels");
  film.style.panel = !options.has("no-panel");
  if (film.to >= 0 && film.to <= film.from) options.refuse("--to is not after --from");
}

void check_ending(const VerbOptions& options, const std::string& name) {
  const std::string file = options.text(name);
  if (options.has(name) && !file.ends_with("." + name)) {
    options.refuse("--" + name + " " + file + " does not end with ." + name);
  }
}

bool any_given(const VerbOptions& options, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(), [&](const char* n) { return options.has(n); });
}

/// Says so where poses were stored too seldom for the requested frame or film.
void warn_if_seldom(const VerbOptions& options, const StoredRun& run, const FilmOptions& film,
                    double at) {
  const bool frame = any_given(options, {"png", "svg", "pdf"});
  std::string note;
  if (frame) note = too_seldom_to_draw(run, {at});
  if (note.empty() && (!frame || any_given(options, {"mp4", "gif", "stills"}))) {
    note = too_seldom_to_draw(run, film_times(run, film));
  }
  std::cerr << note;
}

void dry_run(const VerbOptions& options, const StoredRun& run, const FilmOptions& film,
             const std::vector<std::string>& files) {
  if (options.has("stills")) check_stills(run, film, options.text("stills"));
  for (const std::string& file : files) std::cout << "would draw " << file << "\n";
  if (options.has("stills")) std::cout << "would draw stills in " << options.text("stills") << "\n";
  if (any_given(options, {"mp4", "gif", "stills"}) || !any_given(options, {"png", "svg", "pdf"})) {
    const std::vector<double> times = film_times(run, film);
    std::cout << "the film has " << counted(std::ssize(times), "frame") << ", from "
              << significant(times.front(), 6) << " s to " << significant(times.back(), 6)
              << " s of the run\n";
  }
}

/// Draws the requested pictures and films. A picture that would be refused is found before a film
/// is drawn, and written after it.
void draw_all(const VerbOptions& options, const std::string& dir, FilmOptions film,
              const FigureStyle& paper, double at, bool quiet, const Host& host) {
  const StoredRun run = load_run(dir);
  if (!options.has("at")) at = run.trajectory.time.back();
  warn_if_seldom(options, run, film, at);
  Progress progress(quiet, host);
  progress.watch(film);
  NamedContents pictures;
  std::vector<std::string> made;
  const ReportProvenance origin{
      "lilytank render " + dir, LILYTANK_VERSION, std::to_string(run.scenario.seed), {}};
  for (const char* name : {"png", "svg", "pdf"}) {
    if (!options.has(name)) continue;
    const std::string file = options.text(name), caption = caption_file(file);
    pictures.emplace_back(file, frame_picture(run, at, film.style, file, paper));
    made.push_back(file);
    const auto same = [&](const auto& p) { return p.first == caption; };
    if (std::none_of(pictures.begin(), pictures.end(), same)) {
      pictures.emplace_back(caption, frame_caption(run, at, film.style, origin));
    }
  }
  for (const auto& [file, content] : pictures) {
    if (!film.force && holds_other(file, content)) refuse_to_replace(file);
  }
  std::vector<std::string> films;
  for (const char* name : {"mp4", "gif"}) {
    if (options.has(name)) films.push_back(options.text(name));
  }
  if (made.empty() && films.empty() && !options.has("stills")) {
    films.push_back((std::filesystem::path(dir) / "video.mp4").string());
  }
  for (const std::string& file : films) check_film(run, film, file);
  if (options.has("dry-run")) {
    made.insert(made.end(), films.begin(), films.end());
    return dry_run(options, run, film, made);
  }
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

#endif

void add_render_options(VerbOptions& options, FilmOptions& film, FigureStyle& paper,
                        std::string& flow, double& at) {
  FrameStyle& style = film.style;
  options.add({"from", "begin of the film", "TIME"}, &film.from, 0, kLongest, "s");
  options.add({"to", "its end", "TIME"}, &film.to, 0, kLongest, "s");
  options.add({"fps", "frames per second of the film (30)", "N"}, &film.fps, 1, 240);
  options.add(
      {"speed", "simulated seconds per second of film (default: the film takes a minute)", "X"},
      &film.speed, 1e-3, 1e6);
  options.add({"size", "height in pixels (1080)", "N"}, &style.size, 120, 4320);
  options.add({"mp4", "a film", "FILE"});
  options.add({"gif", "a film", "FILE"});
  options.add({"stills", "the film's frames as PNG files", "DIR"});
  options.add({"png", "one frame", "FILE"});
  options.add({"svg", "one frame", "FILE"});
  options.add({"pdf", "one frame", "FILE"});
  options.add({"at", "the frame's time (default: the end)", "TIME"}, &at, 0, kLongest, "s");
  options.add({"flow", "none, arrows or streamlines", "WORD"}, &flow,
              {"none", "arrows", "streamlines"});
  options.add({"no-labels", "no states on modules"});
  options.add({"no-panel", "the tank alone: no clock, yield and legend"});
  options.add({"figure-width", "one frame for paper, without the panel: 85 or 174 mm", "MM"},
              &paper.width, 60, 400);
  options.add({"trail", "time of path drawn behind each body (4 s)", "TIME"}, &style.trail, 0, 3600,
              "s");
  options.add({"dry-run", "read everything, draw nothing"});
  options.add({"force", "replace files of other contents"}, &film.force);
}

}  // namespace

int render_verb(const Arguments& arguments, [[maybe_unused]] const Host& host) {
  VerbOptions options("render", "RUN", "Draws a run's directory: a film, stills or one frame.");
  FilmOptions film;
  FigureStyle paper;
  film.force = false;
  std::string flow;
  double at = 0;
  bool quiet = false;
  add_render_options(options, film, paper, flow, at);
  options.add({"quiet", "no progress"}, &quiet);
  if (!options.parse(arguments)) return Exit::done;
#ifdef LILYTANK_HAS_RENDER
  const std::string& run =
      options.only("which run? write lilytank render RUN, as out/chain5-seed1");
  for (const char* name : {"png", "svg", "pdf", "mp4", "gif"}) check_ending(options, name);
  if (!any_given(options, {"png", "svg", "pdf"})) {
    options.refuse_given({"at", "figure-width"}, "goes with --png, --svg or --pdf");
  }
  take_style(options, flow, film);
  draw_all(options, run, film, paper, at, quiet, host);
  return Exit::done;
#else
  options.refuse("this program was built without the renderer (Cairo was not found)");
#endif
}

}  // namespace lilytank::cli
