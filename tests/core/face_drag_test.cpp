#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "forces/force_sum.hpp"
#include "math/bulk_random.hpp"
#include "support/face_drag_reference.hpp"
#include "support/moving_bodies.hpp"
#include "support/worlds.hpp"

namespace lilytank {
namespace {

using test::face_drag_reference;
using test::force;
using test::MovingBodies;
using test::wrenches;

constexpr double kScale = 0.5 * 0.442 * 1000 * 0.035 * 0.035;  // N per (m/s)^2

Vec2 no_gust(int, int) {
  return Vec2::Zero();
}

void expect_near(const Wrench& a, const Wrench& b, double tolerance) {
  EXPECT_NEAR(a.fx, b.fx, tolerance * kScale);
  EXPECT_NEAR(a.fy, b.fy, tolerance * kScale);
  EXPECT_NEAR(a.torque, b.torque, tolerance * kScale * 0.025);
}

// float32 against float64: 40 terms, each with a relative error of a few 2^-24 and a flow lookup
// with 2e-6 of a cell.
TEST(FaceDrag, WithoutGustsEveryKernelMatchesTheReference) {
  for (const FlowAt at : {FlowAt::points, FlowAt::centre}) {
    for (const Gusts gusts : {Gusts::per_point, Gusts::per_module, Gusts::moment_matched}) {
      for (const int segments : {1, 2, 4, 10, 24}) {
        Model model = standard_model();
        model.flow.gusts = gusts, model.flow.at = at;
        for (std::uint64_t seed = 1; seed <= 8; ++seed) {
          const MovingBodies bodies(37, 0, seed);
          const auto fast = wrenches(model, bodies, force("face_drag", {0.442, double(segments)}),
                                     {.gusts = false});
          for (int i = 0; i < 37; ++i)
            expect_near(fast[i],
                        face_drag_reference(model, bodies.view(), 0.442, segments, i, no_gust),
                        5e-6);
        }
      }
    }
  }
}

TEST(FaceDrag, OneGustAModuleMatchesTheReference) {
  for (const FlowAt at : {FlowAt::points, FlowAt::centre}) {
    Model model = standard_model();
    model.flow.gusts = Gusts::per_module, model.flow.at = at;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const MovingBodies bodies(30, 0, seed);
      const auto fast = wrenches(model, bodies, force("face_drag", {0.442, 10}),
                                 {.step = 9, .gust = 9, .seed = seed});
      alignas(64) float z[2 * kBulkBodies];
      for (int i = 0; i < 30; ++i) {
        bulk_normals({seed, Stream::gust, 9, static_cast<std::uint32_t>(i / 16 * 16), 0}, 2, z);
        const Vec2 xi(z[i % 16], z[16 + i % 16]);
        expect_near(
            fast[i],
            face_drag_reference(model, bodies.view(), 0.442, 10, i, [&](int, int) { return xi; }),
            1e-5);
      }
    }
  }
}

// Samples of one module's wrench (N, N, N m).
using Sample = std::array<double, 3>;

std::vector<Sample> drawn(const Model& model, const MovingBodies& bodies, int count) {
  std::vector<Sample> all;
  for (int k = 0; k < count; ++k) {
    const Wrench w = wrenches(model, bodies, force("face_drag", {0.442, 10}),
                              {.step = k, .gust = k, .seed = 77})[0];
    all.push_back({w.fx, w.fy, w.torque});
  }
  return all;
}

std::vector<Sample> drawn_by_reference(const Model& model, const MovingBodies& bodies, int count) {
  std::vector<Sample> all;
  for (int k = 0; k < count; ++k) {
    const Wrench w = face_drag_reference(model, bodies.view(), 0.442, 10, 0, [&](int face, int q) {
      const auto z = normal_pair(
          {78, Stream::gust, k, static_cast<std::uint32_t>(face), static_cast<std::uint32_t>(q)});
      return Vec2(z[0], z[1]);
    });
    all.push_back({w.fx, w.fy, w.torque});
  }
  return all;
}

struct MeanAndError {
  double mean = 0, error = 0;
};

template <class Value>
MeanAndError mean_of(const std::vector<Sample>& samples, Value&& value) {
  double sum = 0, square = 0;
  for (const Sample& s : samples) sum += value(s), square += value(s) * value(s);
  const double n = static_cast<double>(samples.size()), mean = sum / n;
  return {mean, std::sqrt((square / n - mean * mean) / n)};
}

// Means, covariances and, if asked, third moments of two samples agree within 5 standard errors of
// their difference, and `bias` of their size for an approximation.
void expect_same_moments(const std::vector<Sample>& a, const std::vector<Sample>& b, bool third,
                         double bias) {
  Sample centre{}, width{};
  for (int p = 0; p < 3; ++p) {
    const auto value = [&](const Sample& s) { return s[p]; };
    const MeanAndError x = mean_of(a, value), y = mean_of(b, value);
    centre[p] = y.mean, width[p] = y.error * std::sqrt(static_cast<double>(b.size()));
    EXPECT_NEAR(x.mean, y.mean, 5 * std::hypot(x.error, y.error) + bias * width[p]);
  }
  const auto scaled = [&](const Sample& s, int p) { return (s[p] - centre[p]) / width[p]; };
  for (int p = 0; p < 3; ++p) {
    for (int q = p; q < 3; ++q) {
      const auto value = [&](const Sample& s) { return scaled(s, p) * scaled(s, q); };
      const MeanAndError x = mean_of(a, value), y = mean_of(b, value);
      EXPECT_NEAR(x.mean, y.mean, 5 * std::hypot(x.error, y.error) + bias) << p << q;
      for (int r = q; third && r < 3; ++r) {
        const auto cube = [&](const Sample& s) { return value(s) * scaled(s, r); };
        const MeanAndError u = mean_of(a, cube), v = mean_of(b, cube);
        EXPECT_NEAR(u.mean, v.mean, 5 * std::hypot(u.error, v.error)) << p << q << r;
      }
    }
  }
}

// Builds without optimisation are too slow for as many; tolerances follow from the number.
#ifdef NDEBUG
constexpr int kDraws = 20000;
#else
constexpr int kDraws = 4000;
#endif

// One module under way in gusts that differ by axis, some faces covered.
void compare_with_reference(Gusts gusts, FlowAt at, bool third, double bias) {
  Model model = standard_model();
  model.flow.gusts = gusts, model.flow.at = at;
  std::vector<FlowSample> samples = model.field->samples();
  for (FlowSample& f : samples) f.sigma_x *= 1.5, f.sigma_y *= 0.7;
  model.field =
      std::make_shared<const FlowField>(model.field->cells(), model.field->extent(), samples,
                                        model.field->measured(), Interpolation::bilinear);
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    MovingBodies bodies(1, 0, seed);
    bodies.covered[0] = seed % 3 == 0 ? 5 : 0;
    expect_same_moments(drawn(model, bodies, kDraws), drawn_by_reference(model, bodies, kDraws),
                        third, bias);
  }
}

TEST(FaceDrag, GustsOfDragPointsHaveTheReferencesDistribution) {
  compare_with_reference(Gusts::per_point, FlowAt::points, true, 0);
  compare_with_reference(Gusts::per_point, FlowAt::centre, true, 0);
}

// Three nodes a face miss the bends of the bilinear field: a hundredth of the wrench's deviation.
TEST(FaceDrag, MomentMatchedGustsHaveItsMeanAndCovariance) {
  compare_with_reference(Gusts::moment_matched, FlowAt::centre, false, 0.002);
  compare_with_reference(Gusts::moment_matched, FlowAt::points, false, 0.02);
}

// Mean of Eq. 5 over one segment's gust in double precision: with a = -n.w ~ N(m, s^2) where it is
// positive, the force along n is -a^2, and that along t is a (w_t + b (m - a)).
Wrench expected_drag(const Model& model, const MovingBodies& bodies, int i, int segments) {
  const double side = model.module.side, K_v = model.flow.K_v;
  const FlowSample f = model.field->at(bodies.x[i], bodies.y[i]);
  Wrench sum;
  for (int face = 0; face < 4; ++face) {
    if (bodies.covered[i] >> face & 1) continue;
    const Rot out = compose({bodies.c[i], bodies.s[i]}, quarter(face));
    const Vec2 n(out.c, out.s), t(-out.s, out.c);
    const double xx = K_v * K_v * f.sigma_x * f.sigma_x, yy = K_v * K_v * f.sigma_y * f.sigma_y;
    const double s = std::sqrt(n.x() * n.x() * xx + n.y() * n.y() * yy);
    const double b = (n.x() * t.x() * xx + n.y() * t.y() * yy) / (s * s);
    for (int q = 0; q < segments; ++q) {
      const Vec2 r = rotate(out, Vec2(side / 2, ((q + 0.5) / segments - 0.5) * side));
      const Vec2 w = K_v * Vec2(f.mu_x, f.mu_y) - Vec2(bodies.vx[i], bodies.vy[i]) -
                     bodies.omega[i] * Vec2(-r.y(), r.x());
      const double m = -n.dot(w), z = m / s;
      const double density = std::exp(-z * z / 2) / std::sqrt(2 * kPi);
      const double below = std::erfc(-z / std::sqrt(2)) / 2;
      const double first = m * below + s * density, second = m * first + s * s * below;
      const Vec2 force = -second * n + ((t.dot(w) + b * m) * first - b * second) * t;
      sum.fx += force.x(), sum.fy += force.y(), sum.torque += cross(r, force);
    }
  }
  return sum;
}

TEST(FaceDrag, ExpectedDragIsTheMeanOverGusts) {
  const int segments = 10;
  Model model = standard_model();
  model.flow.at = FlowAt::centre;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const MovingBodies bodies(30, 0, seed);
    const auto fast = wrenches(model, bodies, force("face_drag", {0.442, double(segments)}),
                               {.gusts = false, .expected = true});
    for (int i = 0; i < 30; ++i) {
      Wrench want = expected_drag(model, bodies, i, segments);
      const double scale = kScale / segments;
      want.fx *= scale, want.fy *= scale, want.torque *= scale;
      expect_near(fast[i], want, 3e-6);
    }
  }
}

TEST(FaceDrag, NearestLookupMatchesTheReferenceToo) {
  Model model = standard_model();
  model.field = std::make_shared<const FlowField>(analytic_tank({}, Interpolation::nearest));
  const MovingBodies bodies(30, 0, 4);
  const auto fast = wrenches(model, bodies, force("face_drag", {0.442, 10}), {.gusts = false});
  int differ = 0;
  for (int i = 0; i < 30; ++i) {
    const Wrench want = face_drag_reference(model, bodies.view(), 0.442, 10, i, no_gust);
    // A point within rounding of a cell's border may fall into the other cell.
    differ += std::fabs(fast[i].fx - want.fx) > 5e-6 || std::fabs(fast[i].fy - want.fy) > 5e-6;
  }
  EXPECT_LE(differ, 1);
}

TEST(FaceDrag, ForceIsTheProjectedAreaTimesTheSquareOfTheFlow) {
  Model model = test::lone_module();
  model.field = test::uniform_water({0.2 / model.flow.K_v, 0, 0, 0});
  const double full = 0.5 * 1000 * 0.442 * 0.035 * 0.035 * 0.2 * 0.2;
  for (const double degrees : {0.0, 10.0, 45.0, 80.0}) {
    MovingBodies bodies(1, 0, 1, 0);
    const Rot r = rotation(degrees * kPi / 180);
    bodies.c = {r.c}, bodies.s = {r.s}, bodies.omega = {0}, bodies.covered = {0};
    const Wrench w = wrenches(model, bodies, force("face_drag", {0.442}), {})[0];
    EXPECT_NEAR(w.fx, full * (r.c + r.s), 1e-6 * full);
    EXPECT_NEAR(w.fy, 0, 1e-6 * full);
  }
}

TEST(FaceDrag, CoveredFacesFeelNothingUnlessShadowingIsOff) {
  Model model = test::lone_module();
  model.field = test::uniform_water({0.2, 0, 0, 0});
  MovingBodies bodies(1, 0, 1, 0);
  bodies.c = {1}, bodies.s = {0}, bodies.omega = {0}, bodies.covered = {1u << 2};
  const ActiveForce drag = force("face_drag", {0.442});
  EXPECT_EQ(wrenches(model, bodies, drag, {})[0].fx, 0);
  model.module.shadowing = false;
  EXPECT_GT(wrenches(model, bodies, drag, {})[0].fx, 0);
}

TEST(FaceDrag, AGustIsHeldFor25Milliseconds) {
  const Model model = test::with_step(standard_model(), 5);
  const MovingBodies bodies(5, 0, 2);
  const ActiveForce drag = force("face_drag", {0.442});
  const auto a = wrenches(model, bodies, drag, {.step = 10, .gust = 2, .seed = 1});
  const auto b = wrenches(model, bodies, drag, {.step = 14, .gust = 2, .seed = 1});
  const auto c = wrenches(model, bodies, drag, {.step = 15, .gust = 3, .seed = 1});
  EXPECT_EQ(a[0].fx, b[0].fx);
  EXPECT_NE(a[0].fx, c[0].fx);
}

// Ticks, seeds and numbers of modules in any order: kept numbers are those that would be drawn.
TEST(FaceDrag, KeptGustsAreTheSameBits) {
  for (const Gusts gusts : {Gusts::per_point, Gusts::per_module, Gusts::moment_matched}) {
    Model model = test::with_step(standard_model(), 5);
    model.module.count = 37, model.flow.gusts = gusts;
    model.forces = {force("face_drag", {0.442, 10})};
    ForceSum sum(model);
    std::vector<Wrench> kept(37);
    for (const std::int64_t step : {10, 11, 14, 15, 3, 16, 10}) {
      for (const std::uint64_t seed : {1, 2, 2}) {
        const MovingBodies bodies(37, 0, seed);
        const StepContext now{.step = step, .gust = step / 5, .seed = seed};
        sum(bodies.view(), now, kept);
        const auto drawn = wrenches(model, bodies, model.forces[0], now);
        for (int i = 0; i < 37; ++i) {
          EXPECT_EQ(kept[i].fx, drawn[i].fx);
          EXPECT_EQ(kept[i].torque, drawn[i].torque);
        }
      }
    }
  }
}

}  // namespace
}  // namespace lilytank
