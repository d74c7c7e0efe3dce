// What is printed where a command fails.
#pragma once
#include <exception>
#include <string>

#include "cli/verbs.hpp"

namespace lilytank::cli {

/// The failure of the command `words` as one printable line without its end. A refusal that names
/// neither a file nor an option gets the last file of the command line; what is no refusal (memory
/// that ran out, a defect) gets the command.
std::string error_line(const Arguments& words, const std::exception_ptr& failure);

}  // namespace lilytank::cli
