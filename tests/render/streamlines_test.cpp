#include "view/streamlines.hpp"

#include <gtest/gtest.h>

#include "render/sample_run.hpp"

namespace lilytank {
namespace {

TEST(Streamlines, FollowTheFlowInsideTheTank) {
  const auto field = sample::swirl(0.3);
  const auto lines = streamlines(*field, {});
  ASSERT_GT(lines.size(), 20u);
  for (const Streamline& line : lines) {
    ASSERT_EQ(line.points.size(), line.speed.size());
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      const Vec2 piece = line.points[i] - line.points[i - 1];
      const Vec2 middle = line.points[i] - 0.5 * piece;
      const FlowSample f = field->at(middle.x(), middle.y());
      ASSERT_LT(middle.norm(), 0.3);
      if (middle.norm() < 0.02) continue;  // as curved as a piece is long
      // Within 2 degrees of the flow in the piece's middle.
      ASSERT_GT(piece.normalized().dot(Vec2(f.mu_x, f.mu_y).normalized()), 0.999);
    }
  }
}

TEST(Streamlines, LinesKeepTheirDistance) {
  StreamlineSettings settings;
  const auto lines = streamlines(*sample::swirl(0.3), settings);
  for (std::size_t a = 0; a < lines.size(); ++a) {
    for (std::size_t b = a + 1; b < lines.size(); ++b) {
      for (const Vec2& p : lines[a].points) {
        for (const Vec2& q : lines[b].points) {
          ASSERT_GT((p - q).norm(), 0.5 * settings.separation);
        }
      }
    }
  }
}

TEST(Streamlines, CoverTheTank) {
  StreamlineSettings settings;
  const auto lines = streamlines(*sample::swirl(0.3), settings);
  int bare = 0, probes = 0;
  for (double y = -0.25; y <= 0.25; y += 0.02) {
    for (double x = -0.25; x <= 0.25; x += 0.02) {
      if (std::hypot(x, y) > 0.26 || std::hypot(x, y) < 0.02) continue;
      double nearest = 1;
      for (const Streamline& line : lines) {
        for (const Vec2& p : line.points) nearest = std::min(nearest, (p - Vec2(x, y)).norm());
      }
      ++probes;
      bare += nearest > 2 * settings.separation;
    }
  }
  EXPECT_EQ(bare, 0) << "of " << probes;
}

TEST(Streamlines, StillWaterHasNone) {
  const FlowField still(4, 0.3, std::vector<FlowSample>(16), std::vector<bool>(16, true),
                        Interpolation::bilinear);
  EXPECT_TRUE(streamlines(still, {}).empty());
  EXPECT_TRUE(streamlines(FlowField(), {}).empty());
}

TEST(Streamlines, ACircleIsDrawnOnce) {
  // Rigid rotation: every streamline closes.
  std::vector<FlowSample> samples;
  for (int iy = 0; iy < 30; ++iy) {
    for (int ix = 0; ix < 30; ++ix) samples.push_back({-(iy - 14.5), ix - 14.5, 0, 0});
  }
  const FlowField field(30, 0.3, samples, std::vector<bool>(900, true), Interpolation::bilinear);
  for (const Streamline& line : streamlines(field, {})) {
    if (line.points[0].norm() < 0.02) continue;  // shorter than the length that may overlap
    const double length = 0.002 * static_cast<double>(line.points.size());
    EXPECT_LT(length, 2 * kPi * line.points[0].norm() + 0.01);
  }
}

}  // namespace
}  // namespace lilytank
