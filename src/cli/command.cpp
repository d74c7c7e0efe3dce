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
      {"run",
       "simulate one tank",
       run_verb,
       {"lilytank run scenarios/chain5.toml --seed 1 --set run.duration='20 min'",
        "lilytank run scenarios/chain5.toml scenarios/p_optimised_chain.toml --out out/optimised"}},
      {"study",
       "simulate many: settings, replicates, shards on many machines; statistics and plots",
       study_verb,
       {"lilytank study scenarios/studies/chain5_probabilities.toml",
        "lilytank study scenarios/studies/chain5_probabilities.toml --dry-run"}},
      {"optimize",
       "find the probabilities, rulesets and pump power that build a target best",
       optimize_verb,
       {"lilytank optimize scenarios/optimize/chain5.toml --dry-run"}},
      {"recording",
       "read, check and convert trackers' files; film a run",
       recording_verb,
       {"lilytank recording info scenarios/experiments/tank.toml",
        "lilytank recording convert scenarios/experiments/lily_1.csv.gz --out lily.csv"}},
      {"analyze",
       "statistics of runs and recordings, alone and compared",
       analyze_verb,
       {"lilytank analyze scenarios/experiments/tank.toml --body lily --longest-lag '5 s'"}},
      {"flow",
       "estimate the water's velocity from the tracks of balls",
       flow_verb,
       {"lilytank flow scenarios/experiments/tank.toml --estimator paper"}},
      {"calibrate",
       "estimate the model's parameters from recordings, with intervals",
       calibrate_verb,
       {"lilytank calibrate scenarios/experiments/tank.toml --dry-run"}},
      {"diagnose",
       "find effects that the model omits, from recordings",
       diagnose_verb,
       {"lilytank diagnose scenarios/experiments/tour.toml --dry-run",
        "lilytank diagnose scenarios/experiments/real/gliders.toml"}},
      {"prove",
       "benchmark the diagnosis on blinded synthetic experiments",
       prove_verb,
       {"lilytank prove --only null --minutes 1 --known-flow --dry-run"}},
      {"synthesize",
       "make a ruleset from the drawing of a target",
       synthesize_verb,
       {"lilytank synthesize scenarios/targets/cross5.txt --out cross.rules"}},
      {"check",
       "prove what a ruleset can build, where it gets stuck, how fast it would be",
       check_verb,
       {"lilytank check scenarios/rulesets/chain5.rules --modules 24"}},
      {"info",
       "explain a scenario: every value, unit, bounds, and where it was set",
       info_verb,
       {"lilytank info scenarios/chain5.toml --set flow.pump_power=80"}},
      {"forces", "document the force terms", forces_verb, {"lilytank forces face_drag"}},
      {"render",
       "draw a run: film, stills or one frame",
       render_verb,
       {"lilytank render out/chain5-seed1 --png frame.png --at 300"}},
      {"view",
       "play runs in a browser: one interactive HTML file",
       view_verb,
       {"lilytank view out/chain5-seed1 --open"}},
      {"export",
       "write results as NetCDF, or their provenance as an RO-Crate",
       export_verb,
       {"lilytank export out/chain5-seed1", "lilytank export out/chain5-seed1 --format ro-crate"}},
      {"schema",
       "JSON Schemas of scenario, experiment, bodies, study and optimize files, for editors",
       schema_verb,
       {"lilytank schema scenario > scenario.schema.json"}},
      {"completion",
       "completion of verbs, options and scenario keys for bash, zsh and fish",
       completion_verb,
       {"lilytank completion bash > ~/.local/share/bash-completion/completions/lilytank"}},
      {"man", "manual pages", man_verb, {"lilytank man run | man -l -"}},
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
  std::cout
      << "  help        lilytank help VERB: the options of a verb\n\n"
         "A file '-' is standard input. After '--' every word is a file, even if it begins with a "
         "dash.\n"
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
  for (const char* begin : {"lilytank ", "--", "cannot ", "'", "<stdin>"}) {
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
