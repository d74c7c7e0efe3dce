#include "broadphase.hpp"

#include <cmath>

namespace lilytank {

Broadphase::Broadphase(int bodies, double extent, double radius) : extent_(extent) {
  const auto n = static_cast<std::size_t>(bodies);
  found_.reserve(n);
  cells_ = 0;
  if (bodies <= kAllPairs) return;
  const int most = 1 + static_cast<int>(2 * std::sqrt(static_cast<double>(bodies)));
  cells_ = std::clamp(static_cast<int>(extent / radius), 1, most);
  inverse_cell_ = 0.5 * cells_ / extent;
  begin_.resize(static_cast<std::size_t>(cells_ * cells_) + 1);
  entries_.reserve(6 * n);
  seen_.assign(n, 0);
}

int Broadphase::cell_of(double v) const {
  const double k = std::floor((v + extent_) * inverse_cell_);
  return static_cast<int>(std::clamp(k, 0.0, static_cast<double>(cells_ - 1)));
}

void Broadphase::build(std::span<const double> x, std::span<const double> y,
                       std::span<const double> radius) {
  x_ = x, y_ = y, radius_ = radius;
  if (cells_ == 0) return;
  const auto each_cell = [&](auto&& use) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const int left = cell_of(x[i] - radius[i]), right = cell_of(x[i] + radius[i]);
      const int low = cell_of(y[i] - radius[i]), high = cell_of(y[i] + radius[i]);
      for (int row = low; row <= high; ++row) {
        for (int column = left; column <= right; ++column)
          use(static_cast<int>(i), row * cells_ + column);
      }
    }
  };
  std::fill(begin_.begin(), begin_.end(), 0);
  each_cell([&](int, int cell) { ++begin_[cell]; });
  int sum = 0;
  for (int& b : begin_) sum += b, b = sum;  // the end of each cell; filling moves it to the start
  entries_.resize(static_cast<std::size_t>(sum));
  each_cell([&](int i, int cell) { entries_[--begin_[cell]] = i; });
}

// Bodies of all cells that a circle covers, above number `above`, ascending, each once.
void Broadphase::gather(double x, double y, double radius, int above) {
  found_.clear();
  ++stamp_;
  const int left = cell_of(x - radius), right = cell_of(x + radius);
  const int low = cell_of(y - radius), high = cell_of(y + radius);
  for (int row = low; row <= high; ++row) {
    for (int k = begin_[row * cells_ + left]; k < begin_[row * cells_ + right + 1]; ++k) {
      const int j = entries_[k];
      if (j <= above || seen_[j] == stamp_) continue;
      seen_[j] = stamp_;
      found_.push_back(j);
    }
  }
  std::sort(found_.begin(), found_.end());
}

}  // namespace lilytank
