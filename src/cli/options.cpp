#include "cli/options.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "io/standard_input.hpp"
#include "io/units.hpp"
#include "lilytank/error.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

namespace fs = std::filesystem;

bool among(const std::string& word, const std::vector<std::string>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Whether both are one file or directory, by whatever names, there already or not.
bool same_file(const fs::path& a, const fs::path& b) {
  if (a.empty() || b.empty()) return false;
  std::error_code ignored;
  if (fs::equivalent(a, b, ignored)) return true;
  const auto whole = [&](const fs::path& p) {
    return fs::weakly_canonical(fs::absolute(p, ignored), ignored);
  };
  return whole(a) == whole(b);
}

}  // namespace

VerbDescription describe(const Verb& verb, const std::string& own) {
  try {
    verb.act(own.empty() ? Arguments{kDescribe} : Arguments{own, kDescribe}, {});
  } catch (const VerbDescription& description) {
    return description;
  } catch (const InputError&) {
    // Its options are those of its own verbs.
  }
  return {"", verb.summary, {}};
}

std::string examples_of(const std::string& verb) {
  const auto found = std::find_if(verbs().begin(), verbs().end(),
                                  [&](const Verb& one) { return one.name == verb; });
  if (found == verbs().end() || found->examples.empty()) return "";
  return "\nExamples:\n  " + joined(found->examples, "\n  ") + "\n";
}

VerbOptions::VerbOptions(const std::string& verb, const std::string& usage,
                         const std::string& summary)
    : verb_(verb), description_{usage, summary, {}}, options_("lilytank " + verb, summary) {
  options_.custom_help("[OPTION...] " + usage);
  options_.add_options()("h,help", "print this");
}

void VerbOptions::add(const Option& option, const std::shared_ptr<cxxopts::Value>& type,
                      const std::function<void()>& store) {
  description_.options.push_back(option);
  options_.add_options()(option.name, option.help, type, option.value);
  stores_.push_back([=, this] {
    if (store && has(option.name)) store();
  });
}

void VerbOptions::add(const Option& option) {
  if (option.value.empty()) return add(option, cxxopts::value<bool>(), nullptr);
  add(option, cxxopts::value<std::string>(), nullptr);
}

void VerbOptions::add(const Option& option, bool* out) {
  add(option, cxxopts::value<bool>(), [=] { *out = true; });
}

void VerbOptions::add(const Option& option, std::string* out,
                      const std::vector<std::string>& words) {
  add(option, cxxopts::value<std::string>(), [=, this] {
    *out = text(option.name);
    if (words.empty() || among(*out, words)) return;
    refuse("--" + option.name + " " + *out + " is none of " + joined(words, ", ") +
           did_you_mean(*out, words));
  });
}

void VerbOptions::add_list(const Option& option) {
  add(option, cxxopts::value<std::vector<std::string>>(), nullptr);
}

void VerbOptions::add(const Option& option, std::vector<std::string>* out) {
  add(option, cxxopts::value<std::vector<std::string>>(), [=, this] { *out = list(option.name); });
}

void VerbOptions::add(const Option& option, double* out, double low, double high,
                      const std::string& unit) {
  add(option, cxxopts::value<std::string>(),
      [=, this] { *out = number(option.name, low, high, unit); });
}

void VerbOptions::add_seed(const std::string& help, std::vector<std::string>* sets) {
  constexpr std::int64_t kLargest = 1'000'000'000'000'000'000;
  add({"seed", help, "N"}, cxxopts::value<std::string>(),
      [=, this] { sets->push_back("run.seed=" + std::to_string(whole("seed", 0, kLargest))); });
}

bool VerbOptions::parse(const Arguments& arguments, const std::string& none_given) {
  if (arguments == Arguments{kDescribe}) throw description_;
  // What follows "--" are files, even if they begin with a dash.
  const auto end = std::find(arguments.begin(), arguments.end(), "--");
  const Arguments before(arguments.begin(), end);
  check_names(before);
  options_.allow_unrecognised_options();  // positional arguments are the unrecognised ones
  const std::string program = "lilytank " + verb_;
  std::vector<const char*> words{program.c_str()};
  for (const std::string& argument : before) words.push_back(argument.c_str());
  try {
    result_ = options_.parse(static_cast<int>(words.size()), words.data());
  } catch (const cxxopts::exceptions::exception& e) {
    refuse(e.what());
  }
  positional_ = result_.unmatched();
  for (const std::string& word : positional_) {
    if (word.size() > 1 && word[0] == '-') refuse("unknown option '" + word + "'");
  }
  name_standard_input();
  if (end != arguments.end()) positional_.insert(positional_.end(), end + 1, arguments.end());
  if (has("help")) {
    std::cout << options_.help() << examples_of(verb_);
    return false;
  }
  if (!none_given.empty() && positional_.empty()) refuse(none_given);
  for (const auto& store : stores_) store();
  return true;
}

void VerbOptions::name_standard_input() {
  const auto dash = std::find(positional_.begin(), positional_.end(), "-");
  if (dash == positional_.end()) return;
  if (std::find(dash + 1, positional_.end(), "-") != positional_.end()) {
    refuse("standard input is read once: write '-' for one file only");
  }
  *dash = kStandardInput;
}

void VerbOptions::check_names(const Arguments& arguments) {
  std::vector<std::string> known;
  for (const cxxopts::HelpOptionDetails& option : options_.group_help("").options) {
    for (const std::string& name : option.l) {
      known.push_back("--" + name);
      if (option.is_boolean) switches_.push_back(name);
    }
  }
  for (const std::string& argument : arguments) {
    if (!argument.starts_with("--")) continue;
    const std::string name = argument.substr(0, argument.find('='));
    if (!among(name, known)) refuse("unknown option '" + name + "'" + did_you_mean(name, known));
    if (name != argument && among(name.substr(2), switches_)) {
      check_switch(name, argument.substr(name.size() + 1));
    }
  }
}

// The library's own message would not name the option.
void VerbOptions::check_switch(const std::string& name, const std::string& value) const {
  if (value == "true" || value == "false") return;
  refuse(name + " is true or false, not '" + value + "'");
}

bool VerbOptions::has(const std::string& name) const {
  if (result_.count(name) == 0) return false;
  return !among(name, switches_) || result_[name].as<bool>();
}

std::string VerbOptions::text(const std::string& name, const std::string& otherwise) const {
  return has(name) ? result_[name].as<std::string>() : otherwise;
}

std::vector<std::string> VerbOptions::list(const std::string& name) const {
  return has(name) ? result_[name].as<std::vector<std::string>>() : std::vector<std::string>{};
}

const std::string& VerbOptions::only(const std::string& message) const {
  if (positional_.size() != 1) refuse(message);
  return positional_.front();
}

std::string VerbOptions::out(const std::string& otherwise) const {
  const std::string dir = text("out", otherwise);
  if (dir.empty()) refuse("--out is empty");
  return dir;
}

double VerbOptions::number(const std::string& name, double low, double high,
                           const std::string& unit) const {
  const std::string word = text(name);
  auto value = parse_number(word);
  if (!value && !unit.empty()) {
    value = read_quantity(word, unit, "--" + name, SourcePlace{"lilytank " + verb_, 0, 0});
  }
  if (!value) refuse("--" + name + " " + word + " is not a number");
  if (*value < low || *value > high) {
    refuse("--" + name + " " + word + " is outside " + shortest(low) + " .. " + shortest(high) +
           (unit.empty() ? "" : " " + unit));
  }
  return *value;
}

std::int64_t VerbOptions::whole(const std::string& name, std::int64_t low,
                                std::int64_t high) const {
  const std::string word = text(name);
  const auto value = parse_whole(word);
  if (!value) refuse("--" + name + " " + word + " is not a whole number");
  if (*value < low || *value > high) {
    refuse("--" + name + " " + word + " is outside " + std::to_string(low) + " .. " +
           std::to_string(high));
  }
  return *value;
}

void VerbOptions::refuse_given(const std::vector<std::string>& names,
                               const std::string& why) const {
  for (const std::string& name : names) {
    if (has(name)) refuse("--" + name + " " + why);
  }
}

void VerbOptions::spare_inputs(const std::string& option, const std::string& file,
                               const std::vector<std::string>& inputs) const {
  for (const std::string& input : inputs) {
    if (!same_file(file, input)) continue;
    refuse("--" + option + " would overwrite '" + input + "', which is read; choose another name");
  }
}

void VerbOptions::spare_directory(const std::string& option, const std::string& dir,
                                  const std::vector<std::string>& inputs) const {
  for (const std::string& input : inputs) {
    if (input == kStandardInput) continue;
    const fs::path in = fs::path(input).parent_path();
    if (!same_file(dir, in.empty() ? fs::path(".") : in)) continue;
    refuse("--" + option + " '" + dir + "' holds '" + input +
           "', which is read; choose another directory");
  }
}

void VerbOptions::spare_each_other(const std::vector<std::string>& names) const {
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!same_file(text(names[j]), text(names[i]))) continue;
      refuse("--" + names[j] + " and --" + names[i] + " are one file, '" + text(names[i]) +
             "'; choose two");
    }
  }
}

void VerbOptions::refuse(const std::string& message) const {
  throw InputError("lilytank " + verb_ + ": " + message);
}

}  // namespace lilytank::cli
