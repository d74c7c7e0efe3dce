// Runs the real program as a user would.
#pragma once
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "support/temporary_directory.hpp"

namespace lilytank {

inline const std::string kTank = LILYTANK_SOURCE_DIR "/scenarios/experiments/tank.toml";

struct Answer {
  int code = -1;
  std::string out, err;
};

/// A working directory of its own, and the program run in it.
class Program {
 public:
  Program() {
    // Fontconfig keeps its tables until the program ends, which is not our leak.
    aside_.write("leaks", "leak:libfontconfig\n");
  }

  /// Runs `lilytank ARGUMENTS` through the shell, in the working directory.
  Answer operator()(const std::string& arguments) const {
    const std::string checks =
        "LSAN_OPTIONS=print_suppressions=0:suppressions=" + aside_.path("leaks");
    const std::string command = "cd '" + here.path() + "' && " + checks +
                                " '" LILYTANK_PROGRAM "' " + arguments + " 2>'" +
                                aside_.path("err") + "' <'" + input + "'";
    Answer outcome;
    FILE* pipe = ::popen(command.c_str(), "r");
    if (pipe == nullptr) return outcome;
    char buffer[4096];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) {
      outcome.out.append(buffer, n);
    }
    const int status = ::pclose(pipe);
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    outcome.err = aside_.read("err");
    return outcome;
  }

  /// Names and contents of all files in a folder of the working directory.
  std::map<std::string, std::string> files(const std::string& folder = "") const {
    std::map<std::string, std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(here.path(folder))) {
      const std::string name = std::filesystem::relative(entry.path(), here.path(folder)).string();
      if (entry.is_regular_file())
        found[name] = here.read((folder.empty() ? "" : folder + "/") + name);
    }
    return found;
  }
  std::vector<std::string> names(const std::string& folder = "") const {
    std::vector<std::string> out;
    for (const auto& [name, content] : files(folder)) out.push_back(name);
    return out;
  }

  TemporaryDirectory here;
  std::string input = "/dev/null";  ///< the file that is its standard input

 private:
  TemporaryDirectory aside_;
};

/// The digits after "fingerprint" on the last line of a summary.
inline std::string fingerprint_of(const std::string& out) {
  const auto at = out.rfind("fingerprint");
  if (at == std::string::npos || out.size() < 17) return "(none)";
  return out.substr(out.size() - 17, 16);
}

/// Few modules for a short time.
inline const std::string kTiny =
    "title = \"tiny\"\n[run]\nduration = 5\n[module]\ncount = 4\n[start]\nradius = 0.15\n";

/// A dimer: quick to form and to fall apart, for events of every kind.
inline const std::string kPairRules =
    "lilytank ruleset 1\nname pair\nhops counter-clockwise\ntarget\n  ##\nend\n"
    "join: (0,0) (0,0) -> (1,1)-(2,1)  p=1\npart: (1,1)-(2,1) -> (0,0) (0,0)  p=0.5\n";

}  // namespace lilytank
