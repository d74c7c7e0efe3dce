// Flow maps with errors.
#pragma once
#include <cmath>
#include <vector>

#include "lilytank/flow_maps.hpp"
#include "lilytank/random.hpp"

namespace lilytank::test {

// Adds a bump at (px, py), of this width (m), times the velocities along x and y (m/s).
inline void add_bump(const FlowField& field, double px, double py, double width, double along_x,
                     double along_y, FlowDifference& to) {
  const double pitch = 2 * field.extent() / field.cells();
  const auto wide = static_cast<std::size_t>(field.cells());
  for (std::size_t i = 0; i < to.size(); ++i) {
    const double x = (static_cast<double>(i % wide) + 0.5) * pitch - field.extent() - px;
    const double y = (static_cast<double>(i / wide) + 0.5) * pitch - field.extent() - py;
    const double share = std::exp(-0.5 * (x * x + y * y) / (width * width));
    to[i].mu_x += along_x * share, to[i].mu_y += along_y * share;
  }
}

// An error is the sum of 60 bumps of this width (m) and this deviation along an axis (m/s).
inline FlowMaps uncertain_maps(const FlowField& field, double error, double width = 0.04) {
  constexpr int kDraws = 300, kBumps = 60;
  constexpr double kSide = 0.6;  // m
  constexpr std::uint64_t kSeed = 3;
  std::vector<FlowDifference> draws;
  for (int d = 0; d < kDraws; ++d) {
    FlowDifference one(field.samples().size());
    for (int k = 0; k < kBumps; ++k) {
      const auto number = static_cast<std::uint32_t>(k);
      const auto size = normal_pair({kSeed, Stream::calibrate, d, number, 1});
      const double px = kSide * (uniform({kSeed, Stream::calibrate, d, number, 2}) - 0.5);
      const double py = kSide * (uniform({kSeed, Stream::calibrate, d, number, 3}) - 0.5);
      add_bump(field, px, py, width, error * size[0], error * size[1], one);
    }
    draws.push_back(std::move(one));
  }
  const std::vector<FlowDifference> no_bias{FlowDifference(field.samples().size())};
  return {field, no_bias, std::move(draws)};
}

// An error is the sum of bumps of this width and this deviation along an axis, a width apart over
// the tank: they are the components.
inline FlowMaps maps_with_components(const FlowField& field, double error, double width = 0.05) {
  constexpr int kDraws = 600;
  constexpr double kFarthest = 0.3;  // m
  constexpr std::uint64_t kSeed = 4;
  std::vector<FlowDifference> components;
  for (double y = -kFarthest; y <= kFarthest; y += width) {
    for (double x = -kFarthest; x <= kFarthest; x += width) {
      if (std::hypot(x, y) > kFarthest) continue;
      for (const bool along_x : {true, false}) {
        components.emplace_back(field.samples().size());
        add_bump(field, x, y, width, along_x ? error : 0, along_x ? 0 : error, components.back());
      }
    }
  }
  std::vector<FlowDifference> draws;
  for (int d = 0; d < kDraws; ++d) {
    FlowDifference one(field.samples().size());
    for (std::size_t k = 0; k < components.size(); ++k) {
      const double z =
          normal_pair({kSeed, Stream::calibrate, d, static_cast<std::uint32_t>(k), 1})[0];
      for (std::size_t i = 0; i < one.size(); ++i) {
        one[i].mu_x += z * components[k][i].mu_x, one[i].mu_y += z * components[k][i].mu_y;
      }
    }
    draws.push_back(std::move(one));
  }
  const std::vector<FlowDifference> no_bias{FlowDifference(field.samples().size())};
  return {field, no_bias, std::move(draws), std::move(components)};
}

}  // namespace lilytank::test
