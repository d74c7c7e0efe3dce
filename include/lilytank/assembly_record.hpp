// What has been built: species, copies of the target, yield over time.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "lilytank/world.hpp"

namespace lilytank {

/// A kind of assembly: cells and bonds, up to turning, with the modules' ruleset states.
struct Species {
  std::string key;     ///< canonical text, equal for equal species
  int size = 1;        ///< modules
  bool legal = true;   ///< reachable by the ruleset from single modules
  bool target = false; ///< has the target's shape
  std::string drawing; ///< rows joined by '/', '#' a module, for reports
};

/// All species that a ruleset can make, by applying its rules to single modules until nothing new
/// comes; `closed` is false where `limit` stopped it, and legality is then not judged.
struct SpeciesTable {
  std::vector<Species> species;
  bool closed = true;
  bool contains(const std::string& key) const;
};
SpeciesTable reachable_species(const Ruleset& rules, int limit = 4096);

/// Follows a world: what stands now, and when copies of the target were completed.
class AssemblyRecord {
 public:
  explicit AssemblyRecord(const Model& model);
  /// Call after every step (cheap where nothing changed). A ruleset change starts a new table.
  void observe(const World& world);
  /// Rebuilds from a world (after a resume), keeping counters given by from_text.
  int copies() const { return copies_; }             ///< of the target, standing now
  int most_copies() const { return most_copies_; }
  int possible_copies() const { return possible_; }  ///< floor(modules / target size)
  /// Time at which the number of standing copies first reached 1, 2, ... (s).
  const std::vector<double>& completion_times() const { return completion_; }
  /// Standing assemblies by size; [0] unused.
  const std::vector<int>& by_size() const { return by_size_; }
  /// Assemblies ever seen that the ruleset cannot make (0 for a correct simulation).
  std::int64_t illegal() const { return illegal_; }
  /// Standing count of each species ever seen, by key.
  const std::map<std::string, int>& standing() const { return standing_; }
  const std::map<std::string, Species>& seen() const { return seen_; }
  /// [modules] 1 where the module is part of a standing copy.
  const std::vector<std::uint8_t>& complete() const { return complete_; }
  /// Firings and evaluations by rule, [rules of all rulesets in order].
  const std::vector<std::vector<std::int64_t>>& firings() const { return firings_; }
  /// Counters as text and back, for checkpoints.
  std::string to_text() const;
  void restore(const std::string& text, const World& world);

 private:
  void recount(const World& world);
  const Model* model_;
  int ruleset_ = -1;
  SpeciesTable table_;
  std::vector<Cell> target_;
  int copies_ = 0, most_copies_ = 0, possible_ = 0;
  std::int64_t illegal_ = 0;
  std::vector<double> completion_;
  std::vector<int> by_size_;
  std::map<std::string, int> standing_;
  std::map<std::string, Species> seen_;
  std::vector<std::uint8_t> complete_;
  std::vector<std::vector<std::int64_t>> firings_;
};

}  // namespace lilytank
