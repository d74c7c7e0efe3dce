// Lilies and balls that another engine moves: the same physics, and recordings of its own.
#include "proof/foreign_tank.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "proof/sealed.hpp"

namespace lilytank {
namespace {

struct Pace {
  double move = 0, turn = 0;  ///< mean squares over half a second, m^2 and rad^2
  double farthest = 0;        ///< m from the centre
};

Pace pace_of(const std::vector<Recording>& recordings) {
  constexpr int kLag = 15;
  Pace out;
  double count = 0;
  for (const Recording& r : recordings) {
    for (const Track& t : r.tracks) {
      for (std::size_t i = kLag; i < t.x.size(); ++i) {
        const double dx = t.x[i] - t.x[i - kLag], dy = t.y[i] - t.y[i - kLag];
        if (std::isnan(dx)) continue;
        out.move += dx * dx + dy * dy, count += 1;
        if (r.has_heading()) out.turn += std::pow(t.theta[i] - t.theta[i - kLag], 2);
        out.farthest = std::fmax(out.farthest, std::hypot(t.x[i], t.y[i]));
      }
    }
  }
  out.move /= count, out.turn /= count;
  return out;
}

std::vector<Recording> filmed(BodyKind body, bool foreign) {
  const std::vector<RecordingShape> shapes(2, shape_named("two", body, 15, 60));
  return film_tank(with_steps(tank_model(), kSealedSteps), {}, {}, shapes, 3, foreign).value();
}

TEST(ForeignTank, BodiesMoveAndTurnAsFast) {
#ifndef LILYTANK_HAS_BOX2D
  GTEST_SKIP() << "built without Box2D";
#endif
  for (const BodyKind body : {BodyKind::lily, BodyKind::ball}) {
    const Pace own = pace_of(filmed(body, false)), foreign = pace_of(filmed(body, true));
    // 30 bodies of 60 s, which forget their velocity in half a second: 2 % of a mean square; other
    // contacts and another flow interpolation add as much.
    EXPECT_NEAR(foreign.move / own.move, 1, 0.08);
    if (body == BodyKind::lily) {
      EXPECT_NEAR(foreign.turn / own.turn, 1, 0.08);
    }
    EXPECT_LT(foreign.farthest, tank_model().tank.radius - 0.014);
    EXPECT_NE(foreign.move, own.move);
  }
}

TEST(ForeignTank, ItsCameraHasPixels) {
#ifndef LILYTANK_HAS_BOX2D
  GTEST_SKIP() << "built without Box2D";
#endif
  const std::vector<RecordingShape> shapes(1, shape_named("one", BodyKind::lily, 5, 2));
  const auto film = [&] { return film_tank(tank_model(), {}, {}, shapes, 3, true).value()[0]; };
  const Recording once = film(), again = film();
  for (std::size_t t = 0; t < once.tracks.size(); ++t) {
    for (std::size_t i = 0; i < once.tracks[t].x.size(); ++i) {
      const double pixels = once.tracks[t].x[i] / 5e-4;
      if (std::isnan(pixels)) continue;
      EXPECT_NEAR(pixels, std::round(pixels), 1e-6);
      EXPECT_EQ(once.tracks[t].x[i], again.tracks[t].x[i]);
    }
  }
}

}  // namespace
}  // namespace lilytank
