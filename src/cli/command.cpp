#include "cli/command.hpp"

#include <filesystem>
#include <iostream>
#include <map>
#include <new>

#include "lilytank/error.hpp"
#include "text/printable.hpp"
#include "text/words.hpp"

namespace lilytank::cli {

const std::vector<Verb>& verbs() {
  static const std::vector<Verb> all{
      {"run", "simulate one tank", run_verb},
      {"study",
       "simulate many: settings, replicates, shards on many machines; statistics and plots",
       study_verb},
      {"optimize", "find the probabilities, rulesets and pump power that build a target best",
       optimize_verb},
      {"recording", "read, check and convert trackers' files; film a run", recording_verb},
      {"analyze", "statistics of runs and recordings, alone and compared", analyze_verb},
      {"flow", "estimate the water's velocity from the tracks of balls", flow_verb},
      {"calibrate", "estimate the model's parameters from recordings, with intervals",
       calibrate_verb},
      {"diagnose", "find effects that the model omits, from recordings", diagnose_verb},
      {"prove", "benchmark the diagnosis on blinded synthetic experiments", prove_verb},
      {"synthesize", "make a ruleset from the drawing of a target", synthesize_verb},
      {"check", "prove what a ruleset can build, where it gets stuck, how fast it would be",
       check_verb},
      {"info", "explain a scenario: every value, unit, bounds, and where it was set", info_verb},
      {"forces", "document the force terms", forces_verb},
      {"render", "draw a run: film, stills or one frame", render_verb},
      {"view", "play runs in a browser: one interactive HTML file", view_verb},
      {"export", "write results as NetCDF, or their provenance as an RO-Crate", export_verb},
      {"schema",
       "JSON Schemas of scenario, experiment, bodies, study and optimize files, for editors",
       schema_verb},
      {"completion", "completion of verbs, options and scenario keys for bash, zsh and fish",
       completion_verb},
      {"man", "manual pages", man_verb},
  };
  return all;
}

namespace {

void print_help() {
  std::cout << "lilytank " LILYTANK_VERSION
               ": floating modules that assemble themselves in a stirred tank\n\n"
               "usage: lilytank VERB [OPTION...] FILE...\n\n";
  for (const Verb& verb : verbs()) {
    std::string name = verb.name;
    name.resize(12, ' ');
    std::cout << "  " << name << verb.summary << "\n";
  }
  std::cout << "  help        lilytank help VERB: the options of a verb\n\n"
               "After '--' every word is a file, even if it begins with a dash.\n"
               "exit codes: 0 done, 1 a simulation diverged or a check found a fault, 2 bad input, "
               "3 stopped (repeat the command to resume)\n";
}

const Verb& find_verb(const std::string& name) {
  const auto found = std::find_if(verbs().begin(), verbs().end(),
                                  [&](const Verb& verb) { return verb.name == name; });
  if (found != verbs().end()) return *found;
  // What other programs call it.
  static const std::map<std::string, std::string> synonyms{{"simulate", "run"},
                                                           {"sweep", "study"},
                                                           {"batch", "study"},
                                                           {"optimise", "optimize"},
                                                           {"fit", "calibrate"},
                                                           {"tune", "optimize"},
                                                           {"plot", "render"},
                                                           {"video", "render"},
                                                           {"movie", "render"},
                                                           {"analyse", "analyze"},
                                                           {"convert", "recording convert"},
                                                           {"benchmark", "prove"},
                                                           {"validate", "check"},
                                                           {"explain", "info"},
                                                           {"show", "info"},
                                                           {"stats", "analyze"},
                                                           {"compile", "synthesize"},
                                                           {"synthesise", "synthesize"}};
  if (const auto synonym = synonyms.find(name); synonym != synonyms.end()) {
    throw InputError("unknown verb '" + name + "' - did you mean '" + synonym->second + "'?");
  }
  std::vector<std::string> names{"help", "--help", "--version"};
  for (const Verb& verb : verbs()) names.push_back(verb.name);
  std::string help = did_you_mean(name, names);
  if (help.empty()) help = " - 'lilytank help' lists what there is";
  throw InputError("unknown verb '" + name + "'" + help);
}

bool asks_for_help(const std::string& word) {
  return word == "help" || word == "--help" || word == "-h";
}

bool exists(const std::string& file) {
  std::error_code ignored;
  return !file.empty() && std::filesystem::exists(file, ignored);
}

/// Whether a refusal says what it is about: an option, a place in a file, or a file in quotes.
bool names_its_subject(const std::string& message) {
  for (const char* begin : {"lilytank ", "--", "cannot ", "'"}) {
    if (message.starts_with(begin)) return true;
  }
  if (exists(message.substr(0, message.find(':')))) return true;
  for (auto open = message.find('\''); open != std::string::npos;) {
    const auto close = message.find('\'', open + 1);
    if (close == std::string::npos) return false;
    if (exists(message.substr(open + 1, close - open - 1))) return true;
    open = close;
  }
  return false;
}

}  // namespace

int act(const Arguments& words, const Host& host) {
  if (words.empty()) throw InputError("which verb? 'lilytank help' lists what there is");
  const Arguments rest(words.begin() + 1, words.end());
  if (words[0] == "--version" || words[0] == "-V" || words[0] == "version") {
    std::cout << "lilytank " LILYTANK_VERSION "\n";
    return Exit::done;
  }
  const bool help = asks_for_help(words[0]);
  if (help && !rest.empty() && !asks_for_help(rest[0]))
    return find_verb(rest[0]).act({"--help"}, host);
  if (!help) return find_verb(words[0]).act(rest, host);
  print_help();
  return Exit::done;
}

std::string refusal_line(const Arguments& words, const std::string& message) {
  if (names_its_subject(message)) return message;
  std::string file;
  for (std::size_t k = 1; k < words.size(); ++k) {  // the first one is the verb
    if (!exists(words[k])) continue;
    if (message.find(words[k]) != std::string::npos) return message;
    if (words[k - 1] != "--out") file = words[k];
  }
  return file.empty() ? message : file + ": " + message;
}

std::string error_line(const Arguments& words, const std::exception_ptr& failure) {
  const std::string command = "lilytank " + joined(words, " ");
  try {
    std::rethrow_exception(failure);
  } catch (const InputError& e) {
    return printable(refusal_line(words, e.what()));
  } catch (const std::bad_alloc&) {
    return printable(command + ": out of memory");
  } catch (const std::exception& e) {
    return printable(command + ": unexpected: " + e.what());
  } catch (...) {
    return printable(command + ": unexpected failure");
  }
}

}  // namespace lilytank::cli
