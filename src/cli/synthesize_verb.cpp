// lilytank synthesize: a ruleset from the drawing of a target.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "cli/options.hpp"
#include "cli/results.hpp"
#include "io/atomic_file.hpp"
#include "lilytank/synthesis.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

namespace fs = std::filesystem;

std::vector<double> probabilities(const VerbOptions& options) {
  std::vector<double> found;
  std::string text = options.text("probabilities");
  if (!options.has("probabilities")) return found;
  text += ',';
  for (std::size_t at = 0, end; (end = text.find(',', at)) != std::string::npos; at = end + 1) {
    const std::string word(trimmed(std::string_view(text).substr(at, end - at)));
    const auto value = parse_number(word);
    if (!value || !(*value >= 0 && *value <= 1))
      options.refuse("--p: '" + word + "' is not a probability 0 .. 1");
    found.push_back(*value);
  }
  return found;
}

// The bonds of another drawing of the same cells, laid over the target.
void take_bonds(const VerbOptions& options, const std::string& option, Target& target) {
  const Target drawn = read_target(options.text(option));
  if (drawn.cells != target.cells)
    options.refuse("--" + option + " " + drawn.file + " draws other cells than " + target.file);
  if (option == "order" && !drawn.ordered)
    options.refuse("--order " + drawn.file + " has no numbered bonds, as '#1#2#'");
  if (drawn.bonds.size() + 1 != drawn.cells.size())
    options.refuse("--" + option + " " + drawn.file + ": " + std::to_string(drawn.bonds.size()) +
                   " bonds are drawn, a tree of " + std::to_string(drawn.cells.size()) +
                   " modules has " + std::to_string(drawn.cells.size() - 1));
  target.bonds = drawn.bonds;
  target.ordered = drawn.ordered;
}

Algorithm algorithm(const VerbOptions& options, const Target& target) {
  const bool ordered = target.ordered && !options.has("tree");
  const std::string word = options.text("algorithm", ordered ? "plan" : "singleton");
  const Algorithm found = algorithm_of(word);
  if (options.has("order") && found != Algorithm::plan)
    options.refuse("--order gives the whole plan: --algorithm " + word + " has no say in it");
  return found;
}

// The file: rules, with what made them and what is to be known as comments.
std::string file_text(const Plan& plan, const Ruleset& rules, const std::vector<Note>& notes) {
  const std::string text = to_text(rules);
  const std::size_t first = text.find('\n') + 1;
  std::string comments = "# Made by lilytank synthesize, algorithm " +
                         algorithm_names()[static_cast<std::size_t>(plan.algorithm)] + ".\n";
  for (const Note& note : notes)
    comments += std::string(note.warning ? "# Warning: " : "# Note: ") + note.text + ".\n";
  return text.substr(0, first) + comments + text.substr(first);
}

// The picture and its caption.
void add_figure(const VerbOptions& options, const Target& target, const Plan& plan,
                const FigureStyle& style, NamedContents& files) {
  if constexpr (kDraws) {
    const std::string file = options.text("figure");
    const std::vector<Stage> stages = stages_of(target, plan);
    const auto joins = static_cast<std::int64_t>(stages.size()) - 1;
    const std::string title = target.name + " takes " + counted(joins, "join") + ".";
    files.emplace_back(file, stages_picture(target, stages, title, file, style));
    files.emplace_back(caption_file(file), stages_caption(target, stages));
  } else {
    options.refuse("--figure: this program was built without the renderer (Cairo was not found)");
  }
}

// Every plan's rules as NAME-01.rules, ... in a directory.
int write_all(const VerbOptions& options, const Target& target, const EmitOptions& emitting,
              int modules) {
  const std::string dir = options.text("all");
  const PlanList list = all_plans(target);
  make_directory(dir);
  const std::size_t digits = std::to_string(list.plans.size()).size();
  NamedContents files;
  for (std::size_t k = 0; k < list.plans.size(); ++k) {
    const Plan& plan = list.plans[k];
    std::string number = std::to_string(k + 1);
    number.insert(0, digits - number.size(), '0');
    Ruleset rules = emit(target, plan, emitting);
    rules.name = target.name + "-" + number;
    const std::string file = (fs::path(dir) / (rules.name + ".rules")).string();
    files.emplace_back(file, file_text(plan, rules, notes_on(target, plan, rules, modules)));
  }
  write_results(files, options.has("force"));
  for (std::size_t k = 0; k < files.size(); ++k) {
    const auto algorithm = static_cast<std::size_t>(list.plans[k].algorithm);
    std::cout << files[k].first << "  " << algorithm_names()[algorithm] << "\n";
  }
  std::cout << std::flush;
  std::cerr << counted(static_cast<std::int64_t>(list.plans.size()), "ruleset") << " in " << dir
            << (list.complete ? "" : "; there are more (a limit was met)") << "\n";
  return Exit::done;
}

void add_synthesize_options(VerbOptions& options, EmitOptions& emitting, int& modules,
                            FigureStyle& style) {
  options.add({"algorithm", "singleton (the default), linchpin, balanced, or plan", "WORD"});
  options.add({"tree", "a drawing of the same cells with the bonds to use", "FILE"});
  options.add({"order", "a drawing with numbered bonds: the whole plan", "FILE"});
  options.add({"modules", "how many there will be: warns of deadlocks", "M"}, &modules, 1, 100000);
  options.add(
      {"probabilities", "of r1_reverse, r2_reverse, ... as 0.01,0.005; --p for short", "LIST"});
  options.add({"closures", "rules for the contacts that close a finished loop"},
              &emitting.closures);
  options.add({"name", "of the ruleset (default: the target's)", "WORD"});
  options.add({"out", "file for the rules (default: the terminal)", "FILE"});
  options.add({"figure", "the stages of the assembly as .svg, .png or .pdf", "FILE"});
  add_figure_options(options, style);
  options.add({"all", "the rules of all plans: every tree, algorithm and order", "DIR"});
  options.add({"force", "replace files of other contents"});
}

// The library takes a name of one letter for a short option, which has one dash.
Arguments with_long_name(Arguments arguments) {
  for (std::string& word : arguments)
    if (word == "--p" || word.starts_with("--p=")) word.insert(3, "robabilities");
  return arguments;
}

// Every option has an effect, and no drawing is overwritten.
void check_outputs(const VerbOptions& options) {
  if (options.has("all")) {
    options.refuse_given({"out", "figure"}, "is of one plan; --all writes all into its directory");
    options.refuse_given({"algorithm", "order"}, "chooses a plan, and --all makes all of them");
  }
  std::vector<std::string> drawings = options.positional();
  for (const char* option : {"tree", "order"}) drawings.push_back(options.text(option));
  for (const char* option : {"out", "figure"}) {
    options.spare_inputs(option, options.text(option), drawings);
  }
  options.spare_each_other({"out", "figure"});
}

}  // namespace

int synthesize_verb(const Arguments& arguments, const Host&) {
  VerbOptions options("synthesize", "TARGET.txt",
                      "Makes a ruleset that builds a target: a drawing of '#' for modules, with "
                      "bonds '-' and '|' between spaced ones where they matter.");
  EmitOptions emitting;
  int modules = 0;
  FigureStyle style;
  add_synthesize_options(options, emitting, modules, style);
  if (!options.parse(with_long_name(arguments))) return Exit::done;
  const std::string& file =
      options.only("one target, please: lilytank synthesize scenarios/targets/chain5.txt");
  check_outputs(options);
  if (!options.has("figure")) {
    options.refuse_given({"figure-width", "no-titles"}, "goes with --figure");
  }
  Target target = read_target(file);
  if (options.has("name")) {
    // The same rule for names as in a drawing.
    target.name = parse_target("name " + options.text("name") + "\n##\n", "--name").name;
  }
  if (options.has("tree") && options.has("order")) options.refuse("--tree or --order, not both");
  for (const char* option : {"tree", "order"})
    if (options.has(option)) take_bonds(options, option, target);
  emitting.p = probabilities(options);
  if (options.has("all")) return write_all(options, target, emitting, modules);
  const Plan plan = make_plan(target, algorithm(options, target));
  const Ruleset rules = emit(target, plan, emitting);
  const std::vector<Note> notes = notes_on(target, plan, rules, modules);
  const std::string text = file_text(plan, rules, notes);
  NamedContents files;
  if (options.has("out")) files.emplace_back(options.text("out"), text);
  if (options.has("figure")) add_figure(options, target, plan, style, files);
  write_results(files, options.has("force"));
  if (!options.has("out")) std::cout << text << std::flush;
  for (const Note& note : notes)
    std::cerr << (note.warning ? "warning: " : "note: ") << note.text << "\n";
  return Exit::done;
}

}  // namespace lilytank::cli
