#include "cli/results.hpp"

#include <filesystem>
#include <iostream>

#include "cli/options.hpp"
#include "io/atomic_file.hpp"
#include "io/sha256.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/error.hpp"
#include "recording/formats.hpp"
#include "study/study_directory.hpp"

namespace lilytank::cli {
namespace {

namespace fs = std::filesystem;

/// A word as a shell would need it.
std::string quoted(const std::string& word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./:=,%@";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

/// Words of a command without the options that change no number.
std::vector<std::string> essential(const Arguments& arguments) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& word = arguments[i];
    const std::string name = word.substr(0, word.find('='));
    if (name == "--force" || name == "--quiet" || name == "--open" || name == "--no-titles")
      continue;
    if (name == "--out" || name == "--tank-results" || name == "--threads" ||
        name == "--figure-width") {
      i += word == name ? 1 : 0;
      continue;
    }
    out.push_back(word);
  }
  return out;
}

}  // namespace

void add_figure_options(VerbOptions& options, FigureStyle& style) {
  options.add({"figure-width", "figures for paper: 85 (a column) or 174 (two columns)", "MM"},
              &style.width, 60, 400);
  options.add({"no-titles", "no sentences above figures"}, &style.untitled);
}

void check_directory_can_be(const std::string& dir) {
  std::error_code ignored;
  if (fs::exists(dir, ignored)) {
    if (fs::is_directory(dir, ignored)) return;
    throw InputError("'" + dir + "' is a file; the results need a directory");
  }
  fs::path above = fs::absolute(dir, ignored);
  while (above.has_relative_path() && !fs::exists(above, ignored)) above = above.parent_path();
  if (fs::is_directory(above, ignored)) return;
  throw InputError(system_problem("cannot make", dir, ENOTDIR));
}

void check_directory_of(const std::string& kind, const std::string& dir, bool force) {
  check_directory_can_be(dir);
  if (!force) refuse_foreign(dir, {}, kind);
}

void check_directory_of(const StudyPlan& plan, const std::string& dir, bool force) {
  check_directory_can_be(dir);
  check_study_directory(dir, plan, force);
}

ReportProvenance provenance(const std::string& verb, const Arguments& arguments, std::uint64_t seed,
                            const std::vector<std::string>& inputs) {
  ReportProvenance out;
  out.command = "lilytank " + verb;
  for (const std::string& word : essential(arguments)) out.command += " " + quoted(word);
  out.version = LILYTANK_VERSION, out.seed = std::to_string(seed);
  for (const std::string& input : inputs) {
    try {
      for (const std::string& file : files_of(input)) {
        out.inputs.emplace_back(file, sha256(read_whole(file)));
      }
    } catch (const InputError&) {
      // It was read a moment ago; the report is worth more than this line.
    }
  }
  return out;
}

std::string identity_of(const ReportProvenance& provenance) {
  std::string text = provenance.command + "\n" + provenance.version + "\n" + provenance.seed;
  for (const auto& [file, hash] : provenance.inputs) text += "\n" + hash;
  return sha256(text);
}

void say_undrawn(const std::string& what) {
  std::cerr << "no " << what
            << ": this program was built without the renderer (Cairo was not found)\n";
}

std::string printed(const ReportDocument& report, const Host& host) {
  if (host.report) host.report(report);
  return report_text(report);
}

int print_results(const ReportDocument& report, const std::string& dir, const Host& host) {
  std::cout << printed(report, host) << std::flush;
  std::cerr << "results in " << dir << "\n";
  return Exit::done;
}

}  // namespace lilytank::cli
