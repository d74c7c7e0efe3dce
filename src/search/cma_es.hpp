// CMA-ES for noisy evaluations in a box.
#pragma once
#include <string>
#include <vector>

#include "lilytank/search.hpp"
#include "search/cma_distribution.hpp"
#include "search/selection.hpp"
#include "search/state_text.hpp"
#include "search/tally.hpp"

namespace lilytank {

inline constexpr const char* kCmaEsKind = "cma-es";

class CmaEs final : public Search {
 public:
  /// Throws InputError on a space or options that make no sense.
  CmaEs(SearchSpace space, CmaEsOptions options, std::uint64_t seed);
  /// Throws InputError where the state makes no sense.
  explicit CmaEs(StateReader& in);

  std::vector<Trial> ask() override;
  void tell(std::span<const double> values) override;
  Incumbent best() const override;
  const std::vector<IterationRecord>& history() const override { return history_; }
  bool selected() const override { return selection_.begun() && selection_.over(); }
  std::int64_t evaluations() const override { return told_; }
  std::int64_t budget() const override { return options_.budget; }
  const SearchSpace& space() const override { return space_; }
  std::string save() const override;

 private:
  /// A point among the best that were sampled.
  struct Elite {
    UnitPoint point;
    Tally tally;
  };

  int first_population() const;
  std::vector<double> normals(int sample) const;
  UnitPoint point_of(int sample) const;
  int evaluations_each() const;
  int looked_at_twice() const;
  std::int64_t generation_cost() const;
  std::vector<Trial> ask_generation() const;
  void begin_selection();

  void tell_generation(std::span<const double> values);
  void learn(const std::vector<Tally>& tallies);
  void handle_uncertainty(double change);
  void keep_elite(const UnitPoint& point, const Tally& tally);
  void renew();
  bool stagnant() const;
  void record(std::vector<double> means);

  SearchSpace space_;
  CmaEsOptions options_;
  std::uint64_t seed_;
  CmaDistribution distribution_;
  std::int64_t generation_ = 0;  ///< that are over, all starts together
  double each_ = 1;              ///< evaluations of a sample, before rounding down
  std::int64_t told_ = 0;
  bool asked_ = false;         ///< a generation
  std::vector<double> lows_;   ///< lowest means of the generations since the last start
  std::vector<Elite> elites_;  ///< best first
  Selection selection_;
  std::vector<IterationRecord> history_;
};

void check_cma_es_options(const CmaEsOptions& options, const SearchSpace& space);
void save_cma_es_options(StateWriter& out, const CmaEsOptions& options);
CmaEsOptions load_cma_es_options(StateReader& in, const SearchSpace& space);

}  // namespace lilytank
