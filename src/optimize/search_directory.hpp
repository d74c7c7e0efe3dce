// Output directory of an optimisation: ownership and overwriting.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "jobs/directory_lock.hpp"
#include "optimize/source.hpp"

namespace lilytank {

/// race/identity.txt, and what stands in it.
std::string race_identity_file(const std::string& dir);
std::string race_identity(const Optimization::Source& source);
/// Where a contestant's rules are written.
std::string ruleset_file(const std::string& dir, const Optimization::Source& contestant);

/// Paths of what an optimisation has left in a directory, and of files that have such names.
std::vector<std::string> files_of_search(const std::string& dir);

/// Looks into a directory, changing nothing. Throws InputError if it holds another search or race,
/// a run, or files with names of results that are nobody's, unless `force`; and if the comparison
/// would overwrite a study file of the user's.
void check_search_directory(const Optimization::Source& source, const std::string& dir, bool force);
/// Makes the directory if absent, locks it and, with `force`, removes what is not of this
/// optimisation. Returns the lock, to be held until the last result is written. Throws InputError
/// as check_search_directory() does, and if another process is at work there.
std::shared_ptr<const DirectoryLock> claim_search_directory(const Optimization::Source& source,
                                                            const std::string& dir, bool force);

}  // namespace lilytank
