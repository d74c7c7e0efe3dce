// Contacts of random pairs of squares against brute force: polygon clipping and the distance of
// polygons, which share nothing with the separating axes of the code.
#include <gtest/gtest.h>

#include <array>

#include "lilytank/random.hpp"
#include "support/reference/collide.hpp"

namespace lilytank::test {
namespace {

using namespace reference;

constexpr double kHalf = 0.0175;

double draw(std::uint32_t k, std::uint32_t index) {
  return 2 * uniform({23, Stream::start_pose, 0, k, index}) - 1;
}

using Polygon = std::vector<Vec2>;

Polygon outline(const Square& s) {
  const Vec2 c(s.x, s.y), u = s.half * Vec2(s.r.c, s.r.s), v(-u.y(), u.x());
  return {c + u + v, c - u + v, c - u - v, c + u - v};
}

double area(const Polygon& p) {
  double sum = 0;
  for (std::size_t k = 0; k < p.size(); ++k) sum += cross(p[k], p[(k + 1) % p.size()]);
  return 0.5 * sum;
}

// What of p lies within q (Sutherland and Hodgman).
Polygon clipped(Polygon p, const Polygon& q) {
  for (std::size_t k = 0; k < q.size(); ++k) {
    const Vec2 a = q[k], edge = q[(k + 1) % q.size()] - a;
    Polygon out;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vec2 from = p[i], to = p[(i + 1) % p.size()];
      const double f = cross(edge, from - a), t = cross(edge, to - a);
      if (f >= 0) out.push_back(from);
      if ((f > 0 && t < 0) || (f < 0 && t > 0)) out.push_back(from + f / (f - t) * (to - from));
    }
    p = out;
  }
  return p;
}

double to_edge(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 edge = b - a;
  const double t = std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
  return (p - a - t * edge).norm();
}

// Of disjoint polygons.
double distance(const Polygon& p, const Polygon& q) {
  double least = 1;
  for (const auto& [one, other] : {std::pair{&p, &q}, std::pair{&q, &p}}) {
    for (const Vec2& corner : *one) {
      for (std::size_t k = 0; k < other->size(); ++k)
        least = std::min(least, to_edge(corner, (*other)[k], (*other)[(k + 1) % other->size()]));
    }
  }
  return least;
}

bool overlap(const Polygon& p, const Polygon& q) {
  return area(clipped(p, q)) > 1e-15;
}

Polygon shifted(Polygon p, const Vec2& by) {
  for (Vec2& corner : p) corner += by;
  return p;
}

// Least shift that parts overlapping polygons, over directions sampled more and more finely.
double sampled_depth(const Polygon& p, const Polygon& q) {
  const auto depth_along = [&](double angle) {
    const Vec2 n(std::cos(angle), std::sin(angle));
    double high = -1, low = 1;
    for (const Vec2& c : p) high = std::max(high, c.dot(n));
    for (const Vec2& c : q) low = std::min(low, c.dot(n));
    return high - low;
  };
  double best = 1, at = 0;
  for (int k = 0; k < 2000; ++k) {
    const double angle = 2 * kPi * k / 2000, depth = depth_along(angle);
    if (depth < best) best = depth, at = angle;
  }
  for (double step = 2 * kPi / 2000; step > 1e-9; step *= 0.5) {
    for (const double angle : {at - step, at + step}) {
      const double depth = depth_along(angle);
      if (depth < best) best = depth, at = angle;
    }
  }
  return best;
}

struct Pair {
  Square a, b;
  Polygon p, q;
  explicit Pair(std::uint32_t k) {
    a = {0.01 * draw(k, 0), 0.01 * draw(k, 1), rotation(kPi * draw(k, 2)), kHalf, 0};
    const double angle = kPi * draw(k, 3), way = 0.043 + 0.008 * draw(k, 4);
    // A third of the pairs are nearly aligned: faces that meet are what matters most.
    const double tilt = k % 3 == 0 ? 1e-3 * draw(k, 5) + (k % 4) * kPi / 2 : kPi * draw(k, 5);
    b = {a.x + way * std::cos(angle), a.y + way * std::sin(angle), compose(a.r, rotation(tilt)),
         kHalf, 0};
    p = outline(a), q = outline(b);
  }
};

double least_gap(const Manifold& m) {
  return m.count == 1 ? m.touch[0].gap : std::min(m.touch[0].gap, m.touch[1].gap);
}

TEST(ContactPairs, SeparationAgreesWithClippingAndSampledDepth) {
  int overlapping = 0;
  for (std::uint32_t k = 0; k < 20000; ++k) {
    const Pair pair(k);
    const Gap gap = separation(pair.a, pair.b);
    // Moved by the gap along its normal, they just do not overlap.
    const Vec2 closer = (1e-9 - gap.size) * Vec2(gap.nx, gap.ny);
    EXPECT_FALSE(overlap(pair.p, shifted(pair.q, closer))) << k;
    if (overlap(pair.p, pair.q)) {
      ++overlapping;
      EXPECT_LT(gap.size, 0) << k;
      if (k % 10 != 0) continue;
      EXPECT_NEAR(-gap.size, sampled_depth(pair.p, pair.q), 1e-9) << k;
    } else {
      EXPECT_LE(gap.size, distance(pair.p, pair.q) + 1e-15) << k;
      EXPECT_GT(gap.size, -1e-7) << k;
    }
  }
  EXPECT_GT(overlapping, 2000);
}

TEST(ContactPairs, ApartTheNearestPointIsFound) {
  constexpr double margin = 2e-3;
  int near = 0;
  for (std::uint32_t k = 0; k < 60000; ++k) {
    const Pair pair(k);
    if (overlap(pair.p, pair.q)) continue;
    const double apart = distance(pair.p, pair.q);
    const Manifold m = collide(pair.a, pair.b, margin);
    if (apart > margin) {
      EXPECT_EQ(m.count, 0) << k;
      continue;
    }
    if (apart < 2e-5) continue;  // corners that nearly touch count as faces
    ++near;
    ASSERT_GT(m.count, 0) << k;
    EXPECT_NEAR(least_gap(m), apart, 1e-9) << k;
    const Vec2 n(m.nx, m.ny);
    EXPECT_NEAR(n.norm(), 1, 1e-12);
    // Shifted by the distance along the normal they touch; so it is the direction of the distance.
    EXPECT_LT(distance(pair.p, shifted(pair.q, -0.999 * apart * n)), 0.002 * apart + 1e-9) << k;
    EXPECT_FALSE(overlap(pair.p, shifted(pair.q, -0.999 * apart * n))) << k;
  }
  EXPECT_GT(near, 4000);
}

TEST(ContactPairs, OverlappingTheContactPartsThem) {
  int deep = 0;
  for (std::uint32_t k = 0; k < 60000; ++k) {
    const Pair pair(k);
    if (!overlap(pair.p, pair.q)) continue;
    const double depth = -separation(pair.a, pair.b).size;
    const Manifold m = collide(pair.a, pair.b, 0);
    ++deep;
    ASSERT_GT(m.count, 0) << k;
    const double gap = least_gap(m);
    EXPECT_NEAR(-gap, depth, 2e-7) << k;  // sides within 0.1 um of the best are as good
    EXPECT_FALSE(overlap(pair.p, shifted(pair.q, (1e-9 - gap) * Vec2(m.nx, m.ny)))) << k;
    for (int j = 0; j < m.count; ++j) {
      const Touch& t = m.touch[j];
      EXPECT_LE(t.gap, 0) << k;
      for (const Square* s : {&pair.a, &pair.b}) {
        const Vec2 local = unrotate(s->r, Vec2(t.x - s->x, t.y - s->y));
        const double out = std::max(std::fabs(local.x()), std::fabs(local.y())) - kHalf;
        EXPECT_LE(out, 1e-7) << k;  // in both squares, within half the depth of their outlines
      }
    }
  }
  EXPECT_GT(deep, 5000);
}

TEST(ContactPairs, ExchangingTheSquaresTurnsTheNormal) {
  for (std::uint32_t k = 0; k < 20000; ++k) {
    const Pair pair(k);
    const Manifold m = collide(pair.a, pair.b, 1e-3), back = collide(pair.b, pair.a, 1e-3);
    ASSERT_EQ(m.count > 0, back.count > 0) << k;
    if (m.count == 0) continue;
    EXPECT_NEAR(least_gap(m), least_gap(back), 2e-7) << k;
  }
}

TEST(ContactPairs, WallGapIsThatOfTheOutermostCorner) {
  for (std::uint32_t k = 0; k < 20000; ++k) {
    const double r = 0.29 * std::sqrt(std::fabs(draw(k, 0))), at = kPi * draw(k, 1);
    const Square s{r * std::cos(at), r * std::sin(at), rotation(kPi * draw(k, 2)), kHalf, 0};
    double farthest = 0;
    for (const Vec2& corner : outline(s)) farthest = std::max(farthest, corner.norm());
    EXPECT_NEAR(wall_separation(s, 0.3), 0.3 - farthest, 1e-15);
    const WallManifold m = collide_wall(s, 0.3, 0.02);
    EXPECT_EQ(m.count > 0, 0.3 - farthest < 0.02);
  }
}

}  // namespace
}  // namespace lilytank::test
