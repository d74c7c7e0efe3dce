// lilytank view: one HTML file that plays stored results.
#include <spawn.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "cli/inputs.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/results.hpp"
#include "io/atomic_file.hpp"
#include "jobs/run_directory.hpp"
#include "lilytank/view.hpp"

namespace lilytank::cli {
namespace {

namespace fs = std::filesystem;

struct ViewJob {
  ViewOptions page;
  std::vector<std::string> runs;
  std::string recording;
  bool force = false, quiet = false;
};

bool has_file(const std::string& dir, const char* name) {
  return exists((fs::path(dir) / name).string());
}

/// The file that goes with the results of a study or a diagnosis.
const std::string& second(const VerbOptions& options, const std::string& what) {
  if (options.positional().size() != 2) {
    options.refuse("'" + options.positional()[0] + "' holds a " + what);
  }
  return options.positional()[1];
}

ViewPage page_of(const VerbOptions& options, const ViewJob& job) {
  const std::vector<std::string>& words = options.positional();
  const std::string& dir = words.front();
  const bool study = has_file(dir, "study.toml"), diagnosis = has_file(dir, "diagnosis.json");
  if (std::max(words.size(), job.runs.size()) > kViewTanks) {
    options.refuse("a page shows at most " + std::to_string(kViewTanks) + " runs");
  }
  if (!study) options.refuse_given({"run"}, "goes with a study");
  if (!diagnosis) options.refuse_given({"recording"}, "goes with a diagnosis");
  if (study) {
    const std::string& file =
        second(options, "study; write lilytank view STUDY STUDY.toml, with the file that was run");
    return view_study(dir, Study(file, load_study(dir).plan.sets), job.runs, job.page);
  }
  if (diagnosis) {
    const std::string& file =
        second(options,
               "diagnosis; write lilytank view DIAGNOSIS EXPERIMENT.toml, with the diagnosed file");
    return view_diagnosis(dir, file, job.recording, job.page);
  }
  if (!has_file(dir, run_file::resolved)) {
    require_path(dir);
    throw InputError("'" + dir + "' is not the directory of a run, study or diagnosis");
  }
  return view_runs(words);
}

/// Says so where poses of a run were stored too seldom to be played: with 5 a second, the corners
/// of paths hardly show.
void warn_if_seldom(const ViewPage& page) {
  for (const ViewTank& tank : page.tanks) {
    if (!tank.seen.empty() || stored_rate(tank.run.trajectory) >= 5) continue;
    const std::vector<double>& stored = tank.run.trajectory.time;
    std::vector<double> between;
    for (std::size_t f = 1; f < stored.size(); ++f) {
      between.push_back((stored[f - 1] + stored[f]) / 2);
    }
    std::cerr << too_seldom_to_draw(tank.run, between);
  }
}

/// Shows a file with the desktop's browser, which may outlive this program.
void open_page(const std::string& file) {
  std::string program = "xdg-open", page = fs::absolute(file).string();
  char* words[] = {program.data(), page.data(), nullptr};
  ::pid_t child = 0;
  const int number = ::posix_spawnp(&child, words[0], nullptr, nullptr, words, environ);
  if (number != 0) std::cerr << system_problem("cannot run", program, number) << "\n";
}

}  // namespace

int view_verb(const Arguments& arguments, const Host& host) {
  VerbOptions options("view", "RUN... | STUDY STUDY.toml | DIAGNOSIS EXPERIMENT.toml",
                      "Makes one HTML file that plays up to four runs side by side, runs of a "
                      "study, or a diagnosed recording beside simulations.");
  ViewJob job;
  options.add({"out", "the page (default: view.html in the first directory)", "FILE"});
  options.add(
      {"rate", "frames kept per second of simulated time (default: all of 1.1 million poses)", "N"},
      &job.page.rate, 1e-3, 1e4);
  options.add({"run", "of a study: id of a run in table.csv; can be repeated", "ID"}, &job.runs);
  options.add(
      {"recording", "of a diagnosis: the recording (default: the first that is held out)", "FILE"},
      &job.recording);
  options.add({"open", "open the page with xdg-open"});
  options.add({"force", "replace a file of other contents"}, &job.force);
  options.add({"quiet", "no progress"}, &job.quiet);
  if (!options.parse(arguments, "of what? write lilytank view RUN, as out/chain5-seed1")) {
    return Exit::done;
  }
  const std::string& dir = options.positional().front();
  const std::string file = options.out((fs::path(dir) / run_file::view).string());
  options.spare_inputs("out", file, options.positional());
  Progress progress(job.quiet, host);
  progress.watch(job.page);
  ViewPage page = page_of(options, job);
  const ReportProvenance origin = provenance("view", arguments, 0, {});
  page.version = origin.version, page.command = origin.command;
  const std::string html = view_html(page, job.page);
  write_results({{file, html}}, job.force);
  progress.clear();
  warn_if_seldom(page);
  std::cout << file << "\n" << std::flush;
  if (options.has("open")) open_page(file);
  return Exit::done;
}

}  // namespace lilytank::cli
