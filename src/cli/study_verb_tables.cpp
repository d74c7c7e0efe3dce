// What is there of a study: merge, status, report.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "cli/results.hpp"
#include "cli/study_verb.hpp"
#include "io/json.hpp"
#include "lilytank/study_summary.hpp"
#include "study/study_directory.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

namespace fs = std::filesystem;

const std::string kWhich = "which study? write the directory of its results, or its STUDY.toml";

struct FoundStudy {
  std::string dir;
  StoredStudy study;
};

/// The study of a directory, or of a study file; nothing if only the help was requested. Refuses
/// one without runs where these are needed.
std::optional<FoundStudy> found_study(VerbOptions& options, const Arguments& arguments,
                                      bool needs_runs) {
  std::vector<std::string> sets;
  options.add({"out",
               "directory of the results, where a STUDY.toml is given and it is not out/<name>",
               "DIR"});
  options.add({"set", "as for lilytank study, where a STUDY.toml is given", "PATH=VALUE"}, &sets);
  options.add_seed("as for lilytank study, where a STUDY.toml is given", &sets);
  if (!options.parse(arguments)) return std::nullopt;
  FoundStudy found{only_argument(options, kWhich), {}};
  std::error_code ignored;
  if (fs::is_directory(found.dir, ignored)) {
    found.study = load_study(found.dir);
  } else {
    const StudyPlan plan = Study(found.dir, sets).plan();
    found.dir = options.out("out/" + plan.name);
    found.study = load_study(found.dir, plan);
  }
  if (needs_runs && found.study.table.rows.empty()) {
    options.refuse("there are no runs in '" + found.dir + "' yet");
  }
  return found;
}

/// Says what is missing on stderr; the exit code.
int completeness(const StoredStudy& study, const std::string& done) {
  int failed = 0;
  for (const StoredStudy::Count& count : study.counts) failed += count.failed;
  std::cerr << done << ": " << counts_text(study) << "\n";
  if (!study.complete) {
    std::cerr << "the study is not complete: run it or its shards again, then this\n";
    return Exit::stopped;
  }
  return failed > 0 ? Exit::diverged : Exit::done;
}

/// `decided`: whether a stopping rule asks for no more runs of the setting.
Json status_json(const StoredStudy& study) {
  Json settings = Json::array();
  for (std::size_t s = 0; s < study.counts.size(); ++s) {
    const StoredStudy::Count& count = study.counts[s];
    settings.push_back({{"label", study.plan.settings[s].label},
                        {"done", count.done},
                        {"wanted", count.wanted},
                        {"decided", count.decided},
                        {"diverged", count.failed}});
  }
  return {{"name", study.plan.name}, {"complete", study.complete}, {"settings", settings}};
}

}  // namespace

std::string counts_text(const StoredStudy& study) {
  std::int64_t done = 0, wanted = 0, failed = 0;
  bool decided = true;
  for (const StoredStudy::Count& count : study.counts) {
    done += count.done, wanted += count.wanted, failed += count.failed;
    decided = decided && count.decided;
  }
  return counted(static_cast<std::int64_t>(study.counts.size()), "setting") + ", " +
         std::to_string(done) + " of " + (decided ? "" : "at least ") + std::to_string(wanted) +
         " runs, " + std::to_string(failed) + " diverged";
}

std::string report(const StoredStudy& study, const std::string& dir, const FigureStyle& style,
                   const Host& host) {
  const StudySummary summary = summarise(study.table);
  ReportDocument document = study_report(summary);
  const StudyPlan& plan = study.plan;
  // The study file may be gone: what it came to is in the directory, and is the same for every
  // shard.
  document.provenance = {"study " + plan.name + " of " + joined(plan.scenarios, ", ") +
                             (plan.sets.empty() ? "" : " with " + joined(plan.sets, ", ")) +
                             "; every setting in " + study_file::plan,
                         LILYTANK_VERSION,
                         std::to_string(plan.seed),
                         {}};
  write_study_summary(summary, document, dir);
  if constexpr (kDraws) draw_study(summary, document, dir, style);
  if constexpr (!kDraws) say_undrawn("plots");
  return printed(document, host);
}

int study_merge(const Arguments& arguments) {
  VerbOptions options("study merge", "DIR",
                      "Makes table.csv, one row a run, from what all shards have done.");
  const auto found = found_study(options, arguments, true);
  if (!found) return Exit::done;
  write_table(found->study, found->dir);
  return completeness(found->study, (fs::path(found->dir) / "table.csv").string());
}

int study_report(const Arguments& arguments, const Host& host) {
  VerbOptions options("study report", "DIR",
                      "Writes a study's statistics and plots beside its runs, and prints the "
                      "statistics.");
  FigureStyle style;
  add_figure_options(options, style);
  const auto found = found_study(options, arguments, true);
  if (!found) return Exit::done;
  std::cout << report(found->study, found->dir, style, host) << std::flush;
  return completeness(found->study, "results in " + found->dir);
}

int study_status(const Arguments& arguments) {
  VerbOptions options("study status", "DIR",
                      "Counts simulations that are done, missing and diverged.");
  options.add({"json", "print JSON"});
  const auto found = found_study(options, arguments, false);
  if (!found) return Exit::done;
  const StoredStudy& study = found->study;
  if (options.has("json")) {
    std::cout << json_text(status_json(study)) << std::flush;
    return Exit::done;
  }
  std::size_t width = 8;
  for (const Setting& setting : study.plan.settings) width = std::max(width, setting.label.size());
  std::cout << padded("setting", width) << "  done  missing  diverged\n";
  for (std::size_t s = 0; s < study.counts.size(); ++s) {
    const StoredStudy::Count& count = study.counts[s];
    const std::string missing =
        std::to_string(count.wanted - count.done) + (count.decided ? "" : " or more");
    std::cout << padded(study.plan.settings[s].label, width) << "  "
              << padded(std::to_string(count.done), 6) << padded(missing, 9) << count.failed
              << "\n";
  }
  std::cout << counts_text(study) << (study.complete ? ": complete\n" : "\n");
  return Exit::done;
}

}  // namespace lilytank::cli
