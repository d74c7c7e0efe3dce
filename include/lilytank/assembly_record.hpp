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
  std::string key;      ///< canonical text, equal for equal species
  int size = 1;         ///< number of modules
  bool legal = true;    ///< reachable by the ruleset from single modules
  bool target = false;  ///< whether it has the target's shape, rotated but not mirrored
  std::string drawing;  ///< rows joined by '/', '#' a module, for reports
};

/// Number of species at which a search for all that a ruleset can make stops.
constexpr int kMostSpecies = 4096;

/// All species that a ruleset can make, by applying its rules to single modules until nothing new
/// comes; `closed` is false where a limit stopped it, and legality is then not judged.
struct SpeciesTable {
  std::vector<Species> species;  ///< in the order of discovery
  /// Whether the exploration ended by itself: then no other species is reachable.
  bool closed = true;
  /// Whether a species with this key is in the table.
  bool contains(const std::string& key) const;
};
/// `limit` species at most, of `largest` modules at most: for worlds of no more modules than that
/// the table is complete if it is closed. Rules with p = 0 do not fire. Joins of assemblies that
/// would overlap are left out; contacts other than the one that joins stay without a bond.
SpeciesTable reachable_species(const Ruleset& rules, int limit = kMostSpecies, int largest = 64);

/// Follows a world: what stands now, and when copies of the target were completed. An assembly is
/// what bonds connect (a new latch, not yet answered by a rule, connects nothing); in a model
/// without rulesets it is what latches connect. A standing copy is an assembly of the target's
/// shape, turned but not mirrored.
class AssemblyRecord {
 public:
  /// Begins with single modules and the model's first ruleset. `model` must outlive the record.
  explicit AssemblyRecord(const Model& model);
  /// Call after every step (cheap where nothing changed). A ruleset change starts a new table of
  /// legal species, which holds what stood at that moment as well; a change of the target's shape
  /// starts the count of copies anew.
  void observe(const World& world);
  /// Copies of the target that stand now.
  int copies() const { return copies_; }
  /// Largest number of copies that stood at one time.
  int most_copies() const { return most_copies_; }
  /// Largest number of copies that the modules can form.
  int possible_copies() const { return possible_; }
  /// Time at which the number of standing copies first reached 1, 2, ... (s).
  const std::vector<double>& completion_times() const { return completion_; }
  /// Standing assemblies by size; [0] unused.
  const std::vector<int>& by_size() const { return by_size_; }
  /// How often an assembly has appeared that the ruleset cannot make (0 for a correct simulation).
  std::int64_t illegal() const { return illegal_; }
  /// Standing count of each species ever seen, by key.
  const std::map<std::string, int>& standing() const { return standing_; }
  /// All species that ever stood, by key.
  const std::map<std::string, Species>& seen() const { return seen_; }
  /// [modules] 1 where the module is part of a standing copy.
  const std::vector<std::uint8_t>& complete() const { return complete_; }
  /// How often each rule fired: [ruleset][rule].
  const std::vector<std::vector<std::int64_t>>& firings() const { return firings_; }
  /// The counters as text, for checkpoints.
  std::string to_text() const;
  /// Inverse of to_text() on a new record of the same model: counters continue where the writer
  /// stood, and what stands is counted from `world`. Throws InputError if the text is not of a
  /// record of this model.
  void restore(const std::string& text, const World& world);

 private:
  void start_table(int ruleset, bool keep_standing);
  void build_table();
  bool count_firings(const World& world);
  void count(const World& world);
  void count_assembly(const State& state, int first, std::vector<std::uint8_t>& done);
  void recount(const World& world);
  bool connects(const Face& face) const;
  bool take_line(const std::string& line);
  const Model* model_;
  int ruleset_ = -1;
  SpeciesTable table_;
  std::vector<std::string> seeds_;  // species, beside single modules, that the table begins with
  std::vector<Cell> target_;        // canonical
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
