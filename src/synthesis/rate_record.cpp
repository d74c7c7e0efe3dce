// Counts dockings and contacts of a world, species by species.
#include <algorithm>

#include "assemblies/pattern.hpp"
#include "lilytank/kinetics.hpp"

namespace lilytank {

RateRecord::RateRecord(const Ruleset& rules, int modules)
    : rules_(&rules), modules_(static_cast<std::size_t>(modules)) {
  const std::string single = key_of(canonical({PatternModule{}}));
  keys_ = {single};
  numbers_[single] = 0;
  count_ = {modules};
  seconds_ = {0};
  species_.assign(modules_.size(), 0);
  for (int k = 0; k < modules; ++k) modules_[k].assembly = k;
}

void RateRecord::pass(double time) {
  const double dt = time - time_;
  time_ = time;
  if (!(dt > 0)) return;
  bond_seconds_ += bonds_ * dt;
  for (std::size_t s = 0; s < count_.size(); ++s) {
    if (count_[s] == 0) continue;
    const double n = count_[s];
    seconds_[s] += n * dt;
    pair_seconds_[{static_cast<int>(s), static_cast<int>(s)}] += n * (n - 1) / 2 * dt;
    for (std::size_t t = s + 1; t < count_.size(); ++t)
      if (count_[t] > 0)
        pair_seconds_[{static_cast<int>(s), static_cast<int>(t)}] += n * count_[t] * dt;
  }
}

// The species of all that hangs on `first` by bonds, laid out from its faces.
int RateRecord::species_of_parts(int first, std::vector<int>& members) {
  members = {first};
  std::map<int, std::pair<Cell, int>> at = {{first, {Cell{}, 0}}};  // cell, quarter turns
  Pattern pattern;
  for (std::size_t k = 0; k < members.size(); ++k) {
    const Module& module = modules_[members[k]];
    const auto [cell, turn] = at.at(members[k]);
    PatternModule m;
    m.cell = cell;
    m.label = module.label;
    m.last = module.last < 0 ? -1 : (module.last + turn) & 3;
    for (int f = 0; f < 4; ++f) {
      const int other = module.partner[f];
      if (other < 0) continue;
      const int direction = (f + turn) & 3;
      m.bonds |= 1u << direction;
      const int others_turn = (direction + 2 - module.partner_face[f]) & 3;
      if (at.try_emplace(other, neighbour(cell, direction), others_turn).second)
        members.push_back(other);
    }
    pattern.push_back(m);
  }
  const auto [known, fresh] =
      numbers_.try_emplace(key_of(canonical(pattern)), static_cast<int>(keys_.size()));
  if (fresh) {
    keys_.push_back(known->first);
    count_.push_back(0);
    seconds_.push_back(0);
  }
  return known->second;
}

// Counts the assembly of a module anew; its members' old one must have been taken out before.
void RateRecord::regroup(int module) {
  std::vector<int> members;
  const int species = species_of_parts(module, members);
  const int slot = *std::min_element(members.begin(), members.end());
  for (const int member : members) modules_[member].assembly = slot;
  species_[slot] = species;
  ++count_[species];
}

void RateRecord::end_contact(const Event& event) {
  double& since = modules_[event.a].latched_at[event.face_a];
  if (since < 0) return;
  ++contacts_;
  contact_seconds_ += time_ - since;
  since = -1;
}

void RateRecord::enter(const Event& event) {
  Module& a = modules_[event.a];
  Module& b = modules_[event.b];
  const int slot_a = a.assembly, slot_b = b.assembly;
  --count_[species_[slot_a]];
  if (slot_b != slot_a) --count_[species_[slot_b]];
  a.label = event.label_a, a.last = event.last_a;
  b.label = event.label_b, b.last = event.last_b;
  if (event.kind == EventKind::link) {
    a.partner[event.face_a] = event.b, a.partner_face[event.face_a] = event.face_b;
    b.partner[event.face_b] = event.a, b.partner_face[event.face_b] = event.face_a;
    ++bonds_;
  } else if (event.kind == EventKind::unlink) {
    a.partner[event.face_a] = b.partner[event.face_b] = -1;
    --bonds_;
  }
  regroup(event.a);
  if (event.kind == EventKind::unlink) {
    std::vector<int> members;
    species_of_parts(event.a, members);
    if (std::find(members.begin(), members.end(), event.b) == members.end()) regroup(event.b);
  }
}

void RateRecord::observe(const Event& event, double time) {
  pass(time);
  if (event.b < 0 || event.kind == EventKind::command || event.kind == EventKind::report) return;
  const Module& a = modules_[event.a];
  const Module& b = modules_[event.b];
  const int of_a = species_[a.assembly];
  const int of_b = species_[b.assembly];
  const bool apart = a.assembly != b.assembly;
  const auto name = [&] { return rules_->rules[event.rule].name; };
  RateTable::Meeting* meeting =
      apart ? &meetings_[{std::min(of_a, of_b), std::max(of_a, of_b)}] : nullptr;
  switch (event.kind) {
    case EventKind::latch:
      if (meeting != nullptr) ++meeting->dockings;
      modules_[event.a].latched_at[event.face_a] = time;
      return;
    case EventKind::unlatch:
      ++decisions_;
      return end_contact(event);
    case EventKind::link:
      ++decisions_;
      end_contact(event);
      if (meeting != nullptr)
        ++meeting->links[name()];
      else
        ++changes_[of_a][name()];
      return enter(event);
    case EventKind::unlink:
    case EventKind::update:
      ++changes_[of_a][name()];
      return enter(event);
    default:
      return;
  }
}

void RateRecord::observe(const World& world) {
  for (const Event& event : world.events()) observe(event, world.time());
  evaluations_ = world.tallies().evaluations;
}

RateTable RateRecord::table(double time) const {
  RateRecord now = *this;
  now.pass(time);
  RateTable table;
  table.worlds = 1;
  table.seconds = time;
  for (const auto& [pair, seconds] : now.pair_seconds_)
    if (seconds > 0) now.meetings_[pair].exposure = seconds;
  for (auto& [pair, meeting] : now.meetings_) {
    const std::string &a = now.keys_[pair.first], &b = now.keys_[pair.second];
    table.meetings[{std::min(a, b), std::max(a, b)}] = meeting;
  }
  for (std::size_t s = 0; s < now.keys_.size(); ++s)
    table.standing[now.keys_[s]].exposure = now.seconds_[s];
  for (const auto& [species, changes] : now.changes_)
    table.standing[now.keys_[species]].changes = changes;
  table.evaluations = now.evaluations_ < 0 ? -1 : now.evaluations_ - now.decisions_;
  table.bond_seconds = now.bond_seconds_;
  table.contacts = now.contacts_;
  table.contact_seconds = now.contact_seconds_;
  return table;
}

MeasuredWorld measure_world(const Model& model, std::uint64_t seed, double duration,
                            const JobControl& control) {
  if (model.rulesets.size() != 1)
    throw InputError("rates are measured under one ruleset; the scenario has " +
                     std::to_string(model.rulesets.size()));
  MeasuredWorld measured;
  World world(model, seed);
  AssemblyRecord copies(model);
  RateRecord rates(model.rulesets.front(), model.module.count);
  while (world.time() < duration) {
    control.check_stop();
    if (world.step() == RunStatus::diverged) {
      measured.diverged = true;
      break;
    }
    copies.observe(world);
    rates.observe(world);
  }
  measured.rates = rates.table(world.time());
  measured.completion = copies.completion_times();
  return measured;
}

}  // namespace lilytank
