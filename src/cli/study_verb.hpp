// What `lilytank study` and its further words share.
#pragma once
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "lilytank/study.hpp"

namespace lilytank::cli {

/// The one positional argument; refuses none or several.
std::string only_argument(const VerbOptions& options, const std::string& what);
/// Refuses --out if one of its `files`, which may be replaced, is one of the `inputs`: not even
/// --force removes what is read.
void spare_read(const VerbOptions& options, const std::vector<std::string>& files,
                const std::vector<std::string>& inputs);
/// Writes the statistics and, where there is a renderer, the plots beside them; returns the
/// statistics as text.
std::string report(const StoredStudy& study, const std::string& dir, const FigureStyle& style,
                   const Host& host);
/// "3 settings, 12 of 30 runs, 1 diverged".
std::string counts_text(const StoredStudy& study);

int study_merge(const Arguments& arguments);
int study_status(const Arguments& arguments);
int study_report(const Arguments& arguments, const Host& host);

}  // namespace lilytank::cli
