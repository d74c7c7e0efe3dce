#include "lilytank/assembly_record.hpp"

#include <algorithm>

#include "assemblies/pattern.hpp"

namespace lilytank {
AssemblyRecord::AssemblyRecord(const Model& model) : model_(&model) {
  const auto modules = static_cast<std::size_t>(model.module.count);
  by_size_.assign(modules + 1, 0);
  complete_.assign(modules, 0);
  for (const Ruleset& rules : model.rulesets) firings_.emplace_back(rules.rules.size(), 0);
}

bool AssemblyRecord::connects(const Face& face) const {
  const bool latch = model_->rulesets.empty() && face.status == FaceStatus::latched;
  return face.status == FaceStatus::bonded || latch;
}

// The legal species of the ruleset in force, from single modules and seeds_.
void AssemblyRecord::build_table() {
  target_.clear();
  possible_ = 0;
  table_ = {{}, false};
  if (model_->rulesets.empty()) return;
  const Ruleset& rules = model_->rulesets[ruleset_];
  target_ = canonical_shape(rules.target);
  possible_ = lilytank::possible_copies(rules, model_->module.count);
  std::vector<Pattern> seeds;
  for (const std::string& key : seeds_) seeds.push_back(pattern_of(key));
  table_ = species_from(rules, seeds, kMostSpecies, std::max(1, model_->module.count));
}

void AssemblyRecord::start_table(int ruleset, bool keep_standing) {
  seeds_.clear();
  if (keep_standing) {
    for (const auto& [key, number] : standing_)
      if (number > 0) seeds_.push_back(key);
  }
  const std::vector<Cell> old_target = target_;
  ruleset_ = ruleset;
  build_table();
  if (target_ == old_target) return;
  copies_ = most_copies_ = 0;
  completion_.clear();
  // What was seen stays, but "target" speaks of the target in force.
  for (auto& [key, species] : seen_) species.target = species_of(pattern_of(key), target_).target;
}

// One assembly: its species, its size, and whether it is a copy of the target.
void AssemblyRecord::count_assembly(const State& state, int first,
                                    std::vector<std::uint8_t>& done) {
  std::vector<int> members = {first};
  done[first] = 1;
  Pattern pattern;
  for (std::size_t k = 0; k < members.size(); ++k) {
    const int i = members[k];
    const Firmware& firmware = state.firmware[i];
    PatternModule m;
    m.cell = {state.cell_x[i], state.cell_y[i]};
    m.label = firmware.label;
    m.last = firmware.last < 0 ? -1 : (firmware.last + state.turn[i]) & 3;
    for (int f = 0; f < 4; ++f) {
      const Face& face = state.faces[4 * i + f];
      if (!connects(face)) continue;
      m.bonds |= 1u << ((f + state.turn[i]) & 3);
      std::uint8_t& known = done[face.partner];
      if (known == 0) known = 1, members.push_back(face.partner);
    }
    pattern.push_back(m);
  }
  const Species species = species_of(canonical(pattern), target_);
  ++by_size_[members.size()];
  ++standing_[species.key];
  seen_.try_emplace(species.key, species);
  if (!species.target) return;
  ++copies_;
  for (const int i : members) complete_[i] = 1;
}

void AssemblyRecord::count(const World& world) {
  std::fill(by_size_.begin(), by_size_.end(), 0);
  std::fill(complete_.begin(), complete_.end(), std::uint8_t{0});
  for (auto& [key, number] : standing_) number = 0;
  copies_ = 0;
  std::vector<std::uint8_t> done(complete_.size(), 0);
  for (std::size_t i = 0; i < done.size(); ++i)
    if (done[i] == 0) count_assembly(world.firmware(), static_cast<int>(i), done);
}

// Counts, and compares with the count before: what is new and illegal, what was completed.
void AssemblyRecord::recount(const World& world) {
  const std::map<std::string, int> before = standing_;
  count(world);
  for (const auto& [key, number] : standing_) {
    const auto old = before.find(key);
    const int appeared = number - (old == before.end() ? 0 : old->second);
    if (appeared <= 0 || !table_.closed || table_.contains(key)) continue;
    illegal_ += appeared;
    seen_[key].legal = false;
  }
  while (most_copies_ < copies_) {
    ++most_copies_;
    completion_.push_back(world.time());
  }
}

// Adds up the rules that fired; true if an assembly may have changed.
bool AssemblyRecord::count_firings(const World& world) {
  bool changed = false;
  for (const Event& event : world.events()) {
    switch (event.kind) {
      case EventKind::link:
      case EventKind::unlink:
      case EventKind::update:
        ++firings_[ruleset_][event.rule];
        changed = true;
        break;
      case EventKind::latch:
        changed = changed || model_->rulesets.empty();
        break;
      default:
        break;
    }
  }
  return changed;
}

void AssemblyRecord::observe(const World& world) {
  // A ruleset comes into force at the start of a step: this step's firings are its own.
  bool changed = ruleset_ != world.firmware().ruleset;
  if (changed) start_table(world.firmware().ruleset, ruleset_ >= 0);
  changed = count_firings(world) || changed;
  if (changed) recount(world);
}

}  // namespace lilytank
