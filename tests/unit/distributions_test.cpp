// Distributions, neighbours and contacts of tracks whose answers are known.
#include "lilytank/distributions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "lilytank/math.hpp"
#include "support/tracks.hpp"

namespace lilytank {
namespace {

using test::normal;
using test::recording_of;

// Tracks as they are, for what does not depend on smoothing.
SmoothRecording unsmoothed(const Recording& r) {
  SmoothRecording s;
  s.rate = r.rate;
  for (const Track& t : r.tracks) {
    SmoothTrack v;
    v.id = t.id, v.first = t.first, v.x = t.x, v.y = t.y;
    v.vx.assign(t.x.size(), 0.0), v.vy = v.vx;
    v.theta = t.theta, v.spin.assign(t.theta.size(), 0.0);
    for (const double x : t.x) v.seen.push_back(!std::isnan(x));
    s.tracks.push_back(std::move(v));
  }
  return s;
}

// Points spread evenly over a disc, anew in each frame.
Recording even_spread(int bodies, int frames, double radius, std::uint64_t seed) {
  return recording_of(bodies, frames, 10, [=](int b, int f) {
    const auto u = [&](std::uint32_t i) {
      return uniform({seed, Stream::start_pose, f, static_cast<std::uint32_t>(b), i});
    };
    const double r = radius * std::sqrt(u(0)), a = 2 * kPi * u(1);
    return std::array{r * std::cos(a), r * std::sin(a)};
  });
}

TEST(Bins, HoldBothEndsAndNothingBeyond) {
  const Bins bins{-1, 1, 4};
  EXPECT_EQ(bins.of(-1), 0);
  EXPECT_EQ(bins.of(-0.5), 1);
  EXPECT_EQ(bins.of(1), 3);
  EXPECT_EQ(bins.of(1.001), -1);
  EXPECT_EQ(bins.of(-1.001), -1);
  EXPECT_EQ(bins.of(NAN), -1);
  EXPECT_DOUBLE_EQ(bins.middle(0), -0.75);
}

// An orbit at 0.1 m and 2 rad/s: all of its velocity is about the centre.
TEST(Distributions, AnOrbitMovesAboutTheCentreOnly) {
  SmoothRecording s = unsmoothed(recording_of(2, 300, 30, [](int b, int f) {
    const double a = 2 * f / 30.0 + b;
    return std::array{0.1 * std::cos(a), 0.1 * std::sin(a)};
  }));
  for (SmoothTrack& t : s.tracks) {
    for (int f = 0; f < t.frames(); ++f) t.vx[f] = -2 * t.y[f], t.vy[f] = 2 * t.x[f];
  }
  const auto only = [](const BodySums& sums) { return ratio_values(sums)[0]; };
  EXPECT_NEAR(only(mean_power(s, Quantity::velocity_around, 1)), 0.2, 1e-12);
  EXPECT_NEAR(only(mean_power(s, Quantity::velocity_out, 2)), 0, 1e-20);
  EXPECT_NEAR(only(mean_power(s, Quantity::speed, 2)), 0.04, 1e-12);
  EXPECT_NEAR(only(circulation(s)), 2, 1e-12);
  EXPECT_NEAR(quantile_of_size(s, Quantity::speed, 0.9), 0.2, 1e-12);
  const Bins bins{0.05, 0.35, 3};
  const std::vector<double> speed = ratio_values(distribution(s, Quantity::speed, bins));
  EXPECT_NEAR(speed[1], 10, 1e-9) << "all samples in a bin of 0.1 m/s";
  EXPECT_EQ(speed[0], 0);
  EXPECT_EQ(distribution(s, Quantity::spin, bins).bodies(), 0) << "no headings, no spins";
}

TEST(Distributions, OfVelocitiesIntegrateToTheShareWithin) {
  SmoothRecording s = unsmoothed(even_spread(5, 2000, 0.3, 1));
  for (SmoothTrack& t : s.tracks) {
    for (int f = 0; f < t.frames(); ++f) t.vx[f] = normal(2, f, static_cast<int>(t.id));
  }
  const Bins bins{-1, 1, 20};
  const std::vector<double> p = ratio_values(distribution(s, Quantity::velocity_x, bins));
  const double within = std::accumulate(p.begin(), p.end(), 0.0) * bins.width();
  EXPECT_NEAR(within, std::erf(std::sqrt(0.5)), 4 * std::sqrt(0.683 * 0.317 / 10000));
  EXPECT_NEAR(p[10], 1 / std::sqrt(2 * kPi), 4 * std::sqrt(0.4 / (0.1 * 10000)));
}

TEST(RadialDensity, OfAnEvenSpreadIsOne) {
  const SmoothRecording s = unsmoothed(even_spread(20, 2000, 0.3, 3));
  const Bins rings{0, 0.3, 6};
  const std::vector<double> density = ratio_values(radial_density(s, 0.3, rings));
  for (int i = 0; i < rings.count; ++i) {
    const double share = (2 * i + 1) / 36.0;
    EXPECT_NEAR(density[i], 1, 4 * std::sqrt((1 - share) / (share * 40000)));
  }
}

// Bodies that know nothing of each other, unevenly spread: 1 everywhere. Rigid pairs: a peak.
TEST(PairCorrelation, IsOneForIndependentBodiesHoweverSpread) {
  const Bins bins{0, 0.2, 10};
  SmoothRecording s = unsmoothed(even_spread(12, 3000, 0.3, 4));
  for (SmoothTrack& t : s.tracks) {
    for (double& x : t.x) x = 0.05 + 0.5 * std::fabs(x);  // crowded to one side
  }
  const BodySums sums = pair_correlation(s, bins);
  const CurveEstimate g = ratio_curve(sums);
  for (int i = 0; i < bins.count; ++i) EXPECT_NEAR(g.value[i], 1, 0.05) << "bin " << i;
  EXPECT_EQ(sums.bodies(), 12);
  for (SmoothTrack& t : s.tracks) {
    if (t.id % 2 == 0) continue;
    const SmoothTrack& other = s.tracks[static_cast<std::size_t>(t.id - 1)];
    for (int f = 0; f < t.frames(); ++f) t.x[f] = other.x[f] + 0.03, t.y[f] = other.y[f];
  }
  EXPECT_GT(ratio_values(pair_correlation(s, bins))[1], 3);
}

TEST(Neighbours, NearestOfThreeInARow) {
  const SmoothRecording s = unsmoothed(recording_of(3, 50, 10, [](int b, int) {
    return std::array{b == 2 ? 0.15 : 0.05 * b, 0.0};
  }));
  EXPECT_NEAR(ratio_values(nearest_distance(s))[0], (0.05 + 0.05 + 0.1) / 3, 1e-12);
  const Bins bins{0, 0.16, 4};
  const std::vector<double> p = ratio_values(nearest_neighbours(s, bins));
  EXPECT_NEAR(p[1] * bins.width(), 2 / 3.0, 1e-12);
  EXPECT_NEAR(p[2] * bins.width(), 1 / 3.0, 1e-12);
}

// Two discs of 3 cm whose gap goes through `gaps` (mm), a frame each.
Contacts contacts_of(const std::vector<double>& gaps, bool lost_at_4 = false) {
  Recording r = recording_of(2, static_cast<int>(gaps.size()), 10, [&](int b, int f) {
    return std::array{b * (0.03 + 1e-3 * gaps[static_cast<std::size_t>(f)]), 0.0};
  });
  if (lost_at_4) r.tracks[1].x[4] = r.tracks[1].y[4] = test::kUnseen;
  return find_contacts(unsmoothed(r), {0.03, false, 0.001, 0.002});
}

TEST(Contacts, BeginBelowOneGapAndEndAboveAnother) {
  const Contacts c = contacts_of({5, 0.5, 1.5, 0.2, 3, 5, 0.9, 2.5, 5, 5});
  ASSERT_EQ(c.durations.size(), 2u);
  EXPECT_NEAR(c.durations[0].time, 0.3, 1e-12);
  EXPECT_NEAR(c.durations[1].time, 0.1, 1e-12);
  EXPECT_TRUE(c.durations[0].observed);
  EXPECT_NEAR(ratio_values(c.begun)[0], 2, 1e-12) << "each body began two in a second";
  EXPECT_NEAR(ratio_values(c.touching)[0], 0.4, 1e-12);
}

TEST(Contacts, ThatAreNotSeenToEndAreCensored) {
  const Contacts at_end = contacts_of({5, 5, 0.5, 0.5});
  ASSERT_EQ(at_end.durations.size(), 1u);
  EXPECT_FALSE(at_end.durations[0].observed);
  EXPECT_NEAR(at_end.durations[0].time, 0.1, 1e-12);
  const Contacts lost = contacts_of({5, 5, 0.5, 0.5, 0.5, 0.5, 5}, true);
  ASSERT_EQ(lost.durations.size(), 1u) << "what is found touching was not seen to begin";
  EXPECT_FALSE(lost.durations[0].observed);
  EXPECT_TRUE(contacts_of({0.5, 0.5, 5}).durations.empty()) << "nor what was there at first";
}

// Of every third frame with both discs, the last sighting says that they were apart before.
TEST(Contacts, BeginAfterTheLastSightingWhereMostFramesAreHoles) {
  const std::vector<double> gaps{5, 5, 0.5, 0.5, 5, 5, 0.5, 5};
  const auto at = [&](int f) { return gaps[static_cast<std::size_t>(f / 3)]; };
  Recording r = recording_of(2, 22, 10, [&](int b, int f) {
    return std::array{b * (0.03 + 1e-3 * at(f)), 0.0};
  });
  for (Track& track : r.tracks) {
    for (std::size_t f = 0; f < track.x.size(); ++f) {
      if (f % 3 != 0) track.x[f] = track.y[f] = test::kUnseen;
    }
  }
  const Contacts c = find_contacts(unsmoothed(r), {0.03, false, 0.001, 0.002});
  const Contacts close = contacts_of(gaps);
  ASSERT_EQ(c.durations.size(), close.durations.size());
  for (std::size_t i = 0; i < c.durations.size(); ++i) {
    EXPECT_NEAR(c.durations[i].time, 3 * close.durations[i].time, 1e-12);
  }
  EXPECT_NEAR(ratio_values(c.begun)[0], ratio_values(close.begun)[0] / 3, 1e-12);
}

TEST(Contacts, OfSquaresDependOnTheirHeadings) {
  // Faces 4 mm apart side by side; a corner of the turned one closes the gap.
  for (const auto& [turn, touches] : {std::pair{0.0, false}, {kPi / 4, true}, {kPi / 2, false}}) {
    Recording r = recording_of(2, 10, 10, [](int b, int f) {
      return std::array{f == 0 ? 0.1 * b : 0.039 * b, 0.0};
    });
    r.tracks[0].theta.assign(10, turn), r.tracks[1].theta.assign(10, 0.0);
    const Contacts c = find_contacts(unsmoothed(r), {0.035, true, 0.001, 0.002});
    EXPECT_EQ(!c.durations.empty(), touches) << "turned by " << turn;
  }
}

TEST(VelocityMap, HasMeansWhereBodiesPassedAndTheirErrors) {
  const int bodies = 40;
  SmoothRecording s = unsmoothed(recording_of(bodies, 20, 10, [](int, int f) {
    return std::array{f < 10 ? -0.1 : 0.1, 0.1};
  }));
  double mean = 0, square = 0;
  for (SmoothTrack& t : s.tracks) {
    const double own = normal(5, 0, static_cast<int>(t.id));  // a body's own speed
    mean += own / bodies, square += own * own / bodies;
    for (int f = 0; f < t.frames(); ++f) t.vx[f] = own, t.vy[f] = f < 10 ? 1 : 2;
  }
  const VelocityMap map = velocity_map({s}, 2, 0.2);
  EXPECT_TRUE(std::isnan(map.vx[0]) && std::isnan(map.se_x[0]));
  EXPECT_EQ(map.samples[2], 10 * bodies);
  EXPECT_EQ(map.bodies[3], bodies);
  EXPECT_NEAR(map.vx[2], mean, 1e-12);
  EXPECT_NEAR(map.vy[3], 2, 1e-12);
  EXPECT_NEAR(map.se_y[3], 0, 1e-12);
  // Frames of one body are no new information: the error is that of the mean over bodies.
  EXPECT_NEAR(map.se_x[2], std::sqrt((square - mean * mean) / (bodies - 1)), 1e-12);
}

// Every statistic has a row for an assembly, with the sums of its modules.
TEST(Distribution, AnAssemblyIsOneRow) {
  Recording recording = test::random_walks(3, 6, 80, 0.01, 10);
  const SmoothRecording apart = smooth(recording);
  for (std::size_t i = 0; i < 3; ++i) recording.tracks[i].assembly = recording.tracks[0].id;
  const SmoothRecording latched = smooth(recording);
  const Bins bins{0, 1, 5};
  const auto expect_rows = [&](const BodySums& one, const BodySums& other, const char* what) {
    EXPECT_EQ(one.bodies(), 6) << what;
    EXPECT_EQ(other.bodies(), 4) << what;
    const std::vector<double> a = ratio_values(one), b = ratio_values(other);
    for (std::size_t k = 0; k < a.size(); ++k) {
      if (std::isnan(a[k])) continue;
      EXPECT_NEAR(a[k], b[k], 1e-9 * (1 + std::fabs(a[k]))) << what;
    }
  };
  expect_rows(distribution(apart, Quantity::speed, bins),
              distribution(latched, Quantity::speed, bins), "speed");
  expect_rows(mean_power(apart, Quantity::speed, 2), mean_power(latched, Quantity::speed, 2),
              "power");
  expect_rows(nearest_neighbours(apart, bins), nearest_neighbours(latched, bins), "nearest");
  expect_rows(nearest_distance(apart), nearest_distance(latched), "distance");
  const ContactRule rule{0.05, false, 0.001, 0.002};
  expect_rows(find_contacts(apart, rule).touching, find_contacts(latched, rule).touching, "touch");
  expect_rows(find_contacts(apart, rule).begun, find_contacts(latched, rule).begun, "contacts");
}

}  // namespace
}  // namespace lilytank
