// Refusals in the words of the command line.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "cli/command.hpp"
#include "lilytank/error.hpp"

namespace lilytank::python {

/// The value of `work`; its InputErrors read as those of `lilytank verb files...`.
template <class Work>
decltype(auto) with_command(const std::string& verb, const std::vector<std::string>& files,
                            Work&& work) {
  try {
    return std::forward<Work>(work)();
  } catch (const InputError& e) {
    cli::Arguments words{verb};
    words.insert(words.end(), files.begin(), files.end());
    throw InputError(cli::refusal_line(words, e.what()));
  }
}

}  // namespace lilytank::python
