// Collisions and sliding against closed forms.
#include <gtest/gtest.h>

#include <array>

#include "lilytank/random.hpp"
#include "support/bodies.hpp"

namespace lilytank::test {
namespace {

constexpr double kSide = 0.035;

double draw(std::uint32_t k, std::uint32_t index) {
  return 2 * uniform({17, Stream::start_pose, 0, k, index}) - 1;
}

Model with_contact(Model model, double friction, double restitution) {
  model.contact.friction = friction;
  model.contact.restitution = restitution;
  return model;
}

TEST(HeadOn, SquaresExchangeMomentumByNewtonsRestitution) {
  for (const double e : {0.0, 0.2, 0.7, 1.0}) {
    Bodies b(with_contact(bare_model(2), 0.2, e));
    b.place(0, -0.02, 0), b.place(1, 0.02, 0);
    b.set_twist(0, 0.25, 0.02), b.set_twist(1, -0.15, 0.02);
    b.derive();
    b.step(2);
    EXPECT_NEAR(b.state.vx[0], 0.05 - 0.2 * e, 1e-7) << e;
    EXPECT_NEAR(b.state.vx[1], 0.05 + 0.2 * e, 1e-7) << e;
    EXPECT_NEAR(b.state.vy[0], 0.02, 1e-8);
    EXPECT_NEAR(b.state.omega[0], 0, 1e-5);
  }
}

TEST(HeadOn, DiscsAndSquareWithDisc) {
  for (const bool square : {false, true}) {
    Bodies b(bare_model(square ? 1 : 0, 0.3, square ? 1 : 2));
    const double ma = square ? b.model.module.mass : b.model.ball.mass, mb = b.model.ball.mass;
    b.place(0, -0.018, 0), b.place(1, 0.018, 0);
    b.set_twist(0, 0.2, 0), b.set_twist(1, -0.1, 0);
    b.derive();
    b.step(2);
    const double common = (ma * 0.2 - mb * 0.1) / (ma + mb);
    EXPECT_NEAR(b.state.vx[1] - b.state.vx[0], 0.2 * 0.3, 1e-7);
    EXPECT_NEAR(b.momentum().x() / (ma + mb), common, 1e-8);
  }
}

TEST(HeadOn, SlowMeetingsDoNotBounce) {
  Bodies b(bare_model(2));
  b.place(0, -0.0176, 0), b.place(1, 0.0176, 0);
  b.set_twist(0, 0.0045, 0), b.set_twist(1, -0.0045, 0);
  b.derive();
  b.step(2);
  EXPECT_NEAR(b.state.vx[0], 0, 1e-9);
  EXPECT_NEAR(b.state.x[1] - b.state.x[0], kSide, 1e-7);
}

TEST(HeadOn, ACornerBouncesOffTheWall) {
  Bodies b(bare_model(1));
  const double reach = kSide * std::sqrt(0.5);
  b.place(0, 0.298 - reach, 0, kPi / 4);
  b.set_twist(0, 0.2, 0);
  b.derive();
  b.step();
  EXPECT_NEAR(b.state.vx[0], -0.04, 1e-7);
  EXPECT_NEAR(b.state.omega[0], 0, 1e-5);
}

// Discs do not turn, so friction stops the tangential velocity if its bound mu (1 + e) vn allows.
TEST(Oblique, DiscsStickOrSlide) {
  const double mu = 0.2, e = 0.2, vn = 0.2;
  for (const double vt : {0.01, 0.04, 0.0479, 0.0481, 0.1, 0.3}) {
    Model model = bare_model(0, 0.3, 2, 50);
    Bodies b(model);
    b.place(0, -0.01501, 0), b.place(1, 0.01501, 0);
    b.set_twist(0, vn, vt);
    b.derive();
    b.step(1);
    const double slip = std::max(0.0, vt - 2 * mu * (1 + e) * vn * 0.5);
    EXPECT_NEAR(b.state.vx[1] - b.state.vx[0], e * vn, 2e-4 * vn) << vt;
    EXPECT_NEAR(b.state.vy[0] - b.state.vy[1], slip, 3e-4 * vt) << vt;
  }
}

// Impulse theory for one contact: the normal velocity is turned round by e, and friction either
// ends the slip or is mu times the normal impulse against it.
struct Impact {
  double mass, inertia, mu, e;
  Twist a, b;  // before; after solve(), after
  // Contact at arms ra, rb from the centres, normal along y from a to b.
  void solve(const Vec2& ra, const Vec2& rb) {
    const Vec2 v(b.vx - b.omega * rb.y() - a.vx + a.omega * ra.y(),
                 b.vy + b.omega * rb.x() - a.vy - a.omega * ra.x());
    const double nn = 2 / mass + (ra.x() * ra.x() + rb.x() * rb.x()) / inertia;
    const double tt = 2 / mass + (ra.y() * ra.y() + rb.y() * rb.y()) / inertia;
    const double nt = -(ra.x() * ra.y() + rb.x() * rb.y()) / inertia;
    const double need_n = -(1 + e) * v.y(), need_t = -v.x();
    const double det = nn * tt - nt * nt;
    double jn = (tt * need_n - nt * need_t) / det, jt = (nn * need_t - nt * need_n) / det;
    if (std::fabs(jt) > mu * jn) {
      const double s = jt > 0 ? mu : -mu;
      jn = need_n / (nn + s * nt), jt = s * jn;
    }
    const Vec2 j(jt, jn);
    a.vx -= j.x() / mass, a.vy -= j.y() / mass, a.omega -= cross(ra, j) / inertia;
    b.vx += j.x() / mass, b.vy += j.y() / mass, b.omega += cross(rb, j) / inertia;
  }
};

TEST(Oblique, ACornerHitsAFaceByImpulseTheory) {
  int sliding = 0, sticking = 0;
  for (std::uint32_t k = 0; k < 300; ++k) {
    Bodies b(with_contact(bare_model(2, 0.3, 0, 1000), 0.1 + 0.3 * std::fabs(draw(k, 7)), 0.3));
    const double reach = kSide * std::sqrt(0.5), tilt = 0.3 * draw(k, 0),
                 along = 0.014 * draw(k, 1);
    // The lowest corner of module 1, tilt off the vertical below its centre, is over module 0's
    // top.
    const Vec2 corner(reach * std::sin(tilt), -reach * std::cos(tilt));
    const double gap = 1e-7;
    b.place(0, 0, 0), b.place(1, along - corner.x(), kSide / 2 + gap - corner.y(), kPi / 4 + tilt);
    b.set_twist(0, 0, 0.1, 0.5 * draw(k, 2));
    b.set_twist(1, 0.4 * draw(k, 3), -0.1 - 0.1 * std::fabs(draw(k, 4)), 3 * draw(k, 5));
    Impact theory{b.model.module.mass,
                  b.model.module.inertia(),
                  b.model.contact.friction,
                  0.3,
                  {b.state.vx[0], b.state.vy[0], b.state.omega[0]},
                  {b.state.vx[1], b.state.vy[1], b.state.omega[1]}};
    const Vec2 at(along, kSide / 2);
    const Vec2 slip_before(
        theory.b.vx - theory.b.omega * corner.y() - theory.a.vx + theory.a.omega * at.y(),
        theory.b.vy + theory.b.omega * corner.x() - theory.a.vy - theory.a.omega * at.x());
    if (slip_before.y() > -0.05) continue;
    theory.solve(at, corner);
    b.derive();
    b.step(1);
    const double scale = 2e-3;  // the arms turn a little within the step
    EXPECT_NEAR(b.state.vx[0], theory.a.vx, scale * 0.4) << k;
    EXPECT_NEAR(b.state.vy[0], theory.a.vy, scale * 0.4) << k;
    EXPECT_NEAR(b.state.omega[0], theory.a.omega, scale * 20) << k;
    EXPECT_NEAR(b.state.vx[1], theory.b.vx, scale * 0.4) << k;
    EXPECT_NEAR(b.state.vy[1], theory.b.vy, scale * 0.4) << k;
    EXPECT_NEAR(b.state.omega[1], theory.b.omega, scale * 20) << k;
    const double slip =
        theory.b.vx - theory.b.omega * corner.y() - theory.a.vx + theory.a.omega * at.y();
    ++(std::fabs(slip) < 1e-9 ? sticking : sliding);
  }
  EXPECT_GT(sliding, 30);
  EXPECT_GT(sticking, 30);
}

// A module pressed against the long side of a chain slides with friction mu over all its seams.
TEST(Sliding, AlongAChainTheRatioOfImpulsesIsMu) {
  constexpr int n = 10;
  Bodies b(bare_model(n + 1));
  b.make_chain(0, n, -0.16, 0);
  const double press = 0.3, dt = b.model.dt;
  b.place(n, -0.13, kSide);
  b.set_twist(n, 0.3, 0);
  int sliding = 0;
  while (b.state.x[n] < 0.12 && b.state.vx[n] > 0.02) {
    b.set_twist(0, 0, 0, 0);  // the chain gives way, but gathers no speed
    const Rot along{b.state.c[0], b.state.s[0]};
    b.state.vx[n] += press * dt * along.s, b.state.vy[n] -= press * dt * along.c;
    b.derive();
    const Vec2 before(b.state.vx[n], b.state.vy[n]);
    b.step();
    const Vec2 gained = unrotate(along, Vec2(b.state.vx[n], b.state.vy[n]) - before);
    ASSERT_GT(gained.y(), 0.5 * press * dt);
    ASSERT_NEAR(gained.x(), -0.2 * gained.y(), 2e-3 * gained.y()) << b.state.x[n];
    ASSERT_NEAR(b.state.omega[n], 0, 0.02);
    ++sliding;
  }
  EXPECT_GT(sliding, 30);
  EXPECT_LT(b.overlap(), 1e-4);
}

// N = m v^2 / (R - r), friction mu N: the speed falls as exp(-mu angle).
TEST(Sliding, ADiscOnTheWallSlowsWithTheAngle) {
  Bodies b(bare_model(0, 0.3, 1, 10));
  b.place(0, 0.285, 0);
  b.set_twist(0, 0, 0.3);
  b.derive();
  double turned = 0;
  Rot last;
  while (turned < 3) {
    b.step();
    const double r = std::sqrt(b.state.x[0] * b.state.x[0] + b.state.y[0] * b.state.y[0]);
    const Rot now{b.state.x[0] / r, b.state.y[0] / r};
    turned += angle_of(between(last, now));
    last = now;
    ASSERT_GT(r, 0.2849);
  }
  const double speed = std::sqrt(b.momentum().squaredNorm()) / b.model.ball.mass;
  EXPECT_NEAR(speed, 0.3 * std::exp(-0.2 * turned), 0.01 * speed);
}

// A square that leans on the wall with two corners goes round as a rigid body: its angular momentum
// about the tank's centre falls by mu R N, with N from the centripetal force.
TEST(Sliding, ASquareOnTheWallSlowsWithTheAngle) {
  Bodies b(bare_model(1, 0.3, 0, 10));
  const double tank = 0.3, half = kSide / 2, mass = b.model.module.mass;
  const double centre = std::sqrt(tank * tank - half * half) - half;
  b.place(0, centre, 0);
  b.set_twist(0, 0, 0.3, 0.3 / centre);
  b.derive();
  double turned = 0;
  while (turned < 2) {
    const Rot before{b.state.c[0], b.state.s[0]};
    b.step();
    turned += angle_of(between(before, {b.state.c[0], b.state.s[0]}));
  }
  const double about_tank = mass * centre * centre + b.model.module.inertia();
  const double cosine = std::sqrt(1 - half * half / (tank * tank));
  const double rate = 0.2 * mass * centre * tank / (about_tank * cosine);
  const double expected = 0.3 / centre * std::exp(-rate * turned);
  EXPECT_NEAR(b.state.omega[0], expected, 0.02 * expected);
  EXPECT_LT(b.overlap(), 1e-4);
}

// Random meetings of two or three bodies: momentum and angular momentum stay, energy never grows.
TEST(Conservation, MomentaStayAndEnergyFalls) {
  int hits = 0;
  for (std::uint32_t k = 0; k < 500; ++k) {
    Bodies b(
        with_contact(bare_model(5, 1.0), 0.4 * std::fabs(draw(k, 90)), std::fabs(draw(k, 91))));
    b.make_chain(0, 3, 0, 0);
    b.place(0, 0, 0, 3 * draw(k, 0));
    b.place(3, 0.09, 0.02 * draw(k, 1), 3 * draw(k, 2));
    b.place(4, -0.09, 0.02 * draw(k, 3), 3 * draw(k, 4));
    b.set_twist(0, 0.1 * draw(k, 5), 0.1 * draw(k, 6), 2 * draw(k, 7));
    b.set_twist(3, -0.3, 0.1 * draw(k, 8), 5 * draw(k, 9));
    b.set_twist(4, 0.3, 0.1 * draw(k, 10), 5 * draw(k, 11));
    b.derive();
    const Vec2 momentum = b.momentum();
    const double spin = b.spin(), start = b.energy();
    for (int step = 0; step < 20; ++step) {
      const double energy = b.energy();
      b.step();
      ASSERT_LE(b.energy(), energy * (1 + 5e-6)) << k;
      ASSERT_LT((b.momentum() - momentum).norm(), 5e-8);
      ASSERT_LT(b.overlap(), 1e-4);
    }
    hits += b.energy() < 0.999 * start;
    EXPECT_NEAR(b.spin(), spin, 1e-8) << k;
  }
  EXPECT_GT(hits, 300);
}

}  // namespace
}  // namespace lilytank::test
