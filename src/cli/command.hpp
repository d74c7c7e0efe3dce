// A command line: its verb, and its failures as one line.
#pragma once
#include <exception>
#include <string>

#include "cli/verbs.hpp"

namespace lilytank::cli {

/// Does for the host what the words, a verb and its arguments, say; the exit code. Throws
/// InputError, Stopped.
int act(const Arguments& words, const Host& host);

/// A refusal of the command `words`. One that names neither a file nor an option gets the last file
/// of the command line.
std::string refusal_line(const Arguments& words, const std::string& message);

/// The failure of the command `words` as one printable line without its end: the refusal_line(), or
/// the command where it is no refusal (memory that ran out, a defect).
std::string error_line(const Arguments& words, const std::exception_ptr& failure);

}  // namespace lilytank::cli
