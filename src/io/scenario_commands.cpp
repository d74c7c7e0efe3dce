#include "io/scenario_commands.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/scenario_values.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

/// In the order of CommandKind.
const std::vector<std::string>& command_words() {
  static const std::vector<std::string> words{"pause",   "resume", "switch_off",
                                              "ruleset", "query",  "pump_power"};
  return words;
}

constexpr double kLatest = 1e8;  // s

class CommandReader {
 public:
  CommandReader(const CommandTable& table, int modules, std::vector<RulesetFile>& files)
      : table_(&table),
        modules_(modules),
        files_(&files),
        at_(field("at")),
        copies_(field("copies")),
        file_(field("file")),
        power_(field("power")) {}

  ScheduledCommand read() {
    check_names();
    const Assignment *what = field("do"), *modules = field("modules");
    if (what != nullptr) {
      const std::size_t kind = index_of_word(*what, "command.do", command_words());
      out_.command.kind = static_cast<CommandKind>(kind);
    }
    if (modules != nullptr) take_modules(*modules);
    take_when();
    if (what == nullptr) {
      throw InputError(table_->place, "command.do is missing: what, as \"pause\"");
    }
    check_copies();
    goes_with(file_, CommandKind::replace_ruleset, "file", "the ruleset to go on with");
    goes_with(power_, CommandKind::pump_power, "power", "how much, as \"50 %\"");
    if (file_ != nullptr) read_file();
    if (power_ != nullptr) out_.power = within(*power_, "power", "%", 100);
    return out_;
  }

 private:
  const Assignment* field(const std::string& name) const {
    const auto found = std::find_if(table_->fields.begin(), table_->fields.end(),
                                    [&](const Assignment& f) { return f.path() == name; });
    return found == table_->fields.end() ? nullptr : &*found;
  }

  void check_names() const {
    std::vector<std::string> names;
    for (const TomlKey& key : command_keys()) names.push_back(key.name);
    for (const Assignment& field : table_->fields) {
      const std::string name = field.path();
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      throw InputError(field.key_places.front(),
                       "unknown key 'command." + name + "'" + did_you_mean(name, names));
    }
  }

  // A command has a time; one that goes with the number of finished copies has that instead.
  void take_when() {
    if (at_ == nullptr && copies_ == nullptr) {
      throw InputError(table_->place,
                       "command.at is missing: when, as 3600 or \"1 h\" - or "
                       "command.copies, as 2");
    }
    if (at_ != nullptr) {
      out_.command.at = within(*at_, "at", "s", kLatest);
      if (copies_ == nullptr) return;
      throw InputError(copies_->place, "a command has either a time, at, or copies");
    }
    const double copies = within(*copies_, "copies", "1", modules_);
    if (copies < 1 || copies != std::floor(copies)) {
      throw InputError(copies_->place,
                       "command.copies = " + shortest(copies) + " is not 1, 2, 3, ...");
    }
    out_.command.copies = static_cast<int>(copies);
  }

  void check_copies() const {
    const CommandKind kind = out_.command.kind;
    if (copies_ == nullptr || kind == CommandKind::replace_ruleset ||
        kind == CommandKind::pump_power)
      return;
    throw InputError(copies_->place,
                     "command.copies goes with do = \"ruleset\" and \"pump_power\" only");
  }

  void goes_with(const Assignment* field, CommandKind kind, const std::string& name,
                 const std::string& what) const {
    const bool wanted = out_.command.kind == kind;
    if (wanted == (field != nullptr)) return;
    if (wanted) throw InputError(table_->place, "command." + name + " is missing: " + what);
    throw InputError(field->place,
                     "command." + name + " goes with do = \"" + command_word(kind) + "\" only");
  }

  static double within(const Assignment& field, const std::string& name, const std::string& unit,
                       double high) {
    const double value = number_of(field, "command." + name, unit);
    if (value >= 0 && value <= high) return value;
    const std::string shown = unit == "1" ? "" : " " + unit;
    throw InputError(field.place, "command." + name + " = " + shortest(value) + shown +
                                      " is outside 0 .. " + shortest(high) + shown);
  }

  void take_modules(const Assignment& field) {
    const auto* list = std::get_if<Numbers>(&field.value);
    if (list == nullptr) {
      throw InputError(field.place,
                       "command.modules is a list of module numbers, not " + kind_of(field.value));
    }
    for (const std::int64_t module : *list) {
      if (module < 0 || module >= modules_) {
        throw InputError(field.place, "command.modules names " + std::to_string(module) +
                                          "; modules are numbered 0 .. " +
                                          std::to_string(modules_ - 1));
      }
      out_.command.modules.push_back(static_cast<int>(module));
    }
  }

  void read_file() {
    const std::filesystem::path name = text_of(*file_, "command.file");
    const std::string path = (std::filesystem::path(file_->directory) / name).string();
    const auto known = std::find_if(files_->begin(), files_->end(),
                                    [&](const RulesetFile& f) { return f.file == path; });
    out_.file = static_cast<int>(known - files_->begin());
    if (known == files_->end()) files_->push_back({path, read_whole(path, file_->place)});
  }

  const CommandTable* table_;
  int modules_;
  std::vector<RulesetFile>* files_;
  const Assignment *at_, *copies_, *file_, *power_;
  ScheduledCommand out_;
};

}  // namespace

TomlKeys command_keys() {
  using namespace toml_key;
  return {number("at", "s", 0, kLatest, "when"),
          whole("copies", 1, 10000, "with so many finished copies, instead of a time"),
          needed(word("do", command_words(), "what")),
          numbers("modules", "which modules (all)"),
          text("file", "the ruleset to go on with, for do = \"ruleset\""),
          number("power", "%", 0, 100, "for do = \"pump_power\"")};
}

std::vector<ScheduledCommand> read_commands(const std::vector<CommandTable>& tables, int modules,
                                            std::vector<RulesetFile>& files) {
  std::vector<ScheduledCommand> out;
  for (const CommandTable& table : tables)
    out.push_back(CommandReader(table, modules, files).read());
  std::stable_sort(out.begin(), out.end(),
                   [](const ScheduledCommand& a, const ScheduledCommand& b) {
                     return std::pair(a.command.copies, a.command.at) <
                            std::pair(b.command.copies, b.command.at);
                   });
  return out;
}

std::string command_word(CommandKind kind) {
  return command_words()[static_cast<std::size_t>(kind)];
}

}  // namespace lilytank
