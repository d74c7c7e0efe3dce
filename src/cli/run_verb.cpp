#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>

#include "cli/inputs.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/results.hpp"
#include "io/atomic_file.hpp"
#include "io/standard_input.hpp"
#include "jobs/report.hpp"
#include "jobs/run_directory.hpp"
#include "lilytank/run.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

namespace fs = std::filesystem;

std::string default_out(const Scenario& scenario, const std::string& last_file) {
  const std::string name = scenario.title.empty() ? stem_of(last_file) : scenario.title;
  return (fs::path("out") / (file_name_of(name, "run") + "-seed" + std::to_string(scenario.seed)))
      .string();
}

void check_video(const VerbOptions& options, const Scenario& scenario) {
  if constexpr (kDraws) {
    if (scenario.output.trajectory == TrajectoryFormat::none) {
      options.refuse("--video needs stored poses, but output.trajectory is \"none\"");
    }
    require_film_program();  // rather than after hours of simulation
  } else {
    options.refuse("--video: this program was built without the renderer (Cairo was not found)");
  }
}

/// Refuses to replace pictures that no `run --video` made: it draws the film first.
void check_pictures(const std::string& out) {
  if constexpr (kDraws) {
    if (is_film((fs::path(out) / "video.mp4").string())) return;
  }
  refuse_foreign(out, existing_in(out, pictures_of_run()), "run");
}

/// Where the numbers of a drawn run come from, and how its figures look.
struct Drawing {
  ReportProvenance origin;
  FigureStyle style;
};

/// Draws video.mp4, then the pictures and the page of the report.
void draw(const RunOptions& job, const Drawing& how, bool quiet, const Host& host) {
  if constexpr (kDraws) {
    const StoredRun stored = load_run(job.out);
    FilmOptions film;
    film.length = 35, film.style.size = 720;  // 10 MB at most; `lilytank render` draws larger ones
    std::cerr << too_seldom_to_draw(stored, film_times(stored, film));
    Progress progress(quiet, host);
    film.force = job.force;
    progress.watch(film);
    draw_film(stored, film, (fs::path(job.out) / "video.mp4").string());
    ReportDocument report = run_report(stored, job.out);
    report.provenance = how.origin;
    draw_run(stored, report, job.out, how.style);
  }
}

int dry_run(const Scenario& scenario, const std::string& out, bool force) {
  initial_state(scenario.model, scenario.seed);  // do the bodies fit?
  check_directory_can_be(out);
  static_cast<void>(RunDirectory(out, scenario, force));  // only looks, and refuses
  std::cout << "would simulate " << shortest(scenario.duration) << " s of "
            << scenario.model.module.count << " modules and " << scenario.model.ball.count
            << " balls with seed " << scenario.seed << "\nwould write to " << out << "\nscenario "
            << hex(scenario.identity) << "\n";
  return Exit::done;
}

void say_time(const RunResult& result, const std::string& out) {
  if (result.already_complete) {
    std::cerr << "this run was complete already\n";
  } else {
    char text[80];
    std::snprintf(text, sizeof text, "took %.2f s%s", result.wall,
                  result.resumed ? ", going on from a checkpoint" : "");
    std::cerr << text << "\n";
  }
  std::cerr << "results in " << out << "\n";
}

/// What to print, and the exit code. `film`: if the run is drawn.
int finish(const Scenario& scenario, const RunResult& result, const RunOptions& job,
           const std::optional<Drawing>& film, bool quiet, const Host& host) {
  if (!quiet) say_time(result, job.out);
  if (result.status == RunStatus::diverged) {
    std::cerr << divergence_text(result.divergence, scenario.model) << "\n";
  } else if (film) {
    draw(job, *film, quiet, host);
  }
  std::cout << read_whole((fs::path(job.out) / run_file::summary_text).string()) << std::flush;
  return result.status == RunStatus::diverged ? Exit::diverged : Exit::done;
}

}  // namespace

int run_verb(const Arguments& arguments, const Host& host) {
  VerbOptions options("run", "SCENARIO...",
                      "Simulates one tank; later scenarios overlay earlier ones.");
  RunOptions job;
  std::vector<std::string> sets;
  bool video = false, quiet = false;
  options.add({"set", "a value, as tank.radius=0.3 or run.dt='5 ms'", "PATH=VALUE"}, &sets);
  options.add_seed("where all random numbers come from", &sets);
  options.add({"out", "directory of the results (default: out/<title>-seed<N>)", "DIR"});
  options.add({"video", "draw video.mp4 (35 s, 1280 x 720), yield.png and report.html"}, &video);
  FigureStyle style;
  add_figure_options(options, style);
  options.add({"dry-run", "check everything, write nothing"});
  options.add({"force", "replace another run's files"}, &job.force);
  options.add({"quiet", "no progress"}, &quiet);
  if (!options.parse(arguments,
                     "which scenario? write lilytank run SCENARIO, as scenarios/chain5.toml")) {
    return Exit::done;
  }
  if (!video) options.refuse_given({"figure-width", "no-titles"}, "goes with --video");
  refuse_point_bodies(options.positional());
  const Scenario scenario = load_scenario(options.positional(), sets);
  if (video) check_video(options, scenario);
  job.out = options.out(default_out(scenario, options.positional().back()));
  if (video && !job.force) check_pictures(job.out);
  if (options.has("dry-run")) return dry_run(scenario, job.out, job.force);
  std::shared_ptr<const DirectoryLock> lock;  // until the report is written
  job.lock = &lock;
  Progress progress(quiet, host);
  progress.watch(job);
  const RunResult result = run(scenario, job);
  progress.clear();
  std::optional<Drawing> film;
  if (video) film = {provenance("run", arguments, scenario.seed, options.positional()), style};
  return finish(scenario, result, job, film, quiet, host);
}

}  // namespace lilytank::cli
