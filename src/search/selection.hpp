// The last stage of a search: which of the leading points is best, by new values only.
#pragma once
#include <vector>

#include "lilytank/search.hpp"
#include "search/state_text.hpp"
#include "search/tally.hpp"

namespace lilytank {

/// A point in the unit box.
using UnitPoint = std::vector<double>;

/// How many candidates a selection with so many evaluations should have, at most.
int selection_size(int evaluations);

class Selection {
 public:
  Selection() = default;
  /// At least one candidate; `first_replicate` is the first that no candidate had.
  Selection(std::vector<UnitPoint> points, int evaluations, std::int64_t first_replicate);
  Selection(StateReader& in, std::size_t axes);

  bool begun() const { return !points_.empty(); }
  bool over() const { return spent_ >= evaluations_; }
  /// What to evaluate next; empty once it is over. `evaluated`: values received so far.
  std::vector<Trial> ask(const SearchSpace& space, std::int64_t evaluated,
                         bool common_random_numbers);
  /// Number of trials requested and not yet evaluated.
  std::size_t asked() const { return asked_.size(); }
  void tell(std::span<const double> values);
  /// Whether every candidate has values.
  bool known() const { return begun() && tallies_[0].count > 0; }

  const UnitPoint& point(int candidate) const;
  const Tally& tally(int candidate) const;
  /// The lowest mean, the first of equals.
  int leader() const;
  /// Rising.
  std::vector<double> means() const;
  void save(StateWriter& out) const;

 private:
  std::vector<int> plan() const;

  std::vector<UnitPoint> points_;
  std::vector<Tally> tallies_;
  std::vector<int> asked_;  ///< candidates, equal ones side by side
  int evaluations_ = 0, spent_ = 0, stage_ = 0;
  std::int64_t first_replicate_ = 0;
};

}  // namespace lilytank
