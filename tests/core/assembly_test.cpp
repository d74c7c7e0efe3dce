#include "physics/assembly.hpp"

#include <gtest/gtest.h>

#include "lilytank/random.hpp"
#include "support/bodies.hpp"

namespace lilytank::test {
namespace {

double draw(std::uint32_t body, std::uint32_t index) {
  return 2 * uniform({99, Stream::start_pose, 0, body, index}) - 1;
}

// Centre of a face and its outward normal, from the derived poses.
Vec2 normal(const Bodies& b, int i, int face) {
  return rotate(compose({b.assemblies.c[i], b.assemblies.s[i]}, quarter(face)), {1, 0});
}
Vec2 face_centre(const Bodies& b, int i, int face) {
  return Vec2(b.assemblies.x[i], b.assemblies.y[i]) +
         0.5 * b.model.module.side * normal(b, i, face);
}

void expect_joined(const Bodies& b, int i, int fi, int j, int fj) {
  EXPECT_LT((face_centre(b, i, fi) - face_centre(b, j, fj)).norm(), 1e-15);
  EXPECT_LT((normal(b, i, fi) + normal(b, j, fj)).norm(), 1e-14);
}

// Puts module j before face fi of module i, out of place by up to 5 mm and 0.2 rad.
void place_before(Bodies& b, int i, int fi, int j, int fj, std::uint32_t k) {
  b.derive();
  const Vec2 n = normal(b, i, fi);
  const Vec2 at = face_centre(b, i, fi) + 0.5 * b.model.module.side * n +
                  0.0035 * Vec2(draw(k, 10), draw(k, 11));
  const Rot out = compose({n.x(), n.y()}, quarter(2 - fj));  // face fj looks against n
  b.place(j, at.x(), at.y(), angle_of(out) + 0.2 * draw(k, 12));
}

void expect_same(const Assemblies& p, const Assemblies& q) {
  EXPECT_EQ(p.live, q.live);
  EXPECT_EQ(p.mass, q.mass);
  EXPECT_EQ(p.inertia, q.inertia);
  EXPECT_EQ(p.own_inertia, q.own_inertia);
  EXPECT_EQ(p.reach, q.reach);
  EXPECT_EQ(p.centre_x, q.centre_x);
  EXPECT_EQ(p.centre_y, q.centre_y);
  EXPECT_EQ(p.first, q.first);
  EXPECT_EQ(p.next, q.next);
  EXPECT_EQ(p.x, q.x);
  EXPECT_EQ(p.y, q.y);
  EXPECT_EQ(p.c, q.c);
  EXPECT_EQ(p.s, q.s);
  EXPECT_EQ(p.vx, q.vx);
  EXPECT_EQ(p.vy, q.vy);
  EXPECT_EQ(p.omega, q.omega);
  EXPECT_EQ(p.covered, q.covered);
  EXPECT_EQ(p.inner, q.inner);
}

TEST(Assembly, MergePutsFacesTogetherAndKeepsMomentum) {
  for (std::uint32_t k = 0; k < 400; ++k) {
    Bodies b(bare_model(4));
    b.make_chain(0, 3, 0.05 * draw(k, 0), 0.05 * draw(k, 1));
    const int i = static_cast<int>(k % 3), fi = i == 2 ? 0 : 1, fj = static_cast<int>(k / 3 % 4);
    b.place(0, 0.05 * draw(k, 2), 0.05 * draw(k, 3), 3 * draw(k, 4));
    place_before(b, i, fi, 3, fj, k);
    b.set_twist(0, 0.2 * draw(k, 5), 0.2 * draw(k, 6), 3 * draw(k, 7));
    b.set_twist(3, 0.2 * draw(k, 8), 0.2 * draw(k, 9), 3 * draw(k, 13));
    b.derive();
    const Vec2 momentum = b.momentum();
    const double spin = b.spin();
    const Vec2 centre(0.75 * b.state.x[0] + 0.25 * b.state.x[3],
                      0.75 * b.state.y[0] + 0.25 * b.state.y[3]);
    ASSERT_TRUE(b.bond(i, fi, 3, fj));
    expect_joined(b, i, fi, 3, fj);
    expect_joined(b, 0, 0, 1, 2);
    EXPECT_EQ(b.state.assembly[3], 0);
    EXPECT_LT((Vec2(b.state.x[0], b.state.y[0]) - centre).norm(), 1e-16);
    EXPECT_LT((b.momentum() - momentum).norm(), 1e-16);
    EXPECT_NEAR(b.spin(), spin, 1e-17);
    Assemblies afresh;
    afresh.resize(b.model);
    derive(b.model, b.state, afresh);
    expect_same(b.assemblies, afresh);
  }
}

TEST(Assembly, MergeSplitsTheCorrectionByInertia) {
  Bodies b(bare_model(2));
  b.place(0, 0, 0), b.place(1, 0.038, 0.001, 0.1);
  b.derive();
  ASSERT_TRUE(b.bond(0, 0, 1, 2));
  EXPECT_NEAR(angle_of({b.state.c[0], b.state.s[0]}), 0.05, 1e-15);  // equal bodies: half each
}

TEST(Assembly, MergeDoesNotDependOnTheOrderOfItsArguments) {
  for (std::uint32_t k = 0; k < 20; ++k) {
    Bodies p(bare_model(2)), q(bare_model(2));
    for (Bodies* b : {&p, &q}) {
      b->place(0, 0, 0, draw(k, 0));
      place_before(*b, 0, 3, 1, 2, k);
      b->set_twist(1, draw(k, 1), draw(k, 2), draw(k, 3));
      b->derive();
    }
    p.bond(0, 3, 1, 2), q.bond(1, 2, 0, 3);
    EXPECT_EQ(fingerprint(p.state), fingerprint(q.state));
  }
}

TEST(Assembly, MergeRefusesAnOccupiedCell) {
  Bodies b(bare_model(4));
  b.make_chain(0, 3, 0, 0);
  b.place(3, 0.035, 0.035);
  b.derive();
  const std::uint64_t before = fingerprint(b.state);
  EXPECT_FALSE(merge(b.model, b.state, b.assemblies, 3, 1, 0, 0));  // module 1 lies there
  EXPECT_EQ(fingerprint(b.state), before);
}

TEST(Assembly, MergeWithinAnAssemblyOnlyRefreshesIt) {
  Bodies b(bare_model(4));
  b.make_chain(0, 2, 0, 0);
  b.make_chain(2, 2, 0, 0.035);
  b.derive();
  ASSERT_TRUE(b.bond(0, 1, 2, 3));
  EXPECT_EQ(b.assemblies.covered[1], 1u << 2);
  EXPECT_EQ(b.assemblies.inner[1], 1u << 2 | 1u << 1);  // touches 3, not latched to it
  const double x = b.state.x[0];
  ASSERT_TRUE(b.bond(1, 1, 3, 3));
  EXPECT_EQ(b.assemblies.covered[1], 1u << 2 | 1u << 1);
  EXPECT_EQ(b.state.x[0], x);
}

TEST(Assembly, ChainHasTheInertiaOfABar) {
  Bodies b(bare_model(7));
  b.make_chain(0, 7, -0.1, 0.02);
  const double a = b.model.module.side, mass = 7 * b.model.module.mass, length = 7 * a;
  EXPECT_NEAR(b.assemblies.mass[0], mass, 1e-15);
  EXPECT_NEAR(b.assemblies.inertia[0], mass * (length * length + a * a) / 12, 1e-16);
  EXPECT_NEAR(b.assemblies.own_inertia[0], 7 * b.model.module.inertia(), 1e-18);
  EXPECT_NEAR(b.assemblies.reach[0], 0.5 * std::sqrt(length * length + a * a), 1e-15);
}

TEST(Assembly, SplitPartsGoOnAsTheyMoved) {
  Bodies b(bare_model(5));
  b.make_chain(0, 5, -0.05, 0.02);
  b.place(0, 0.03, -0.04, 2.0);
  b.set_twist(0, 0.1, -0.2, 4.0);
  b.derive();
  const Assemblies before = b.assemblies;
  const Vec2 momentum = b.momentum();
  const double spin = b.spin(), energy = b.energy();
  b.release(1, 0, 2, 2);
  EXPECT_EQ(b.assemblies.live, (std::vector<int>{0, 2}));
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(b.state.assembly[i], i < 2 ? 0 : 2);
    EXPECT_NEAR(b.assemblies.x[i], before.x[i], 1e-16);
    EXPECT_NEAR(b.assemblies.y[i], before.y[i], 1e-16);
    EXPECT_NEAR(b.assemblies.c[i], before.c[i], 1e-15);
    EXPECT_NEAR(b.assemblies.s[i], before.s[i], 1e-15);
    EXPECT_NEAR(b.assemblies.vx[i], before.vx[i], 1e-15);
    EXPECT_NEAR(b.assemblies.vy[i], before.vy[i], 1e-15);
    EXPECT_EQ(b.assemblies.omega[i], 4.0);
  }
  EXPECT_EQ(b.state.cell_x[2], 0);
  EXPECT_EQ(b.state.turn[2], 0);
  EXPECT_LT((b.momentum() - momentum).norm(), 1e-16);
  EXPECT_NEAR(b.spin(), spin, 1e-17);
  EXPECT_NEAR(b.energy(), energy, 1e-17);
}

TEST(Assembly, ARingStaysWholeWhenOneBondOpens) {
  Bodies b(bare_model(4));
  b.make_chain(0, 2, 0, 0);
  b.make_chain(2, 2, 0, 0.035);
  b.derive();
  b.bond(0, 1, 2, 3), b.bond(1, 1, 3, 3);
  const std::vector<double> x = b.state.x, y = b.state.y, c = b.state.c;
  b.release(0, 0, 1, 2);
  EXPECT_EQ(b.assemblies.live, (std::vector<int>{0}));
  EXPECT_EQ(b.state.x, x);
  EXPECT_EQ(b.state.y, y);
  EXPECT_EQ(b.state.c, c);
  EXPECT_EQ(b.assemblies.covered[0], 1u << 1);
}

// A long random life of bonds: the lattice never drifts and what is derived step by step is what is
// derived afresh.
TEST(Assembly, ManyMergesAndSplitsStayOnTheLattice) {
  constexpr int n = 8;
  Bodies b(bare_model(n));
  for (int i = 0; i < n; ++i) b.place(i, 0.06 * (i % 3), 0.06 * (i / 3), draw(0, i));
  b.derive();
  for (std::uint32_t k = 1; k < 3000; ++k) {
    const int i = static_cast<int>(uniform({5, Stream::start_pose, 1, k, 0}) * n);
    const int f = static_cast<int>(uniform({5, Stream::start_pose, 1, k, 1}) * 4);
    const Face& face = b.state.faces[4 * i + f];
    const Vec2 momentum = b.momentum();
    const double spin = b.spin();
    if (face.status == FaceStatus::bonded) {
      const int j = face.partner;
      int back = 0;
      while (b.state.faces[4 * j + back].partner != i) ++back;
      b.release(i, f, j, back);
    } else {
      const int j = static_cast<int>(uniform({5, Stream::start_pose, 1, k, 2}) * n);
      const int g = static_cast<int>(uniform({5, Stream::start_pose, 1, k, 3}) * 4);
      if (b.state.assembly[i] == b.state.assembly[j]) continue;
      if (b.state.faces[4 * j + g].status == FaceStatus::bonded) continue;
      if (!merge(b.model, b.state, b.assemblies, i, f, j, g)) continue;
      b.bond(i, f, j, g);
    }
    ASSERT_LT((b.momentum() - momentum).norm(), 1e-15);
    ASSERT_NEAR(b.spin(), spin, 1e-16);
    for (int j = 0; j < n; ++j) {
      for (int g = 0; g < 4; ++g) {
        const Face& other = b.state.faces[4 * j + g];
        if (other.status != FaceStatus::bonded) continue;
        int back = 0;
        while (b.state.faces[4 * other.partner + back].partner != j) ++back;
        expect_joined(b, j, g, other.partner, back);
      }
    }
    Assemblies afresh;
    afresh.resize(b.model);
    derive(b.model, b.state, afresh);
    expect_same(b.assemblies, afresh);
    if (HasFailure()) FAIL() << "at change " << k;
  }
}

}  // namespace
}  // namespace lilytank::test
