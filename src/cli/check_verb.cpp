// lilytank check: what can be proved about a ruleset without physics.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "cli/check_kinetics.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/provenance.hpp"
#include "io/atomic_file.hpp"
#include "lilytank/lattice.hpp"

namespace lilytank::cli {
namespace {

void add_check_options(VerbOptions& options) {
  const auto text = [] { return cxxopts::value<std::string>(); };
  options.add()("modules", "how many (15; with --measure the scenario's)", text(), "M")(
      "lattice", "simulations of the lattice model (20)", text(), "N")(
      "attempts", "meetings in each (20000)", text(), "N")(
      "seed", "of all random numbers (1)", text(), "N")("force", "replace other results")(
      "quiet", "no progress");
  add_kinetics_options(options);
}

std::vector<std::string> input_files(const VerbOptions& options) {
  std::vector<std::string> files = options.positional();
  for (const std::string& file : options.list("measure")) files.push_back(file);
  if (options.has("rates")) files.push_back(options.text("rates"));
  std::erase_if(files, [](const std::string& file) { return std::filesystem::is_directory(file); });
  return files;
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

int check_verb(const Arguments& arguments) {
  VerbOptions options(
      "check", "RULESET",
      "Proves which assemblies a ruleset can build, where it gets stuck and whether its "
      "reverse rules undo their joins. Measures rates in simulations and runs a "
      "well-mixed model on them.");
  add_check_options(options);
  if (!options.parse(arguments)) return Exit::done;
  if (options.positional().size() != 1)
    options.refuse("one ruleset, please: lilytank check scenarios/rulesets/chain5.rules");
  check_kinetics_options(options);
  const CheckInput input = check_input(options);
  CheckOptions job;
  job.modules = input.modules;
  job.lattice_runs = static_cast<int>(options.whole("lattice", 20, 0, 100000));
  job.lattice.attempts = options.whole("attempts", 20000, 1, 1000000000);
  job.lattice.seed = static_cast<std::uint64_t>(options.whole("seed", 1, 0, INT64_MAX));
  RulesetCheck check;
  {
    Progress progress(options.has("quiet"));
    progress.watch(job);
    check = check_ruleset(input.rules, job);
    progress.clear();
  }
  ReportDocument report = check_report(input.rules, check);
  report.provenance = provenance("check", arguments, job.lattice.seed, input_files(options));
  if (!input.note.empty()) report.warnings.push_back(without_line_end(input.note));
  const KineticsReport kinetics = run_kinetics(options, input);
  if (!kinetics.text.empty()) add_kinetics(kinetics, report);
  std::cout << report_text(report) << std::flush;
  if (!kinetics.dir.empty() && options.has("measure")) write_report(report, kinetics.dir);
  if (kinetics.diverged > 0) return Exit::diverged;
  return check.faults.empty() ? Exit::done : Exit::fault;
}

}  // namespace lilytank::cli
