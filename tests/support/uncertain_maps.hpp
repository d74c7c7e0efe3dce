// Flow maps with errors.
#pragma once
#include <cmath>
#include <vector>

#include "lilytank/flow_maps.hpp"
#include "lilytank/random.hpp"

namespace lilytank::test {

// An error is the sum of 60 bumps of this width (m) and this deviation along an axis (m/s).
inline FlowMaps uncertain_maps(const FlowField& field, double error, double width = 0.04) {
  constexpr int kDraws = 300, kBumps = 60;
  constexpr double kSide = 0.6;  // m
  constexpr std::uint64_t kSeed = 3;
  const double pitch = 2 * field.extent() / field.cells();
  std::vector<FlowDifference> draws;
  for (int d = 0; d < kDraws; ++d) {
    FlowDifference one(field.samples().size());
    for (int k = 0; k < kBumps; ++k) {
      const auto number = static_cast<std::uint32_t>(k);
      const auto size = normal_pair({kSeed, Stream::calibrate, d, number, 1});
      const double px = kSide * (uniform({kSeed, Stream::calibrate, d, number, 2}) - 0.5);
      const double py = kSide * (uniform({kSeed, Stream::calibrate, d, number, 3}) - 0.5);
      for (std::size_t i = 0; i < one.size(); ++i) {
        const auto wide = static_cast<std::size_t>(field.cells());
        const double x = (static_cast<double>(i % wide) + 0.5) * pitch - field.extent() - px;
        const double y = (static_cast<double>(i / wide) + 0.5) * pitch - field.extent() - py;
        const double share = std::exp(-0.5 * (x * x + y * y) / (width * width));
        one[i].mu_x += error * size[0] * share, one[i].mu_y += error * size[1] * share;
      }
    }
    draws.push_back(std::move(one));
  }
  const std::vector<FlowDifference> no_bias{FlowDifference(field.samples().size())};
  return {field, no_bias, std::move(draws)};
}

}  // namespace lilytank::test
