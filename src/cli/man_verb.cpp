// lilytank man: manual pages made from the verbs' own descriptions.
#include <iostream>

#include "cli/options.hpp"
#include "lilytank/error.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

/// A text whose dashes, backslashes and leading dots roff leaves alone.
std::string roff(const std::string& text) {
  std::string out = text.starts_with(".") || text.starts_with("'") ? "\\&" : "";
  for (const char c : text) {
    if (c == '-' || c == '\\') out += '\\';
    out += c == '\\' ? 'e' : c;
  }
  return out;
}

void print_head(const std::string& name, const std::string& summary) {
  std::cout << ".TH " << roff(name) << " 1 \"\" \"lilytank " LILYTANK_VERSION "\"\n.SH NAME\n"
            << roff(name) << " \\- " << roff(summary) << "\n.SH SYNOPSIS\n";
}

void print_options(const VerbDescription& verb) {
  for (const Option& option : verb.options) {
    std::cout << ".TP\n.B " << roff("--" + option.name)
              << (option.value.empty() ? "" : " \\fI" + roff(option.value) + "\\fR") << "\n"
              << roff(option.help) << "\n";
  }
}

void print_program() {
  print_head("lilytank", "floating modules that assemble themselves in a stirred tank");
  std::cout << ".B lilytank\n.I VERB\n[\\fIOPTION\\fR...] \\fIFILE\\fR...\n.SH VERBS\n";
  for (const Verb& verb : verbs()) {
    std::cout << ".TP\n.BR lilytank\\-" << roff(verb.name) << " (1)\n"
              << roff(verb.summary) << "\n";
  }
  std::cout << ".SH EXIT STATUS\n0 done, 1 a simulation diverged or a check found a fault, 2 bad "
               "input, 3 stopped (the same command resumes)\n";
}

void print_verb(const Verb& verb) {
  const VerbDescription main = describe(verb);
  print_head("lilytank-" + verb.name, verb.summary);
  const bool several = verb.name == "recording";
  std::cout << ".B lilytank " << roff(verb.name) << "\n"
            << roff("[OPTION...] " +
                    (several ? joined(kRecordingVerbs, "|") + " FILE..." : main.usage))
            << "\n.SH DESCRIPTION\n"
            << roff(main.summary) << "\n.SH OPTIONS\n";
  print_options(main);
  for (const std::string& own : several ? kRecordingVerbs : std::vector<std::string>{}) {
    const VerbDescription one = describe(verb, own);
    std::cout << ".SS " << roff(own + " " + one.usage) << "\n" << roff(one.summary) << "\n";
    print_options(one);
  }
  std::cout << ".SH EXAMPLES\n";
  for (const std::string& example : verb.examples) {
    std::cout << ".PP\n.nf\n" << roff(example) << "\n.fi\n";
  }
  std::cout << ".SH SEE ALSO\n.BR lilytank (1)\n";
}

}  // namespace

int man_verb(const Arguments& arguments, const Host&) {
  VerbOptions options("man", "[VERB]",
                      "Prints a manual page: of the program, or of a verb. Show it by: lilytank "
                      "man run | man -l -");
  if (!options.parse(arguments)) return Exit::done;
  if (options.positional().empty()) {
    print_program();
    return Exit::done;
  }
  const std::string& name = options.only("one verb at a time");
  std::vector<std::string> names;
  for (const Verb& verb : verbs()) {
    names.push_back(verb.name);
    if (verb.name != name) continue;
    print_verb(verb);
    return Exit::done;
  }
  options.refuse("there is no verb '" + name + "'" + did_you_mean(name, names));
}

}  // namespace lilytank::cli
