// Squared displacements and autocorrelations against plain loops and closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "support/msd.hpp"
#include "support/tracks.hpp"

namespace lilytank {
namespace {

using test::kUnseen;
using test::normal;
using test::recording_of;

std::vector<double> lags_of(int most, double rate) {
  std::vector<double> lags;
  for (int k = 0; k <= most; ++k) lags.push_back(k / rate);
  return lags;
}

Recording circle(double radius, double omega, int frames, double rate) {
  return recording_of(1, frames, rate, [=](int, int f) {
    const double a = omega * f / rate;
    return std::array{0.05 + radius * std::cos(a), radius * std::sin(a)};
  });
}

// Circular motion: MSD = 2 R^2 (1 - cos(omega t)).
TEST(Msd, CircleMatchesItsClosedForm) {
  const Recording r = circle(0.1, 1.3, 4000, 40);
  for (const Origins origins : {Origins::first, Origins::all}) {
    const MsdCurve c = mean_squared_displacement(r, {0, 40, 80, 400, 5000}, origins);
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(c.msd[i], 2 * 0.01 * (1 - std::cos(1.3 * c.lag[i])), 1e-14);
    EXPECT_EQ(c.count[4], 0);
    EXPECT_EQ(c.tracks[3], 1);
    EXPECT_EQ(c.tracks[4], 0);
  }
}

TEST(Msd, BallisticMotionIsSpeedSquaredTimesLagSquared) {
  const Recording r = recording_of(3, 200, 30, [](int b, int f) {
    return std::array{0.1 * (b + 1) * f / 30.0, -0.05 * f / 30.0};
  });
  const MsdCurve c = mean_squared_displacement(r, {1, 10, 100, 199}, Origins::all);
  const double v2 = (0.01 + 0.04 + 0.09) / 3 + 0.0025;
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(c.msd[i] / (v2 * c.lag[i] * c.lag[i]), 1, 1e-9);
  EXPECT_EQ(c.count[2], 300);
}

// A random walk: MSD = steps * 2 sigma^2, with the error of the mean over independent bodies.
TEST(Msd, RandomWalkGrowsLinearlyFromItsFirstFrame) {
  const int bodies = 4000;
  const Recording r = test::random_walks(1, bodies, 50, 1, 1);
  const MsdCurve c = mean_squared_displacement(r, {1, 10, 49}, Origins::first);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(c.msd[i], 2 * c.lag[i], 4 * 2 * c.lag[i] / std::sqrt(double(bodies)));
}

// A plain loop over all pairs.
BodySums naive(const Recording& r, int most, bool products) {
  BodySums s;
  s.bins = most + 1;
  s.tracks.assign(most + 1, 0);
  for (const Track& t : r.tracks) {
    for (int lag = 0; lag <= most; ++lag) {
      double sum = 0, count = 0;
      for (std::size_t f = 0; f + lag < t.x.size(); ++f) {
        const std::size_t g = f + lag;
        if (std::isnan(t.x[f]) || std::isnan(t.x[g])) continue;
        const double dx = t.x[g] - t.x[f], dy = t.y[g] - t.y[f];
        sum += products ? t.x[g] * t.x[f] + t.y[g] * t.y[f] : dx * dx + dy * dy;
        ++count;
      }
      s.sum.push_back(sum), s.weight.push_back(count);
      s.tracks[lag] += count > 0;
    }
  }
  return s;
}

void expect_equal(const BodySums& fast, const BodySums& slow, double scale) {
  ASSERT_EQ(fast.bins, slow.bins);
  EXPECT_EQ(fast.weight, slow.weight);
  EXPECT_EQ(fast.tracks, slow.tracks);
  for (std::size_t i = 0; i < fast.sum.size(); ++i)
    EXPECT_NEAR(fast.sum[i], slow.sum[i], 1e-11 * scale) << "bin " << i % slow.bins;
}

TEST(Msd, TransformsAgreeWithLoopsOverTracksWithGaps) {
  for (const int frames : {2, 3, 17, 64, 301}) {
    Recording r = test::random_walks(7, 3, frames, 30, 0.01);
    test::make_gaps(r, 3, 0.3);
    r.tracks[1].x.resize(1), r.tracks[1].y.resize(1);
    expect_equal(squared_displacements(r, lags_of(frames + 3, 30), Origins::all),
                 naive(r, frames + 3, false), frames);
  }
}

TEST(Msd, TracksOfOneIdAreOneBody) {
  Recording r = test::random_walks(7, 2, 40, 30, 0.01);
  r.tracks.push_back(r.tracks[1]);
  r.tracks[2].first = 50;
  const BodySums s = squared_displacements(r, {1 / 30.0}, Origins::all);
  EXPECT_EQ(s.bodies(), 2);
  EXPECT_EQ(s.weight, (std::vector<double>{39, 78}));
  EXPECT_EQ(s.tracks[0], 3);
}

TEST(Msd, SingleOriginLeavesOutTracksThatBeginLate) {
  Recording r = test::random_walks(7, 2, 100, 30, 0.01);
  r.tracks[1].first = 31;
  EXPECT_EQ(mean_squared_displacement(r, {5}, Origins::first).count[0], 1);
  r.tracks[1].first = 30;
  EXPECT_EQ(mean_squared_displacement(r, {5}, Origins::first).count[0], 2);
}

// Two clocks can be compared: between frames, MSD is as that of the motion.
TEST(Msd, LagsBetweenFramesAreInterpolated) {
  const Recording r = circle(0.1, 2, 2000, 40);
  const std::vector<double> lags{1 / 30.0, 0.1, 1.01};
  const std::vector<double> msd = ratio_values(squared_displacements(r, lags, Origins::all));
  for (std::size_t i = 0; i < lags.size(); ++i) {
    const double exact = 0.02 * (1 - std::cos(2 * lags[i]));
    EXPECT_NEAR(msd[i] / exact, 1, 5e-4);  // a parabola misses the fourth power
  }
}

SmoothRecording as_velocities(const Recording& r) {
  SmoothRecording s;
  s.rate = r.rate;
  for (const Track& t : r.tracks) {
    SmoothTrack v;
    v.id = t.id, v.first = t.first, v.vx = t.x, v.vy = t.y, v.x = t.x, v.y = t.y;
    for (const double x : t.x) v.seen.push_back(!std::isnan(x));
    s.tracks.push_back(std::move(v));
  }
  return s;
}

TEST(Autocorrelation, TransformsAgreeWithLoopsOverTracksWithGaps) {
  for (const int frames : {1, 2, 30, 257}) {
    Recording r = test::random_walks(8, 3, frames, 30, 0.01);
    test::make_gaps(r, 4, 0.3);
    expect_equal(velocity_products(as_velocities(r), lags_of(frames + 1, 30)),
                 naive(r, frames + 1, true), frames);
  }
}

// Ornstein and Uhlenbeck: exp(-t / tau), with an error from the number of independent stretches.
TEST(Autocorrelation, OrnsteinUhlenbeckDecaysExponentially) {
  const double tau = 0.5, rate = 30, keep = std::exp(-1 / (rate * tau));
  const int frames = 3000, bodies = 40;
  std::array<double, 2> v{};
  const Recording r = recording_of(bodies, frames, rate, [&](int b, int f) {
    for (std::uint32_t k = 0; k < 2; ++k) {
      const double z = normal(11, f, b, k);
      v[k] = f == 0 ? z : keep * v[k] + std::sqrt(1 - keep * keep) * z;
    }
    return v;
  });
  const std::vector<double> acf =
      ratio_values(velocity_products(as_velocities(r), {0, 0.5, 1, 5}), true);
  const double independent = 2 * bodies * frames / rate / (2 * tau);
  const double error = 4 * std::sqrt(2 / independent);
  EXPECT_DOUBLE_EQ(acf[0], 1);
  EXPECT_NEAR(acf[1], std::exp(-1.0), error);
  EXPECT_NEAR(acf[2], std::exp(-2.0), error);
  EXPECT_NEAR(acf[3], 0, error);
}

TEST(Autocorrelation, HarmonicMotionOscillates) {
  const double omega = 2 * 3.14159265358979323846;  // a turn a second: lags over whole turns
  const Recording r = recording_of(1, 3001, 100, [=](int, int f) {
    return std::array{std::cos(omega * f / 100), std::sin(omega * f / 100)};
  });
  const std::vector<double> lags{0, 0.25, 0.5, 1.0, 3.1};
  const std::vector<double> acf = ratio_values(velocity_products(as_velocities(r), lags));
  for (std::size_t i = 0; i < lags.size(); ++i)
    EXPECT_NEAR(acf[i], std::cos(omega * lags[i]), 1e-11);
}

TEST(AsRecording, TakesModulesOrBallsAndUnwrapsHeadings) {
  Trajectory t;
  t.bodies = 3, t.modules = 2;
  for (int f = 0; f < 5; ++f) {
    t.time.push_back(1 + 0.2 * f);
    for (int b = 0; b < 3; ++b) {
      t.x.push_back(static_cast<float>(b)), t.y.push_back(static_cast<float>(f));
      const double theta = 2.0 * f;
      t.theta.push_back(static_cast<float>(std::remainder(theta, 6.283185307179586)));
    }
  }
  t.time.back() = 1.65;  // a run that ended between two frames
  const Recording lilies = as_recording(t, BodyKind::lily);
  EXPECT_EQ(lilies.frames, 4);
  EXPECT_NEAR(lilies.rate, 5, 1e-12);
  EXPECT_DOUBLE_EQ(lilies.start, 1);
  ASSERT_EQ(lilies.tracks.size(), 2u);
  EXPECT_NEAR(lilies.tracks[1].theta[3], 6, 1e-6);
  const Recording balls = as_recording(t, BodyKind::ball);
  ASSERT_EQ(balls.tracks.size(), 1u);
  EXPECT_TRUE(balls.tracks[0].theta.empty());
  EXPECT_DOUBLE_EQ(balls.tracks[0].x[0], 2);
  t.time[2] = 1.5;
  EXPECT_THROW(as_recording(t, BodyKind::lily), InputError);
}

// Bands over bodies hold the true curve in 95 of 100 experiments, within the binomial error.
TEST(Bands, CoverTheTruthOfRandomWalks) {
  const int experiments = 400;
  int held[2] = {0, 0}, differ[2] = {0, 0};
  for (int e = 0; e < experiments; ++e) {
    const Recording a = test::random_walks(100 + e, 15, 60, 1, 1);
    const Recording b = test::random_walks(9000 + e, 24, 60, 1, 1);
    const std::vector<double> lags{2, 20};
    const BodySums sa = squared_displacements(a, lags, Origins::all);
    const BodySums sb = squared_displacements(b, lags, Origins::all);
    Bootstrap bootstrap;
    bootstrap.seed = static_cast<std::uint64_t>(e), bootstrap.resamples = 400;
    const CurveEstimate c = ratio_curve(sa, bootstrap), d = ratio_difference(sa, sb, bootstrap);
    for (int i = 0; i < 2; ++i) {
      held[i] += c.low[i] <= 2 * lags[i] && 2 * lags[i] <= c.high[i];
      differ[i] += d.low[i] <= 0 && 0 <= d.high[i];
    }
  }
  // Four binomial deviations below 95 %; skewed sums of few bodies cost up to 4 % more.
  const double deviation = std::sqrt(0.95 * 0.05 / experiments);

  for (int i = 0; i < 2; ++i) {
    EXPECT_GT(held[i], experiments * (0.91 - 4 * deviation)) << "lag " << i;
    EXPECT_LT(held[i], experiments * (0.96 + 4 * deviation)) << "lag " << i;
    EXPECT_GT(differ[i], experiments * (0.91 - 4 * deviation)) << "lag " << i;
    EXPECT_LT(differ[i], experiments * (0.96 + 4 * deviation)) << "lag " << i;
  }
}

TEST(Bands, OneBodyGivesNoBandAndNoDataNoValue) {
  const Recording r = circle(0.1, 1, 50, 30);
  const CurveEstimate c = ratio_curve(squared_displacements(r, {0.1, 100}, Origins::all));
  EXPECT_GT(c.value[0], 0);
  EXPECT_TRUE(std::isinf(c.low[0]) && std::isinf(c.high[0]));
  EXPECT_TRUE(std::isnan(c.value[1]) && std::isnan(c.low[1]) && std::isnan(c.high[1]));
}

// Three modules of 35 mm side in a row and one apart; the row's third is latched in `third` of ten
// frames, the second in all.
Trajectory row_of_three(int third) {
  Trajectory t;
  t.bodies = t.modules = 4;
  for (int f = 0; f < 10; ++f) {
    t.time.push_back(f);
    const double turn = 0.3 * f;
    for (int b = 0; b < 4; ++b) {
      const double along = b < 3 ? 0.035 * b : 0.2;
      t.x.push_back(static_cast<float>(along * std::cos(turn)));
      t.y.push_back(static_cast<float>(along * std::sin(turn)));
      // The second one is turned: it holds the others by faces of its own.
      const double theta = turn + (b == 1 ? kPi / 2 : 0);
      t.theta.push_back(static_cast<float>(std::remainder(theta, 2 * kPi)));
      Markings m;
      const bool held = f < third;
      if (b == 0) m.latched = 1;                                              // face 0, ahead
      if (b == 1) m.latched = static_cast<std::uint8_t>(2 | (held ? 8 : 0));  // 1 back, 3 ahead
      if (b == 2 && held) m.latched = 4;                                      // face 2, back
      t.markings.push_back(m);
    }
  }
  return t;
}

TEST(AsRecording, ModulesLatchedForHalfOfTheTimeAreOneUnit) {
  const auto assemblies = [](int third) {
    std::vector<std::int64_t> out;
    for (const Track& track : as_recording(row_of_three(third), BodyKind::lily).tracks) {
      out.push_back(track.assembly);
    }
    return out;
  };
  EXPECT_EQ(assemblies(5), (std::vector<std::int64_t>{0, 0, 0, -1}));
  EXPECT_EQ(assemblies(4), (std::vector<std::int64_t>{0, 0, -1, -1})) << "not for half of it";
  Trajectory poses = row_of_three(10);
  poses.markings.clear();
  EXPECT_EQ(as_recording(poses, BodyKind::lily).tracks[0].assembly, -1) << "nothing is known";
}

// Twenty pairs of modules that move as one are twenty data, not forty.
TEST(Bands, ResampleAssembliesNotModules) {
  Recording pairs = test::random_walks(5, 20, 200, 1, 1);
  for (std::size_t i = 0; i < 20; ++i) {
    pairs.tracks.push_back(pairs.tracks[i]);
    pairs.tracks.back().id = static_cast<std::int64_t>(100 + i);
  }
  Recording latched = pairs;
  for (std::size_t i = 0; i < 20; ++i) {
    latched.tracks[i].assembly = latched.tracks[20 + i].assembly = latched.tracks[i].id;
  }
  const std::vector<double> lags{5, 20};
  const auto curve = [&](const Recording& r, int& units) {
    const BodySums sums = squared_displacements(r, lags, Origins::all);
    units = sums.bodies();
    return ratio_curve(sums);
  };
  int modules = 0, assemblies = 0;
  const CurveEstimate apart = curve(pairs, modules), together = curve(latched, assemblies);
  EXPECT_EQ(modules, 40);
  EXPECT_EQ(assemblies, 20);
  for (std::size_t k = 0; k < lags.size(); ++k) {
    EXPECT_DOUBLE_EQ(together.value[k], apart.value[k]) << "the curve stays";
    const double wider = (together.high[k] - together.low[k]) / (apart.high[k] - apart.low[k]);
    EXPECT_NEAR(wider, std::sqrt(2.0), 0.25) << "its band is that of half as many";
  }
}

TEST(Diffusion, OfARandomWalkWithMeasurementNoise) {
  const double step = 0.001, rate = 30, noise = 0.002;
  Recording r = test::random_walks(5, 60, 2000, rate, step);
  for (Track& t : r.tracks) {
    for (std::size_t f = 0; f < t.x.size(); ++f) {
      t.x[f] += noise * normal(6, static_cast<int>(f), static_cast<int>(t.id), 0);
      t.y[f] += noise * normal(6, static_cast<int>(f), static_cast<int>(t.id), 1);
    }
  }
  std::vector<double> lags;
  for (int k = 1; k <= 300; ++k) lags.push_back(k / rate);
  const BodySums msd = squared_displacements(r, lags, Origins::all);
  const double exact = step * step * rate / 2;  // m^2/s
  const Diffusion found = diffusion(msd, lags, 2);
  EXPECT_LT(found.D.low, exact);
  EXPECT_GT(found.D.high, exact);
  EXPECT_LT(found.D.high - found.D.low, 0.4 * exact);
  EXPECT_GT(found.to / found.from, 2);
  const Diffusion asked = diffusion(msd, lags, 2, 0.1, 2);
  EXPECT_DOUBLE_EQ(asked.to, 2);
  EXPECT_NEAR(asked.D.value, exact, 0.1 * exact);
}

TEST(Diffusion, IsNotClaimedForAnOrbit) {
  const Recording r = circle(0.1, 1.3, 4000, 40);
  std::vector<double> lags;
  for (int k = 1; k <= 400; ++k) lags.push_back(k / 40.0);
  const Diffusion found = diffusion(squared_displacements(r, lags, Origins::all), lags, 2);
  EXPECT_TRUE(std::isnan(found.D.value));
}

}  // namespace
}  // namespace lilytank
