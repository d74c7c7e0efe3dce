// An assembly record as text and back, for checkpoints.
#include <algorithm>
#include <sstream>

#include "assemblies/pattern.hpp"
#include "lilytank/assembly_record.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

const char* const kHeader = "lilytank assembly record 1";

// Whether a text from a file is a species of a world with that many modules.
bool is_key(const std::string& key, int modules) {
  const Pattern pattern = pattern_of(key);
  if (pattern.empty() || static_cast<int>(pattern.size()) > modules) return false;
  const bool small = std::all_of(pattern.begin(), pattern.end(), [&](const PatternModule& m) {
    return m.cell.x >= 0 && m.cell.x < modules && m.cell.y >= 0 && m.cell.y < modules;
  });
  return small && key_of(canonical(pattern)) == key;
}

}  // namespace

std::string AssemblyRecord::to_text() const {
  std::ostringstream out;
  out << kHeader << "\nruleset " << ruleset_ << "\nillegal " << illegal_ << "\nmost "
      << most_copies_ << "\n";
  for (const double time : completion_) out << "completion " << shortest(time) << "\n";
  for (const std::string& key : seeds_) out << "seed " << key << "\n";
  for (std::size_t r = 0; r < firings_.size(); ++r) {
    for (std::size_t k = 0; k < firings_[r].size(); ++k)
      if (firings_[r][k] > 0) out << "fired " << r << " " << k << " " << firings_[r][k] << "\n";
  }
  for (const auto& [key, species] : seen_) out << "seen " << key << " " << species.legal << "\n";
  return out.str() + "end\n";
}

bool AssemblyRecord::take_line(const std::string& line) {
  std::istringstream in(line);
  std::string word, key;
  in >> word;
  if (word == "ruleset") {
    in >> ruleset_;
  } else if (word == "illegal") {
    in >> illegal_;
  } else if (word == "most") {
    in >> most_copies_;
  } else if (word == "completion") {
    in >> key;
    const auto time = parse_number(key);
    completion_.push_back(time.value_or(0));
    return time.has_value();
  } else if (word == "seed") {
    in >> key;
    seeds_.push_back(key);
    return is_key(key, model_->module.count);
  } else if (word == "fired") {
    std::size_t r = 0, k = 0;
    std::int64_t number = 0;
    in >> r >> k >> number;
    if (!in || r >= firings_.size() || k >= firings_[r].size()) return false;
    firings_[r][k] = number;
  } else if (word == "seen") {
    bool legal = true;
    in >> key >> legal;
    if (!is_key(key, model_->module.count)) return false;
    seen_[key] = species_of(pattern_of(key), {});
    seen_[key].legal = legal;
    standing_[key] = 0;
  } else {
    return false;
  }
  return !in.fail();
}

void AssemblyRecord::restore(const std::string& text, const World& world) {
  AssemblyRecord fresh(*model_);
  std::istringstream in(text);
  std::string line;
  bool good = std::getline(in, line) && line == kHeader;
  while (good && std::getline(in, line) && line != "end") good = fresh.take_line(line);
  const int rulesets = std::max<int>(1, static_cast<int>(model_->rulesets.size()));
  if (!good || line != "end" || fresh.ruleset_ >= rulesets)
    throw InputError("the checkpoint's assembly record does not fit this scenario, at '" + line +
                     "'");
  if (fresh.ruleset_ >= 0) {
    fresh.build_table();
    for (auto& [key, species] : fresh.seen_)
      species.target = species_of(pattern_of(key), fresh.target_).target;
    fresh.count(world);
  }
  *this = std::move(fresh);
}

}  // namespace lilytank
