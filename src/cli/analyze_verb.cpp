// lilytank analyze: what recordings and runs tell, alone and against each other.
#include <filesystem>
#include <iostream>

#include "cli/analyze_sources.hpp"
#include "cli/options.hpp"
#include "cli/point_bodies.hpp"
#include "cli/provenance.hpp"
#include "jobs/job_directory.hpp"
#ifdef LILYTANK_HAS_RENDER
#include "lilytank/render.hpp"
#endif

namespace lilytank::cli {
namespace {

SourceOptions source_options(const VerbOptions& options) {
  SourceOptions s;
  if (options.has("body")) {
    const std::vector<std::string> words{"lily", "ball", "point"};
    const std::string word = options.text("body");
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (word == words[i]) s.body = static_cast<BodyKind>(i);
    }
    if (!s.body) {
      options.refuse("--body " + word + " is none of lily, ball, point" +
                     did_you_mean(word, words));
    }
  }
  s.names = options.list("name");
  if (s.names.size() > options.positional().size()) {
    options.refuse("there are more --name than sources");
  }
  s.label = options.text("label"), s.panel = options.text("panel");
  s.from = options.number("from", 0, 0, kLongest, "s");
  s.to = options.number("to", -1, 0, kLongest, "s");
  if (s.to >= 0 && s.to <= s.from) options.refuse("--to is not after --from");
  s.tank_radius = options.number("tank-radius", 0, 0.01, 100, "m");
  s.size = options.number("size", 0, 1e-4, 10, "m");
  return s;
}

AnalysisOptions analysis_options(const VerbOptions& options) {
  AnalysisOptions a;
  a.longest_lag = options.number("longest-lag", a.longest_lag, 0.1, 1e6, "s");
  a.map_cells = static_cast<int>(options.whole("cells", a.map_cells, 2, 500));
  a.diffusion_from = options.number("diffusion-from", 0, 0, kLongest, "s");
  a.diffusion_to = options.number("diffusion-to", 0, 0, kLongest, "s");
  if (options.has("diffusion-from") && a.diffusion_to <= a.diffusion_from) {
    options.refuse("--diffusion-from needs a later --diffusion-to");
  }
  a.touching = options.number("contact-gap", a.touching, 0, 0.1, "m");
  a.msd_only = options.has("msd-only");
  a.bootstrap.resamples = static_cast<int>(options.whole("resamples", 1000, 20, 1000000));
  a.bootstrap.seed = static_cast<std::uint64_t>(options.whole("seed", 1, 0, INT64_MAX));
  if (options.has("window")) {
    a.smoothing.method = SmoothingMethod::polynomial;
    a.smoothing.window = options.number("window", a.smoothing.window, 1e-4, 100, "s");
    a.smoothing.degree = static_cast<int>(options.whole("degree", a.smoothing.degree, 2, 5));
  } else if (options.has("degree")) {
    options.refuse("--degree goes with --window");
  }
  return a;
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

void add_analyze_options(VerbOptions& options) {
  const auto text = [] { return cxxopts::value<std::string>(); };
  options.add()("out", "directory of the results (default: out/<first source>-analysis)", text(),
                "DIR")("body", "only these: lily, ball or point (a plain recording is of lilies)",
                       text(), "KIND")("name", "name of the next source, in order",
                                       cxxopts::value<std::vector<std::string>>(), "NAME")(
      "label", "name runs by this key's value, as flow.pump_power", text(), "KEY")(
      "panel", "plots beside each other by this key's value", text(), "KEY")(
      "from", "begin of what counts (0 s)", text(), "TIME")("to", "its end", text(), "TIME")(
      "longest-lag", "of displacements and autocorrelations (60 s)", text(), "TIME")(
      "msd-only", "nothing but displacements")(
      "diffusion-from", "lags to fit D to (default: where the MSD grows as the lag)", text(),
      "TIME")("diffusion-to", "", text(), "TIME")("contact-gap", "gap at which bodies touch (1 mm)",
                                                  text(), "LENGTH")(
      "cells", "of velocity maps, a side (50)", text(), "N")(
      "window", "smooth by polynomials over this time instead of a Kalman smoother", text(),
      "TIME")("degree", "of these polynomials (3)", text(), "N")(
      "tank-radius", "of recordings without an experiment (30 cm)", text(), "LENGTH")(
      "size", "side or diameter of their bodies", text(), "LENGTH")(
      "resamples", "of each band (1000)", text(), "N")("seed", "of the bands (1)", text(), "N")(
      "force", "replace files of other results in the directory");
}

}  // namespace

int analyze_verb(const Arguments& arguments) {
  VerbOptions options("analyze", "RUN|EXPERIMENT.toml|RECORDING...",
                      "Analyses tracks: displacements, velocities, maps, neighbours. Compares two "
                      "sources. Writes text, tables and plots.");
  add_analyze_options(options);
  if (!options.parse(arguments)) return Exit::done;
  if (options.positional().empty()) {
    options.refuse("of what? write lilytank analyze RUN, EXPERIMENT.toml or a recording");
  }
  const AnalysisOptions how = analysis_options(options);
  refuse_point_bodies(options.positional());
  std::vector<std::string> files;
  const auto sources = read_sources(options.positional(), source_options(options), files);
  const std::string dir = options.text("out", default_directory(sources));
  options.spare_directory("out", dir, files);
  const bool force = options.has("force");
  const ReportProvenance origin = provenance("analyze", arguments, how.bootstrap.seed, files);
  check_directory(dir, force, {"analysis", identity_of(origin), {}});
  const Analysis analysis = analyse(sources, how);
  const auto lock =
      claim_directory(dir, force, {"analysis", identity_of(origin), result_names(analysis)});
  ReportDocument report = analysis_report(analysis);
  report.provenance = origin;
  write_analysis(analysis, report, dir);
#ifdef LILYTANK_HAS_RENDER
  draw_analysis(analysis, report, dir);
#else
  std::cerr << "no plots: this program was built without the renderer (Cairo was not found)\n";
#endif
  std::cout << report_text(report) << std::flush;
  std::cerr << "results in " << dir << "\n";
  return Exit::done;
}

}  // namespace lilytank::cli
