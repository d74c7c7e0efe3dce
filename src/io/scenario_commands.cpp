#include "io/scenario_commands.hpp"

#include <algorithm>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/scenario_values.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

/// In the order of CommandKind.
const std::vector<std::string>& command_words() {
  static const std::vector<std::string> words{"pause", "resume", "switch_off", "ruleset", "query"};
  return words;
}

constexpr double kLatest = 1e8;  // s

class CommandReader {
 public:
  CommandReader(const CommandTable& table, int modules, std::vector<RulesetFile>& files)
      : table_(&table), modules_(modules), files_(&files) {}

  ScheduledCommand read() {
    for (const Assignment& field : table_->fields) take(field);
    if (!has_at_)
      throw InputError(table_->place, "command.at is missing: when, as 3600 or \"1 h\"");
    if (!has_do_) throw InputError(table_->place, "command.do is missing: what, as \"pause\"");
    const bool wants_file = out_.command.kind == CommandKind::replace_ruleset;
    if (wants_file && file_ == nullptr) {
      throw InputError(table_->place, "command.file is missing: the ruleset to go on with");
    }
    if (!wants_file && file_ != nullptr) {
      throw InputError(file_->place, "command.file goes with do = \"ruleset\" only");
    }
    if (wants_file) read_file();
    return out_;
  }

 private:
  void take(const Assignment& field) {
    static const std::vector<std::string> names{"at", "do", "modules", "file"};
    const std::string name = field.path();
    if (name == "at") {
      take_time(field);
    } else if (name == "do") {
      take_word(field);
    } else if (name == "modules") {
      take_modules(field);
    } else if (name == "file") {
      file_ = &field;
    } else {
      throw InputError(field.key_places.front(),
                       "unknown key 'command." + name + "'" + did_you_mean(name, names));
    }
  }

  void take_time(const Assignment& field) {
    out_.command.at = number_of(field, "command.at", "s");
    has_at_ = true;
    if (out_.command.at >= 0 && out_.command.at <= kLatest) return;
    throw InputError(field.place, "command.at = " + shortest(out_.command.at) +
                                      " s is outside 0 .. " + shortest(kLatest) + " s");
  }

  void take_word(const Assignment& field) {
    const auto& words = command_words();
    const std::string word = text_of(field, "command.do");
    const auto found = std::find(words.begin(), words.end(), word);
    if (found == words.end()) throw unknown_word(field.place, "command.do", word, words);
    out_.command.kind = static_cast<CommandKind>(found - words.begin());
    has_do_ = true;
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
  ScheduledCommand out_;
  const Assignment* file_ = nullptr;
  bool has_at_ = false, has_do_ = false;
};

}  // namespace

std::vector<ScheduledCommand> read_commands(const std::vector<CommandTable>& tables, int modules,
                                            std::vector<RulesetFile>& files) {
  std::vector<ScheduledCommand> out;
  for (const CommandTable& table : tables)
    out.push_back(CommandReader(table, modules, files).read());
  std::stable_sort(out.begin(), out.end(),
                   [](const ScheduledCommand& a, const ScheduledCommand& b) {
                     return a.command.at < b.command.at;
                   });
  return out;
}

std::string command_word(CommandKind kind) {
  return command_words()[static_cast<std::size_t>(kind)];
}

}  // namespace lilytank
