#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>

#include "cli/dry_run.hpp"
#include "cli/options.hpp"
#include "cli/point_bodies.hpp"
#include "cli/progress.hpp"
#include "cli/provenance.hpp"
#include "cli/stored_poses.hpp"
#include "io/atomic_file.hpp"
#include "jobs/report.hpp"
#include "jobs/run_directory.hpp"
#include "lilytank/run.hpp"
#include "text/number.hpp"
#include "text/words.hpp"
#ifdef LILYTANK_HAS_RENDER
#include "lilytank/render.hpp"
#endif

namespace lilytank::cli {
namespace {

namespace fs = std::filesystem;

std::string default_out(const Scenario& scenario, const std::string& last_file) {
  const std::string name =
      scenario.title.empty() ? fs::path(last_file).stem().string() : scenario.title;
  return (fs::path("out") / (file_name_of(name, "run") + "-seed" + std::to_string(scenario.seed)))
      .string();
}

void check_video(const VerbOptions& options, const Scenario& scenario) {
#ifdef LILYTANK_HAS_RENDER
  if (scenario.output.trajectory == TrajectoryFormat::none) {
    options.refuse("--video needs stored poses, but output.trajectory is \"none\"");
  }
  require_film_program();  // rather than after hours of simulation
#else
  static_cast<void>(scenario);
  options.refuse("--video: this program was built without the renderer (Cairo was not found)");
#endif
}

/// Refuses to replace pictures that no `run --video` made: it draws the film first.
void check_pictures(const std::string& out) {
#ifdef LILYTANK_HAS_RENDER
  if (is_film((fs::path(out) / "video.mp4").string())) return;
#endif
  refuse_foreign(out, existing_in(out, pictures_of_run()), "run");
}

/// Draws video.mp4, then the pictures and the page of the report.
void draw(const std::string& out, const ReportProvenance& origin, bool force, bool quiet) {
#ifdef LILYTANK_HAS_RENDER
  const StoredRun stored = load_run(out);
  FilmOptions film;
  film.length = 35, film.style.size = 720;  // 10 MB at most; `lilytank render` draws larger ones
  std::cerr << too_seldom_to_draw(stored, film_times(stored, film));
  Progress progress(quiet);
  film.force = force;
  progress.watch(film);
  draw_film(stored, film, (fs::path(out) / "video.mp4").string());
  ReportDocument report = run_report(stored, out);
  report.provenance = origin;
  draw_run(stored, report, out);
#else
  static_cast<void>(out), static_cast<void>(origin);
  static_cast<void>(force), static_cast<void>(quiet);
#endif
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

RunResult run_with_progress(const Scenario& scenario, const RunOptions& base, bool quiet) {
  Progress progress(quiet);
  RunOptions options = base;
  progress.watch(options);
  return run(scenario, options);
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

/// `film`: where the numbers come from, if the run is to be drawn.
int finish(const Scenario& scenario, const RunResult& result, const std::string& out,
           const std::optional<ReportProvenance>& film, bool force, bool quiet) {
  if (!quiet) say_time(result, out);
  if (result.status == RunStatus::diverged) {
    std::cerr << divergence_text(result.divergence, scenario.model) << "\n";
  } else if (film) {
    draw(out, *film, force, quiet);
  }
  std::cout << read_whole((fs::path(out) / run_file::summary_text).string()) << std::flush;
  return result.status == RunStatus::diverged ? Exit::diverged : Exit::done;
}

}  // namespace

int run_verb(const Arguments& arguments) {
  VerbOptions options("run", "SCENARIO...",
                      "Simulates one tank; later scenarios overlay earlier ones.");
  options.add()("set", "a value, as tank.radius=0.3 or run.dt='5 ms'",
                cxxopts::value<std::vector<std::string>>(), "PATH=VALUE")(
      "seed", "where all random numbers come from", cxxopts::value<std::string>(), "N")(
      "out", "directory of the results (default: out/<title>-seed<N>)",
      cxxopts::value<std::string>(),
      "DIR")("video", "draw video.mp4 (35 s, 1280 x 720), yield.png and report.html")(
      "dry-run", "check everything, write nothing")("force", "replace another run's files")(
      "quiet", "no progress");
  if (!options.parse(arguments)) return Exit::done;
  if (options.positional().empty()) {
    options.refuse("which scenario? write lilytank run SCENARIO, as scenarios/chain5.toml");
  }
  std::vector<std::string> sets = options.list("set");
  if (options.has("seed")) {
    sets.push_back("run.seed=" + std::to_string(options.whole("seed", 1, 0, 1000000000000000000)));
  }
  refuse_point_bodies(options.positional());
  const Scenario scenario = load_scenario(options.positional(), sets);
  const bool video = options.has("video"), quiet = options.has("quiet");
  if (video) check_video(options, scenario);
  RunOptions job;
  job.out = options.text("out", default_out(scenario, options.positional().back()));
  if (job.out.empty()) options.refuse("--out is empty");
  job.force = options.has("force");
  if (video && !job.force) check_pictures(job.out);
  if (options.has("dry-run")) return dry_run(scenario, job.out, job.force);
  std::shared_ptr<const DirectoryLock> lock;  // until the report is written
  job.lock = &lock;
  const RunResult result = run_with_progress(scenario, job, quiet);
  std::optional<ReportProvenance> film;
  if (video) film = provenance("run", arguments, scenario.seed, options.positional());
  return finish(scenario, result, job.out, film, job.force, quiet);
}

}  // namespace lilytank::cli
