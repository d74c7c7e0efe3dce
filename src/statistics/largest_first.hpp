// The order of a ranking.
#pragma once
#include <algorithm>
#include <functional>

namespace lilytank {

/// Sorts by a member, the largest first; equal ones stay in their order.
template <class List, class Member>
void largest_first(List& list, Member member) {
  std::ranges::stable_sort(list, std::ranges::greater{}, member);
}

}  // namespace lilytank
