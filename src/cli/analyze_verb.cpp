// lilytank analyze: what recordings and runs tell, alone and against each other.
#include <filesystem>

#include "cli/analyze_sources.hpp"
#include "cli/inputs.hpp"
#include "cli/options.hpp"
#include "cli/results.hpp"
#include "jobs/job_directory.hpp"

namespace lilytank::cli {
namespace {

struct AnalyzeJob {
  SourceOptions sources;
  AnalysisOptions analysis;
  std::string body;
  bool force = false;
};

void add_analyze_options(VerbOptions& options, AnalyzeJob& job) {
  SourceOptions& s = job.sources;
  AnalysisOptions& a = job.analysis;
  options.add({"out", "directory of the results (default: out/<first source>-analysis)", "DIR"});
  options.add({"body", "only these: lily, ball or point (a plain recording is of lilies)", "KIND"},
              &job.body, {"lily", "ball", "point"});
  options.add({"name", "name of the next source, in order", "NAME"}, &s.names);
  options.add({"label", "name runs by this key's value, as flow.pump_power", "KEY"}, &s.label);
  options.add({"panel", "plots beside each other by this key's value", "KEY"}, &s.panel);
  options.add({"from", "begin of what counts (0 s)", "TIME"}, &s.from, 0, kLongest, "s");
  options.add({"to", "its end", "TIME"}, &s.to, 0, kLongest, "s");
  options.add({"longest-lag", "of displacements and autocorrelations (60 s)", "TIME"},
              &a.longest_lag, 0.1, 1e6, "s");
  options.add({"msd-only", "nothing but displacements"}, &a.msd_only);
  options.add(
      {"diffusion-from", "lags to fit D to (default: where the MSD grows as the lag)", "TIME"},
      &a.diffusion_from, 0, kLongest, "s");
  options.add({"diffusion-to", "", "TIME"}, &a.diffusion_to, 0, kLongest, "s");
  options.add({"contact-gap", "gap at which bodies touch (1 mm)", "LENGTH"}, &a.touching, 0, 0.1,
              "m");
  options.add({"cells", "of velocity maps, a side (50)", "N"}, &a.map_cells, 2, 500);
  options.add(
      {"window", "smooth by polynomials over this time instead of a Kalman smoother", "TIME"},
      &a.smoothing.window, 1e-4, 100, "s");
  options.add({"degree", "of these polynomials (3)", "N"}, &a.smoothing.degree, 2, 5);
  options.add({"tank-radius", "of recordings without an experiment (30 cm)", "LENGTH"},
              &s.tank_radius, 0.01, 100, "m");
  options.add({"size", "side or diameter of their bodies", "LENGTH"}, &s.size, 1e-4, 10, "m");
  options.add({"resamples", "of each band (1000)", "N"}, &a.bootstrap.resamples, 20, 1000000);
  options.add({"seed", "of the bands (1)", "N"}, &a.bootstrap.seed, 0, INT64_MAX);
  options.add({"force", "replace files of other results in the directory"}, &job.force);
}

void check_analyze_options(const VerbOptions& options, AnalyzeJob& job) {
  SourceOptions& s = job.sources;
  AnalysisOptions& a = job.analysis;
  if (job.body == "lily") s.body = BodyKind::lily;
  if (job.body == "ball") s.body = BodyKind::ball;
  if (job.body == "point") s.body = BodyKind::point;
  if (s.names.size() > options.positional().size()) {
    options.refuse("there are more --name than sources");
  }
  if (s.to >= 0 && s.to <= s.from) options.refuse("--to is not after --from");
  if (options.has("diffusion-from") && a.diffusion_to <= a.diffusion_from) {
    options.refuse("--diffusion-from needs a later --diffusion-to");
  }
  if (options.has("window")) a.smoothing.method = SmoothingMethod::polynomial;
  if (!options.has("window") && options.has("degree")) {
    options.refuse("--degree goes with --window");
  }
}

// The last part of the first word, for out/<that>.
std::string default_directory(const std::vector<AnalysisSource>& sources) {
  std::string name;
  for (const char c : sources[0].name) name += c == '/' || c == ' ' ? '_' : c;
  return "out/" + name + "-analysis";
}

/// Names of all files that an analysis may leave.
std::vector<std::string> result_names(const Analysis& analysis) {
  std::vector<std::string> names{"report.html"}, figures{"msd_all_log"};
  for (const auto& [name, content] : analysis_files(analysis, {})) {
    names.push_back(name);
    figures.push_back(std::filesystem::path(name).stem().string());
  }
  return with_figures(std::move(names), figures);
}

}  // namespace

int analyze_verb(const Arguments& arguments) {
  VerbOptions options("analyze", "RUN|EXPERIMENT.toml|RECORDING...",
                      "Analyses tracks: displacements, velocities, maps, neighbours. Compares two "
                      "sources. Writes text, tables and plots.");
  AnalyzeJob job;
  add_analyze_options(options, job);
  if (!options.parse(arguments,
                     "of what? write lilytank analyze RUN, EXPERIMENT.toml or a recording")) {
    return Exit::done;
  }
  check_analyze_options(options, job);
  refuse_point_bodies(options.positional());
  std::vector<std::string> files;
  const auto sources = read_sources(options.positional(), job.sources, files);
  const std::string dir = options.out(default_directory(sources));
  options.spare_directory("out", dir, files);
  const ReportProvenance origin =
      provenance("analyze", arguments, job.analysis.bootstrap.seed, files);
  check_directory(dir, job.force, {"analysis", identity_of(origin), {}});
  const Analysis analysis = analyse(sources, job.analysis);
  const auto lock =
      claim_directory(dir, job.force, {"analysis", identity_of(origin), result_names(analysis)});
  ReportDocument report = analysis_report(analysis);
  report.provenance = origin;
  write_analysis(analysis, report, dir);
  if constexpr (kDraws) draw_analysis(analysis, report, dir);
  if constexpr (!kDraws) say_undrawn("plots");
  return print_results(report, dir);
}

}  // namespace lilytank::cli
