#include <iostream>

#include "cli/options.hpp"
#include "lilytank/error.hpp"
#include "lilytank/force.hpp"
#include "text/number.hpp"

namespace lilytank::cli {
namespace {

void print_term(const ForceTerm& term) {
  std::cout << term.name() << (term.baseline() ? " (on by default)" : "") << "\n  "
            << term.summary() << "\n  " << term.equation() << "\n";
  for (const Parameter& p : term.parameters()) {
    const std::string unit = p.unit == "1" ? "" : " " + std::string(p.unit);
    std::cout << "  forces." << term.name() << "." << p.name << " = " << shortest(p.standard)
              << unit << "  (" << shortest(p.low) << " .. " << shortest(p.high)
              << (p.whole ? ", whole" : "") << "): " << p.meaning << "\n";
  }
}

}  // namespace

int forces_verb(const Arguments& arguments, const Host&) {
  VerbOptions options("forces", "[NAME]",
                      "Documents the force terms: equation, parameters, bounds.");
  if (!options.parse(arguments)) return Exit::done;
  if (options.positional().size() > 1) options.refuse("one name at a time, or none for all");
  if (options.positional().empty()) {
    for (const ForceTerm* term : force_library()) {
      if (term != force_library().front()) std::cout << "\n";
      print_term(*term);
    }
    return Exit::done;
  }
  const std::string& name = options.positional().front();
  const ForceTerm* term = find_force(name);
  if (term == nullptr) {
    std::vector<std::string> names;
    for (const ForceTerm* known : force_library()) names.emplace_back(known->name());
    options.refuse("unknown force '" + name + "'" + did_you_mean(name, names));
  }
  print_term(*term);
  return Exit::done;
}

}  // namespace lilytank::cli
