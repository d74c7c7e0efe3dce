// Whose the directory of an optimisation is.
#pragma once
#include <string>

#include "optimize/source.hpp"

namespace lilytank {

/// race/identity.txt, and what stands in it.
std::string race_identity_file(const std::string& dir);
std::string race_identity(const Optimization::Source& source);

/// Looks into a directory, changing nothing. Throws InputError if it holds another search or race,
/// unless `force`.
void check_search_directory(const Optimization::Source& source, const std::string& dir, bool force);

}  // namespace lilytank
