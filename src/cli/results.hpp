// Directories of results, where a report's numbers come from, and what is printed at the end.
#pragma once
#include <string>
#include <vector>

#include "cli/verbs.hpp"
#include "lilytank/render.hpp"
#include "lilytank/report.hpp"
#include "lilytank/study.hpp"

namespace lilytank::cli {

class VerbOptions;

/// Whether this program can draw. Calls of functions of render.hpp stand within `if constexpr
/// (kDraws)`; render_verb.cpp, nearly all of which would, leaves them to the preprocessor.
#ifdef LILYTANK_HAS_RENDER
inline constexpr bool kDraws = true;
#else
inline constexpr bool kDraws = false;
#endif
/// Says on stderr that this program cannot draw, and so makes no `what`.
void say_undrawn(const std::string& what);

/// Adds --figure-width and --no-titles, for figures on paper.
void add_figure_options(VerbOptions& options, FigureStyle& style);

/// Throws InputError if a directory can neither be there nor be made, as it or one above it is a
/// file. For --dry-run, writes nothing.
void check_directory_can_be(const std::string& dir);
/// Throws InputError also, unless `force`, if the directory belongs to a job of another kind than
/// `kind` ("diagnosis"). For --dry-run of jobs that find out late which earlier one is theirs.
void check_directory_of(const std::string& kind, const std::string& dir, bool force);
/// Throws InputError where run_study would refuse the directory, in the same words.
void check_directory_of(const StudyPlan& plan, const std::string& dir, bool force);

/// The command as a shell takes it, without options that change no number (--out, --threads,
/// --force, --quiet, --figure-width, --no-titles), the program's version, the seed, and the SHA-256
/// of the files that were read; of a directory of tracks each file counts. Files that cannot be
/// read are left out.
ReportProvenance provenance(const std::string& verb, const Arguments& arguments, std::uint64_t seed,
                            const std::vector<std::string>& inputs);
/// The command, its seed and the contents of its inputs as one word: that of a repeated command is
/// the same.
std::string identity_of(const ReportProvenance& provenance);

/// The report as text to print; the host receives it as a document.
std::string printed(const ReportDocument& report, const Host& host);
/// Prints the report, and the directory of the results; returns the exit code.
int print_results(const ReportDocument& report, const std::string& dir, const Host& host);

}  // namespace lilytank::cli
