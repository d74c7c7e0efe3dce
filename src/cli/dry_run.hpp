// What --dry-run finds out about directories of results, writing nothing.
#pragma once
#include <string>

#include "lilytank/study.hpp"

namespace lilytank::cli {

/// Throws InputError if a directory can neither be there nor be made, as it or one above it is a
/// file.
void check_directory_can_be(const std::string& dir);
/// Throws InputError where run_study would refuse the directory, in the same words.
void check_directory_of(const StudyPlan& plan, const std::string& dir, bool force);

}  // namespace lilytank::cli
