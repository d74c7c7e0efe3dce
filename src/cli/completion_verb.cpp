// lilytank completion: what a shell offers at the tabulator key. The shells' scripts call this
// program, so they know every verb, option and scenario key of the program that is installed.
#include <iostream>

#include "cli/options.hpp"
#include "io/scenario_keys.hpp"
#include "lilytank/error.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

constexpr const char* kBash = R"sh(_lilytank() {
  local words
  words=$(lilytank completion candidates -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2> /dev/null)
  COMPREPLY=($(compgen -W "$words" -- "${COMP_WORDS[COMP_CWORD]}"))
  if [[ ${COMPREPLY[0]-} == *= ]]; then compopt -o nospace; fi
  if ((${#COMPREPLY[@]} == 0)); then
    compopt -o filenames
    COMPREPLY=($(compgen -f -- "${COMP_WORDS[COMP_CWORD]}"))
  fi
}
complete -F _lilytank lilytank
)sh";

constexpr const char* kZsh = R"sh(#compdef lilytank
_lilytank() {
  local -a candidates
  candidates=("${(@f)$(lilytank completion candidates -- "${(@)words[2,CURRENT]}" 2> /dev/null)}")
  if [[ ${candidates[1]-} == *= ]]; then
    compadd -S '' -a candidates
  else
    compadd -a candidates
  fi
  (( compstate[nmatches] )) || _files
}
compdef _lilytank lilytank
)sh";

constexpr const char* kFish = R"sh(function __lilytank_candidates
  set -l words (commandline -opc) (commandline -ct)
  lilytank completion candidates -- $words[2..-1] 2> /dev/null
end
complete -c lilytank -a '(__lilytank_candidates)'
)sh";

const std::vector<std::string> kShells{"bash", "zsh", "fish"};

std::vector<std::string> option_names(const Verb& verb, const std::string& own) {
  std::vector<std::string> out{"--help"};
  for (const Option& option : describe(verb, own).options) out.push_back("--" + option.name);
  return out;
}

std::vector<std::string> scenario_paths() {
  ScenarioDraft draft;
  std::vector<std::string> out;
  for (const ScenarioKey& key : scenario_keys(draft)) out.push_back(key.path + "=");
  return out;
}

/// What may stand where the last of `words`, which follow "lilytank", begins; nothing: files.
std::vector<std::string> candidates(const std::vector<std::string>& words) {
  if (words.size() < 2) {
    std::vector<std::string> out{"help"};
    for (const Verb& verb : verbs()) out.push_back(verb.name);
    return out;
  }
  const auto verb = std::find_if(verbs().begin(), verbs().end(),
                                 [&](const Verb& one) { return one.name == words[0]; });
  if (verb == verbs().end()) return {};
  const std::string &last = words.back(), &before = words[words.size() - 2];
  if (before == "--set") return scenario_paths();
  if (verb->name == "recording" && words.size() == 2) return kRecordingVerbs;
  if (verb->name == "completion" && words.size() == 2) return kShells;
  if (!last.starts_with("-")) return {};
  return option_names(*verb, verb->name == "recording" ? words[1] : "");
}

}  // namespace

int completion_verb(const Arguments& arguments, const Host&) {
  VerbOptions options("completion", "bash|zsh|fish",
                      "Prints the script that teaches a shell to complete verbs, options and, "
                      "after --set, the keys of scenarios.");
  if (!options.parse(arguments, "for which shell? there are " + joined(kShells, ", "))) {
    return Exit::done;
  }
  const std::vector<std::string>& words = options.positional();
  if (words[0] == "candidates") {
    for (const std::string& word : candidates({words.begin() + 1, words.end()})) {
      std::cout << word << "\n";
    }
    return Exit::done;
  }
  const std::string& shell = options.only("one shell at a time: " + joined(kShells, ", "));
  if (shell != "bash" && shell != "zsh" && shell != "fish") {
    options.refuse("'" + shell + "' is none of " + joined(kShells, ", ") +
                   did_you_mean(shell, kShells));
  }
  std::cout << (shell == "bash" ? kBash : shell == "zsh" ? kZsh : kFish);
  return Exit::done;
}

}  // namespace lilytank::cli
