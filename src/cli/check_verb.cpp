// lilytank check: what can be proved about a ruleset without physics.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "cli/check_kinetics.hpp"
#include "cli/progress.hpp"
#include "cli/results.hpp"
#include "io/atomic_file.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

void add_check_options(CheckJob& job) {
  VerbOptions& options = job.options;
  CheckOptions& check = job.check;
  options.add({"modules", "how many (15; with --measure the scenario's)", "M"}, &check.modules, 1,
              kMostModules);
  options.add({"lattice", "simulations of the lattice model (20)", "N"}, &check.lattice_runs, 0,
              100000);
  options.add({"attempts", "meetings in each (20000)", "N"}, &check.lattice.attempts, 1,
              1000000000);
  options.add({"seed", "of all random numbers (1)", "N"}, &job.measured.seed, 0, INT64_MAX);
  options.add({"dry-run", "read everything, write nothing"});
  options.add({"force", "replace other results"}, &job.force);
  options.add({"json", "print JSON"}, &job.json);
  options.add({"quiet", "no progress"}, &job.quiet);
  add_kinetics_options(job);
}

std::vector<std::string> input_files(const CheckJob& job) {
  std::vector<std::string> files = job.options.positional();
  files.insert(files.end(), job.scenarios.begin(), job.scenarios.end());
  files.push_back(job.options.text("rates"));
  std::erase_if(files, [](const std::string& file) {
    return file.empty() || std::filesystem::is_directory(file);
  });
  return files;
}

int dry_run(const CheckOptions& check, const CheckInput& input, const std::string& plan) {
  std::cout << "would check " << input.rules.name << " ("
            << counted(std::ssize(input.rules.rules), "rule") << ") for "
            << counted(check.modules, "module") << ", with "
            << counted(check.lattice_runs, "simulation") << " of the lattice model\n"
            << plan;
  return Exit::done;
}

std::string without_line_end(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

void add_kinetics(const KineticsReport& kinetics, ReportDocument& report) {
  ReportSection section;
  section.title = "Rates and well-mixed model";
  std::istringstream lines(kinetics.text);
  for (std::string line; std::getline(lines, line);) section.above.push_back(line);
  report.sections.push_back(std::move(section));
}

void write_report(const ReportDocument& report, const std::string& dir) {
  const std::filesystem::path path(dir);
  write_atomically((path / "check.txt").string(), report_text(report));
  write_atomically((path / "check.json").string(), report_json(report));
  std::vector<ReportPicture> pictures;
  const std::string yield = (path / "yield.svg").string();
  if (std::filesystem::exists(yield)) {
    pictures.push_back(
        {read_whole(yield), "yield",
         "Mean number of copies over time, in simulations and in the well-mixed model."});
  }
  write_atomically((path / "report.html").string(), report_html(report, pictures));
}

}  // namespace

int check_verb(const Arguments& arguments, const Host& host) {
  CheckJob job{VerbOptions(
      "check", "RULESET",
      "Proves which assemblies a ruleset can build, where it gets stuck and whether its "
      "reverse rules undo their joins. Measures rates in simulations and runs a "
      "well-mixed model on them.")};
  job.check.lattice_runs = 20, job.check.lattice.attempts = 20000;
  add_check_options(job);
  if (!job.options.parse(arguments)) return Exit::done;
  job.options.only("one ruleset, please: lilytank check scenarios/rulesets/chain5.rules");
  check_kinetics_options(job);
  const CheckInput input = check_input(job);
  job.check.modules = input.modules;
  job.check.lattice.seed = job.measured.seed;
  const std::string plan = kinetics_plan(job, input);
  if (job.options.has("dry-run")) return dry_run(job.check, input, plan);
  RulesetCheck check;
  {
    Progress progress(job.quiet, host);
    progress.watch(job.check);
    check = check_ruleset(input.rules, job.check);
    progress.clear();
  }
  ReportDocument report = check_report(input.rules, check);
  report.provenance = provenance("check", arguments, job.measured.seed, input_files(job));
  job.origin = report.provenance;
  if (!input.note.empty()) report.warnings.push_back(without_line_end(input.note));
  const KineticsReport kinetics = run_kinetics(job, input, host);
  if (!kinetics.text.empty()) add_kinetics(kinetics, report);
  const std::string text = printed(report, host);
  std::cout << (job.json ? report_json(report) : text) << std::flush;
  if (!kinetics.dir.empty() && job.options.has("measure")) write_report(report, kinetics.dir);
  if (kinetics.diverged > 0) return Exit::diverged;
  return check.faults.empty() ? Exit::done : Exit::fault;
}

}  // namespace lilytank::cli
