// Disjoint sets of modules: what is latched to what.
#pragma once
#include <algorithm>
#include <numeric>
#include <vector>

namespace lilytank {

/// Sets of modules; a set is known by its first module.
class Sets {
 public:
  explicit Sets(int modules) : parent_(static_cast<std::size_t>(modules)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int first(int module) {
    int& parent = parent_[static_cast<std::size_t>(module)];
    return parent == module ? module : parent = first(parent);
  }
  void join(int a, int b) {
    a = first(a), b = first(b);
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

}  // namespace lilytank
