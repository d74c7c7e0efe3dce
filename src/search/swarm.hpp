// Particle swarm optimisation for noisy evaluations.
#pragma once
#include <string>
#include <vector>

#include "lilytank/search.hpp"
#include "search/selection.hpp"
#include "search/state_text.hpp"
#include "search/tally.hpp"

namespace lilytank {

inline constexpr const char* kSwarmKind = "swarm";

class Swarm final : public Search {
 public:
  /// Throws InputError on a space or options that make no sense.
  Swarm(SearchSpace space, SwarmOptions options, std::uint64_t seed);
  /// Throws InputError where the state makes no sense.
  explicit Swarm(StateReader& in);

  std::vector<Trial> ask() override;
  void tell(std::span<const double> values) override;
  Incumbent best() const override;
  const std::vector<IterationRecord>& history() const override { return history_; }
  bool selected() const override { return selection_.begun() && selection_.over(); }
  std::int64_t evaluations() const override { return evaluations_; }
  std::int64_t budget() const override;
  const SearchSpace& space() const override { return space_; }
  std::string save() const override;

 private:
  struct Particle {
    UnitPoint x, v, best_x;
    Tally now, best;  ///< values of x in this iteration, and of best_x
  };
  /// One wanted evaluation: of a particle's position or of its personal best.
  struct Slot {
    int particle = 0;
    bool of_best = false;
  };

  void place();
  void plan();
  void plan_fixed();
  void plan_shared();
  void want(int particle, bool of_best, int times);
  std::int64_t replicate_of(std::size_t slot) const;
  Tally& tally_of(const Slot& slot);
  int iteration_budget() const { return options_.particles * options_.evaluations; }

  void begin_selection();
  void finish_iteration();
  void record(std::vector<double> means);
  double spread() const;
  void move();
  void move_axis(Particle& particle, int i, const Particle& leader, std::size_t axis) const;
  int leader_of(int i) const;
  int leader_among(const std::vector<int>& particles) const;

  SearchSpace space_;
  SwarmOptions options_;
  std::uint64_t seed_;
  std::vector<Particle> particles_;
  int iteration_ = 0;  ///< that are over
  int spent_ = 0;      ///< evaluations received in this iteration
  int stage_ = 0;      ///< batches received in this iteration
  std::int64_t evaluations_ = 0;
  std::vector<Slot> wanted_;
  Selection selection_;  ///< begun after the last iteration
  std::vector<IterationRecord> history_;
};

}  // namespace lilytank
