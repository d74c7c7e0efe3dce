// lilytank analyze: statistics of recordings and runs, alone and compared.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "cli/inputs.hpp"
#include "cli/options.hpp"
#include "cli/results.hpp"
#include "io/standard_input.hpp"
#include "jobs/job_directory.hpp"
#include "jobs/run_directory.hpp"
#include "lilytank/analysis.hpp"
#include "lilytank/experiment.hpp"
#include "lilytank/run.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

namespace fs = std::filesystem;

/// How sources are read.
struct SourceOptions {
  std::optional<BodyKind> body;      ///< only these; not given: all kinds there are
  std::vector<std::string> names;    ///< in the order of the words
  std::string label, panel;          ///< scenario keys whose values name runs, and their plots
  double from = 0, to = -1;          ///< s of a recording's clock that count; to < 0: all
  double tank_radius = 0, size = 0;  ///< m, of recordings without experiment; 0: the defaults
};

double size_of(const Model& model, BodyKind body) {
  return body == BodyKind::ball ? 2 * model.ball.radius : model.module.side;
}

const ScenarioEntry& entry(const Scenario& scenario, const std::string& path) {
  std::vector<std::string> paths;
  for (const ScenarioEntry& e : scenario.entries) {
    if (e.path == path) return e;
    paths.push_back(e.path);
  }
  throw InputError("'" + path + "' is no key of a scenario" + did_you_mean(path, paths));
}

// A length in the unit of tanks: "-7 cm" of -0.07, "5 mm" of 0.005.
std::string length_text(double metres) {
  const double size = std::fabs(metres);
  if (size >= 1) return without_rounding(metres) + " m";
  const bool small = size > 0 && size < 0.01;
  return without_rounding(metres * (small ? 1000 : 100)) + (small ? " mm" : " cm");
}

// "69 %" of flow.pump_power, "-8 cm" of flow.water_level.
std::string value_text(const Scenario& scenario, const std::string& path) {
  const ScenarioEntry& e = entry(scenario, path);
  std::string value = e.value;
  std::erase(value, '"');
  const auto number = parse_number(value);
  if (e.unit == "m" && number) return length_text(*number);
  return e.unit.empty() || value.find(' ') != std::string::npos ? value : value + " " + e.unit;
}

// "water level" of flow.water_level.
std::string last_word(const std::string& path) {
  std::string word = own_name(path);
  std::replace(word.begin(), word.end(), '_', ' ');
  return word;
}

// The frames of a track between two, both included.
Track part_of(const Track& track, int from, int to) {
  const auto cut = [&](const std::vector<double>& all, int a, int b) {
    if (all.empty()) return all;
    return std::vector<double>(all.begin() + (a - track.first),
                               all.begin() + (b - track.first + 1));
  };
  int a = std::max(from, track.first), b = std::min(to, track.last());
  const auto seen = [&](int f) {
    return !std::isnan(track.x[static_cast<std::size_t>(f - track.first)]);
  };
  while (a <= b && !seen(a)) ++a;
  while (b >= a && !seen(b)) --b;
  Track out;
  out.id = track.id, out.assembly = track.assembly;
  if (a > b) return out;
  out.first = a - from;
  out.x = cut(track.x, a, b), out.y = cut(track.y, a, b), out.theta = cut(track.theta, a, b);
  return out;
}

// A recording's frames from `from` to `to` (s).
Recording part_of(const Recording& all, double from, double to) {
  if (from <= all.start && to < 0) return all;
  const int first = std::max(0, static_cast<int>(std::ceil((from - all.start) * all.rate - 1e-6)));
  const double end = to < 0 ? all.frames : std::floor((to - all.start) * all.rate + 1e-6);
  const int last = std::min(all.frames - 1, static_cast<int>(end));
  Recording part = all;
  part.start = all.time(first), part.frames = std::max(0, last - first + 1);
  part.tracks.clear();
  for (const Track& track : all.tracks) {
    Track t = part_of(track, first, last);
    if (!t.x.empty()) part.tracks.push_back(std::move(t));
  }
  if (part.tracks.empty()) {
    throw InputError("'" + all.name + "' shows no body between --from and --to");
  }
  return part;
}

std::string base_name(const std::string& word) {
  if (word == kStandardInput) return stem_of(word);
  fs::path path = fs::path(word).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  return path.filename().string();
}

// What the words name, as sources of one recording each.
class Reader {
 public:
  Reader(const SourceOptions& options, std::vector<std::string>& files)
      : options_(options), files_(files) {}

  std::vector<AnalysisSource> read(const std::string& word, const std::string& name) {
    pieces_.clear(), name_ = name;
    std::error_code ignored;
    if (fs::exists(fs::path(word) / "resolved.toml", ignored)) {
      read_run(word);
    } else if (is_toml(word)) {
      read_experiment(word);
    } else {
      read_file(word);
    }
    if (pieces_.empty()) throw InputError("'" + word + "' has no bodies of this kind");
    return std::move(pieces_);
  }

 private:
  bool wanted(BodyKind body) const { return !options_.body || *options_.body == body; }

  void add(const std::string& name, const std::string& panel, const Recording& recording,
           double tank_radius, double size, bool exact = false) {
    const bool labelled = exact && name_.empty() && !options_.label.empty();
    pieces_.push_back({name_.empty() ? name : name_,
                       panel,
                       {part_of(recording, options_.from, options_.to)},
                       tank_radius,
                       size,
                       exact,
                       labelled ? last_word(options_.label) : ""});
  }
  void read_run(const std::string& word) {
    const StoredRun run = load_run(word);
    for (std::string& file : files_of_run(word)) files_.push_back(std::move(file));
    const Model& model = run.scenario.model;
    std::string name = base_name(word), panel;
    if (!options_.label.empty()) name = value_text(run.scenario, options_.label);
    if (!options_.panel.empty()) {
      panel = last_word(options_.panel) + " " + value_text(run.scenario, options_.panel);
    }
    const int balls = run.trajectory.bodies - run.trajectory.modules;
    const bool both = balls > 0 && run.trajectory.modules > 0 && !options_.body;
    for (const BodyKind body : {BodyKind::lily, BodyKind::ball}) {
      const int count = body == BodyKind::ball ? balls : run.trajectory.modules;
      if (count == 0 || !wanted(body)) continue;
      Recording recording = as_recording(run.trajectory, body);
      recording.name = word;
      const std::string kind = body == BodyKind::ball ? " balls" : " modules";
      add(name + (both ? kind : ""), panel, recording, model.tank.radius, size_of(model, body),
          true);
    }
  }
  void read_experiment(const std::string& word) {
    const Experiment experiment = load_experiment(
        {word}, {}, [&](const RecordingSource& s) { return wanted(s.options.body); });
    const Model& model = experiment.base.model;
    files_.push_back(word);
    for (const RecordingSource& source : experiment.sources) files_.push_back(source.file);
    bool lilies = false, others = false;
    for (const Recording& r : experiment.recordings) {
      (r.body == BodyKind::lily ? lilies : others) = true;
    }
    for (const Recording& r : experiment.recordings) {
      const std::string kind = r.body == BodyKind::lily   ? " modules"
                               : r.body == BodyKind::ball ? " balls"
                                                          : " points";
      add(experiment.name + (lilies && others ? kind : ""), "", r, model.tank.radius,
          size_of(model, r.body));
    }
  }
  void read_file(const std::string& word) {
    RecordingOptions read;
    const Model model;
    read.body = options_.body.value_or(BodyKind::lily);
    if (options_.tank_radius > 0) read.tank_radius = options_.tank_radius;
    const Recording recording = read_recording(word, read);
    files_.push_back(word);
    add(base_name(word), "", recording, read.tank_radius,
        options_.size > 0 ? options_.size : size_of(model, read.body));
  }

  const SourceOptions& options_;
  std::vector<std::string>& files_;
  std::string name_;
  std::vector<AnalysisSource> pieces_;
};

// Adds the recording of a piece to the source that it belongs to.
void join(std::vector<AnalysisSource>& sources, AnalysisSource piece) {
  for (AnalysisSource& s : sources) {
    if (s.name == piece.name && s.panel == piece.panel &&
        s.recordings[0].body == piece.recordings[0].body && s.exact == piece.exact) {
      s.recordings.push_back(std::move(piece.recordings[0]));
      return;
    }
  }
  sources.push_back(std::move(piece));
}

/// The sources of the words: a run's directory, an experiment's TOML file, or a recording each.
/// Those of one name, panel and kind of body are one. Adds what was read to `files`. Throws
/// InputError.
std::vector<AnalysisSource> read_sources(const std::vector<std::string>& words,
                                         const SourceOptions& options,
                                         std::vector<std::string>& files) {
  Reader reader(options, files);
  std::vector<AnalysisSource> sources;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string name = i < options.names.size() ? options.names[i] : "";
    for (AnalysisSource& piece : reader.read(words[i], name)) join(sources, std::move(piece));
  }
  return sources;
}

struct AnalyzeJob {
  SourceOptions sources;
  AnalysisOptions analysis;
  std::string body;
  FigureStyle style;
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
  add_figure_options(options, job.style);
  options.add({"dry-run", "read everything, write nothing"});
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

int dry_run(const std::vector<AnalysisSource>& sources, const std::string& dir) {
  std::cout << "would analyze " << counted(std::ssize(sources), "source") << "; in " << dir << "\n";
  for (const AnalysisSource& source : sources) {
    double seconds = 0;
    for (const Recording& r : source.recordings) seconds += r.frames / r.rate;
    std::cout << "  " << source.name << ": " << counted(std::ssize(source.recordings), "recording")
              << ", " << significant(seconds, 4) << " s\n";
  }
  return Exit::done;
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

int analyze_verb(const Arguments& arguments, const Host& host) {
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
  if (options.has("dry-run")) return dry_run(sources, dir);
  const Analysis analysis = analyse(sources, job.analysis);
  const auto lock =
      claim_directory(dir, job.force, {"analysis", identity_of(origin), result_names(analysis)});
  ReportDocument report = analysis_report(analysis);
  report.provenance = origin;
  write_analysis(analysis, report, dir);
  if constexpr (kDraws) draw_analysis(analysis, report, dir, job.style);
  if constexpr (!kDraws) say_undrawn("plots");
  return print_results(report, dir, host);
}

}  // namespace lilytank::cli
