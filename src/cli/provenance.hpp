// Where the numbers of a report come from.
#pragma once
#include <string>
#include <vector>

#include "cli/verbs.hpp"
#include "lilytank/report.hpp"

namespace lilytank::cli {

/// The command as a shell takes it, without options that change no number (--out, --threads,
/// --force, --quiet), the program's version, the seed, and the SHA-256 of the files that were read;
/// of a directory of tracks each file counts. Files that cannot be read are left out.
ReportProvenance provenance(const std::string& verb, const Arguments& arguments, std::uint64_t seed,
                            const std::vector<std::string>& inputs);

/// The command, its seed and the contents of its inputs as one word: that of a repeated command is
/// the same.
std::string identity_of(const ReportProvenance& provenance);

}  // namespace lilytank::cli
