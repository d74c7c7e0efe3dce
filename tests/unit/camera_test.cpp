// A camera over a simulated tank: what it adds to the truth is what it says.
#include "lilytank/camera.hpp"

#include <gtest/gtest.h>

#include "support/recordings.hpp"

namespace lilytank {
namespace {

/// Bodies on circles, stored every 25 ms; the last `balls` are balls.
Trajectory circles(int bodies, int balls, double seconds) {
  Trajectory t;
  t.bodies = bodies, t.modules = bodies - balls;
  for (int f = 0; f <= static_cast<int>(seconds / 0.025); ++f) {
    t.time.push_back(0.025 * f);
    for (int b = 0; b < bodies; ++b) {
      const double angle = b + (b + 1) * t.time.back();
      t.x.push_back(static_cast<float>(0.05 * (b + 1) * std::cos(angle)));
      t.y.push_back(static_cast<float>(0.05 * (b + 1) * std::sin(angle)));
      t.theta.push_back(static_cast<float>(std::remainder(angle, 2 * kPi)));
    }
  }
  return t;
}

Camera perfect() {
  Camera camera;
  camera.position_noise = camera.heading_noise = 0;
  return camera;
}

TEST(Camera, aPerfectOneSeesWhatIsThere) {
  const Recording r = film(circles(3, 0, 20), perfect());
  EXPECT_EQ(r.frames, 601);
  EXPECT_DOUBLE_EQ(r.rate, 30);
  EXPECT_DOUBLE_EQ(r.start, 0);
  ASSERT_EQ(r.tracks.size(), 3u);
  for (int b = 0; b < 3; ++b) {
    const Track& track = r.tracks[static_cast<std::size_t>(b)];
    ASSERT_EQ(track.x.size(), 601u);
    for (int f = 0; f < 601; ++f) {
      const double angle = b + (b + 1) * r.time(f);
      // A chord lies within radius (w dt)^2 / 8 of its arc.
      const double sag = 0.05 * (b + 1) * std::pow(0.025 * (b + 1), 2) / 8 + 2e-8;
      EXPECT_NEAR(track.x[static_cast<std::size_t>(f)], 0.05 * (b + 1) * std::cos(angle), sag);
      EXPECT_NEAR(track.y[static_cast<std::size_t>(f)], 0.05 * (b + 1) * std::sin(angle), sag);
      // Continuous through all turns.
      EXPECT_NEAR(track.theta[static_cast<std::size_t>(f)] - track.theta[0], angle - b, 1e-5);
    }
  }
}

TEST(Camera, noiseHasTheDeviationThatIsAskedFor) {
  Camera camera;
  camera.position_noise = 0.001, camera.heading_noise = 0.02;
  const Trajectory t = circles(4, 0, 100);
  const Recording noisy = film(t, camera), clean = film(t, perfect());
  double place = 0, turn = 0, neighbours = 0;
  int n = 0;
  for (std::size_t b = 0; b < 4; ++b) {
    double last = 0;
    for (std::size_t f = 0; f < noisy.tracks[b].x.size(); ++f) {
      const double dx = noisy.tracks[b].x[f] - clean.tracks[b].x[f];
      const double dy = noisy.tracks[b].y[f] - clean.tracks[b].y[f];
      const double da = noisy.tracks[b].theta[f] - clean.tracks[b].theta[f];
      place += dx * dx + dy * dy, turn += da * da, neighbours += dx * last;
      last = dx, ++n;
    }
  }
  // n = 12004: the standard error of a variance is sqrt(2 / n) of it, 4 of these are allowed.
  const double error = 4 * std::sqrt(2.0 / n);
  EXPECT_NEAR(place / (2 * n), 1e-6, 1e-6 * error);
  EXPECT_NEAR(turn / n, 4e-4, 4e-4 * error);
  EXPECT_NEAR(neighbours / n, 0, 1e-6 * 4 / std::sqrt(n));
}

TEST(Camera, latencyShowsThePast) {
  Camera camera = perfect();
  camera.latency = 0.5;
  const Trajectory t = circles(2, 0, 20);
  const Recording late = film(t, camera), prompt = film(t, perfect());
  EXPECT_DOUBLE_EQ(late.start, 0.5);
  for (int f = 0; f < 500; ++f) {
    EXPECT_NEAR(late.tracks[1].x[static_cast<std::size_t>(f)],
                prompt.tracks[1].x[static_cast<std::size_t>(f)], 1e-12);
  }
}

TEST(Camera, framesAndSightingsAreLost) {
  Camera camera = perfect();
  camera.dropped = 0.1, camera.missed = 0.05;
  const Recording r = film(circles(5, 0, 200), camera);
  int none = 0, some = 0;
  for (int f = 5; f < r.frames - 5; ++f) {
    int seen = 0;
    for (const Track& t : r.tracks) {
      if (!std::isnan(t.x[static_cast<std::size_t>(f - t.first)])) ++seen;
    }
    (seen == 0 ? none : some) += 1;
  }
  // n = 5991: binomial deviations, 4 of them.
  const double n = none + some;
  EXPECT_NEAR(none / n, 0.1, 4 * std::sqrt(0.1 * 0.9 / n));
  for (const Track& t : r.tracks) {
    EXPECT_FALSE(std::isnan(t.x.front()));
    EXPECT_FALSE(std::isnan(t.x.back()));
  }
}

TEST(Camera, aSeedIsARecording) {
  Camera camera;
  camera.dropped = 0.01, camera.swaps = 1, camera.swap_distance = 0.06;
  const Trajectory t = circles(4, 0, 30);
  const TemporaryDirectory here;
  write_recording(film(t, camera), here.path("a.csv"));
  write_recording(film(t, camera), here.path("b.csv"));
  EXPECT_EQ(here.read("a.csv"), here.read("b.csv"));
  camera.seed = 2;
  write_recording(film(t, camera), here.path("c.csv"));
  EXPECT_NE(here.read("a.csv"), here.read("c.csv"));
}

TEST(Camera, exchangedBodiesAreFoundByTheChecks) {
  Camera camera;
  camera.swaps = 0.5, camera.swap_distance = 0.08;
  const Trajectory t = circles(4, 0, 60);
  const Recording r = film(t, camera), truth = film(t, perfect());
  const TemporaryDirectory here;
  write_recording(r, here.path("a.csv"));
  const CheckedRecording c = check_recording(here.path("a.csv"));
  // Where the nearest true body changes.
  std::vector<std::pair<int, std::int64_t>> swaps;
  for (const Track& track : r.tracks) {
    std::size_t last = static_cast<std::size_t>(track.id);
    for (std::size_t f = 0; f < track.x.size(); ++f) {
      std::size_t nearest = 0;
      double least = 1;
      for (std::size_t b = 0; b < 4; ++b) {
        const double d =
            std::hypot(track.x[f] - truth.tracks[b].x[f], track.y[f] - truth.tracks[b].y[f]);
        if (d < least) least = d, nearest = b;
      }
      if (nearest != last) swaps.emplace_back(static_cast<int>(f), track.id);
      last = nearest;
    }
  }
  std::sort(swaps.begin(), swaps.end());
  ASSERT_GT(swaps.size(), 4u);
  std::vector<std::pair<int, std::int64_t>> found;
  for (const Finding& f : c.findings) {
    EXPECT_TRUE(f.check == Check::swap || f.check == Check::spike) << f.text();
    if (f.check == Check::swap) found.emplace_back(static_cast<int>(f.frame), f.id);
  }
  EXPECT_EQ(found, swaps) << all_texts(c);
}

TEST(Camera, ballsAreFilmedWithoutHeadings) {
  const Recording r = film(circles(5, 2, 5), perfect(), BodyKind::ball);
  ASSERT_EQ(r.tracks.size(), 2u);
  EXPECT_EQ(r.body, BodyKind::ball);
  EXPECT_EQ(r.tracks[0].id, 0);
  EXPECT_FALSE(r.has_heading());
  EXPECT_NEAR(std::hypot(r.tracks[0].x[0], r.tracks[0].y[0]), 0.2, 1e-6);
}

TEST(Camera, aLensBendsAndATiltTapers) {
  const Trajectory t = circles(3, 0, 5);
  const Recording clean = film(t, perfect());
  Camera camera = perfect();
  camera.lens = 0.5;
  const Recording bent = film(t, camera);
  camera.lens = 0, camera.tilt = 0.1, camera.height = 0.8, camera.tilt_direction = kPi / 2;
  const Recording tapered = film(t, camera);
  for (std::size_t b = 0; b < 3; ++b) {
    for (std::size_t f = 0; f < clean.tracks[b].x.size(); f += 7) {
      const double x = clean.tracks[b].x[f], y = clean.tracks[b].y[f];
      EXPECT_NEAR(bent.tracks[b].x[f], x * (1 + 0.5 * (x * x + y * y)), 1e-12);
      EXPECT_NEAR(bent.tracks[b].y[f], y * (1 + 0.5 * (x * x + y * y)), 1e-12);
      // A pinhole 0.8 m along an axis that leans to +y by 0.1 rad, the picture's scale set at the
      // centre: depth along the axis is 0.8 - y sin(0.1).
      const double depth = 0.8 - y * std::sin(0.1);
      EXPECT_NEAR(tapered.tracks[b].x[f], 0.8 * x / depth, 1e-12);
      EXPECT_NEAR(tapered.tracks[b].y[f], 0.8 * y * std::cos(0.1) / depth, 1e-12);
    }
  }
}

TEST(Camera, refusesWhatCannotBeFilmed) {
  EXPECT_THROW(film(circles(3, 0, 5), {}, BodyKind::ball), InputError);
  EXPECT_THROW(film(circles(3, 0, 0), {}), InputError);
}

}  // namespace
}  // namespace lilytank
