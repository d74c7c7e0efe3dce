#include "search/candidates.hpp"

namespace lilytank {

std::vector<OcbaCandidate> candidates_of(std::span<const Tally* const> tallies) {
  double squares = 0, freedom = 0;
  for (const Tally* t : tallies) {
    if (!t->usable()) continue;
    squares += t->squares, freedom += t->count - 1;
  }
  const double common = freedom > 0 ? squares / freedom : 1;
  std::vector<OcbaCandidate> out;
  for (const Tally* t : tallies) {
    const double own = t->usable() ? t->count - 1 : 0;
    const double variance =
        (kPriorValues * common + (own > 0 ? t->squares : 0)) / (kPriorValues + own);
    out.push_back({t->mean, std::sqrt(variance), t->count});
  }
  return out;
}

}  // namespace lilytank
