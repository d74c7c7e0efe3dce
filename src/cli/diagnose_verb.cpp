// lilytank diagnose: what physics a model leaves out.
#include <filesystem>
#include <iostream>

#include "cli/options.hpp"
#include "cli/point_bodies.hpp"
#include "cli/progress.hpp"
#include "cli/provenance.hpp"
#include "lilytank/bodies.hpp"
#include "lilytank/diagnosis.hpp"
#ifdef LILYTANK_HAS_RENDER
#include "lilytank/render.hpp"
#endif

namespace lilytank::cli {
namespace {

int show(const Diagnosis& found, const ReportProvenance& provenance, const std::string& dir) {
  ReportDocument report = diagnosis_report(found);
  report.provenance = provenance;
  write_diagnosis(found, report, dir);
#ifdef LILYTANK_HAS_RENDER
  draw_diagnosis(found, report, dir);
#else
  std::cerr
      << "no report.html: this program was built without the renderer (Cairo was not found)\n";
#endif
  std::cout << report_text(report) << std::flush;
  std::cerr << "results in " << dir << "\n";
  return Exit::done;
}

std::string directory_of(const VerbOptions& options, const std::string& name) {
  const std::string out =
      options.text("out", (std::filesystem::path("out") / ("diagnose-" + name)).string());
  if (out.empty()) options.refuse("--out is empty");
  return out;
}

void add_diagnose_options(VerbOptions& options) {
  const auto text = [] { return cxxopts::value<std::string>(); };
  options.add()("out", "directory of the results (default: out/diagnose-<name>)", text(), "DIR")(
      "seed", "of everything that is drawn (1)", text(), "N")(
      "budget", "minutes that it may take on two cores (10)", text(), "MINUTES")(
      "hold-out", "recordings kept for showing, if none is marked held_out (1)", text(), "N")(
      "set", "a value over the experiment's, as run.dt='5 ms'",
      cxxopts::value<std::vector<std::string>>(),
      "PATH=VALUE")("threads", "simulations at a time (default: one a core)", text(), "N")(
      "force", "replace another diagnosis's files")("quiet", "no progress");
}

}  // namespace

int diagnose_verb(const Arguments& arguments) {
  VerbOptions options("diagnose", "EXPERIMENT.toml...",
                      "Says where an experiment's recordings and the model differ, which effect is "
                      "missing, how large it is, and how much of the difference it removes.");
  add_diagnose_options(options);
  if (!options.parse(arguments)) return Exit::done;
  if (options.positional().empty()) {
    options.refuse("of what? write lilytank diagnose EXPERIMENT.toml");
  }
  DiagnosisOptions job;
  job.minutes = options.number("budget", job.minutes, 1, 1e4, "");
  job.hold_out = static_cast<int>(options.whole("hold-out", job.hold_out, 0, 1000));
  job.seed = static_cast<std::uint64_t>(options.whole("seed", 1, 0, INT64_MAX));
  job.threads = static_cast<int>(options.whole("threads", 0, 0, 4096));
  job.force = options.has("force");
  Progress progress(options.has("quiet"));
  progress.watch(job);
  std::shared_ptr<const DirectoryLock> lock;  // until the report is written
  job.lock = &lock;
  Diagnosis found;
  std::vector<std::string> inputs = options.positional();
  if (options.positional().size() == 1 && is_body_experiment(options.positional()[0])) {
    options.refuse_given({"set", "hold-out"}, "has no effect on an experiment of point bodies");
    const BodyExperiment experiment = load_body_experiment(options.positional()[0]);
    job.out = directory_of(options, experiment.name);
    for (const std::string& file : experiment.files) inputs.push_back(file);
    found = diagnose_bodies(experiment, job);
  } else {
    refuse_point_bodies(options.positional());
    // Recordings have no steps: those of the simulations must be short enough not to show.
    std::vector<std::string> sets{"run.dt='5 ms'"};
    for (const std::string& one : options.list("set")) sets.push_back(one);
    const Experiment experiment = load_experiment(options.positional(), sets);
    job.out = directory_of(options, experiment.name);
    for (const RecordingSource& source : experiment.sources) inputs.push_back(source.file);
    found = diagnose(experiment, job);
  }
  progress.clear();
  return show(found, provenance("diagnose", arguments, job.seed, inputs), job.out);
}

}  // namespace lilytank::cli
