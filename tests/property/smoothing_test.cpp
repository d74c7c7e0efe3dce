// The Kalman smoother against motions of known truth: what it finds, and how sure it claims to be.
#include "lilytank/smoothing.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/tracks.hpp"

namespace lilytank {
namespace {

using test::kUnseen;
using test::normal;
using test::recording_of;

// A motion of known statistics, its truth, and how it was seen.
struct Filmed {
  Recording recording;
  std::vector<std::vector<double>> x, vx,
      ax;  // [body][frame]; ax from the frame before to the next
};

// Bodies whose acceleration wanders with deviation `acceleration` and memory `memory`, pushed by
// jolts, in steps of an eighth of a frame.
Filmed wanderers(const MotionModel& m, int bodies, int frames, double rate, std::uint64_t seed) {
  constexpr int kSteps = 8;
  const double dt = 1 / (rate * kSteps), keep = std::exp(-dt / m.memory);
  Filmed f;
  f.recording.rate = rate, f.recording.frames = frames;
  for (int b = 0; b < bodies; ++b) {
    Track track;
    track.id = b;
    std::vector<double> truth[2][2];  // [axis][place, velocity]
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
      double x = 0.1, v = 0.05, a = m.acceleration * normal(seed, -1, b, axis);
      for (int i = 0; i < frames; ++i) {
        truth[axis][0].push_back(x), truth[axis][1].push_back(v);
        const double seen = x + m.noise * normal(seed, i, b, 2 + axis);
        (axis == 0 ? track.x : track.y).push_back(seen);
        for (int s = 0; s < kSteps; ++s) {
          const int step = i * kSteps + s;
          const auto z =
              normal_pair({seed, Stream::gust, step, static_cast<std::uint32_t>(b), 2 + axis});
          const double kick = m.jolts * std::sqrt(dt) * z[0];
          x += (v + 0.5 * kick) * dt + 0.5 * a * dt * dt;
          v += a * dt + kick;
          a = keep * a +
              m.acceleration * std::sqrt(1 - keep * keep) * normal(seed, step, b, 6 + axis);
        }
      }
    }
    f.x.push_back(truth[0][0]), f.vx.push_back(truth[0][1]);
    std::vector<double> ax(static_cast<std::size_t>(frames), 0.0);
    for (std::size_t i = 1; i + 1 < ax.size(); ++i) {
      ax[i] = (truth[0][1][i + 1] - truth[0][1][i - 1]) * rate / 2;
    }
    f.ax.push_back(std::move(ax));
    f.recording.tracks.push_back(std::move(track));
  }
  return f;
}

// Errors over claimed deviations: their mean square, and how many are within 1.96.
struct Claims {
  double square = 0, held = 0, n = 0;
  void add(double error, double deviation) {
    const double z = error / deviation;
    square += z * z, held += std::fabs(z) < 1.96, ++n;
  }
  void expect_honest(const std::string& what) const {
    EXPECT_NEAR(square / n, 1, 0.12) << what;
    EXPECT_NEAR(held / n, 0.95, 0.015) << what;
  }
};

void expect_honest(const Filmed& f, const SmoothRecording& s, bool unseen_only) {
  Claims x, v, a;
  for (std::size_t b = 0; b < f.x.size(); ++b) {
    const SmoothTrack& t = s.tracks[b];
    for (std::size_t i = 1; i + 1 < f.x[b].size(); ++i) {
      if (unseen_only && t.seen[i]) continue;
      x.add(t.x[i] - f.x[b][i], t.sd_x[i]);
      v.add(t.vx[i] - f.vx[b][i], t.sd_v[i]);
      a.add(t.ax[i] - f.ax[b][i], t.sd_a[i]);
    }
  }
  x.expect_honest("places"), v.expect_honest("velocities"), a.expect_honest("accelerations");
}

const MotionModel kLasting{0.0003, 0.3, 0.5, 0, 0, 0};
const MotionModel kMixed{0.0003, 0.25, 0.8, 0.06, 0, 0};
const MotionModel kJolts{0.0005, 1e-9, 1, 0.15, 0, 0};

TEST(Smoothing, FindsTheNoiseOfMeasurement) {
  for (const MotionModel& m : {kLasting, kMixed, kJolts}) {
    const Filmed f = wanderers(m, 12, 1000, 30, 5);
    const MotionModel found = fit_position(f.recording);
    EXPECT_NEAR(found.noise / m.noise, 1, 0.05);
    EXPECT_GT(found.samples, 20000);
  }
}

TEST(Smoothing, FindsHowBodiesMove) {
  const MotionModel lasting = fit_position(wanderers(kLasting, 12, 1000, 30, 6).recording);
  EXPECT_NEAR(lasting.acceleration / kLasting.acceleration, 1, 0.15);
  EXPECT_NEAR(lasting.memory / kLasting.memory, 1, 0.35);
  EXPECT_LT(lasting.jolts, 0.05 * kLasting.acceleration);
  const MotionModel jolted = fit_position(wanderers(kJolts, 12, 1000, 30, 7).recording);
  EXPECT_NEAR(jolted.jolts / kJolts.jolts, 1, 0.05);
}

TEST(Smoothing, ClaimsAsMuchErrorAsItMakes) {
  for (const MotionModel& m : {kLasting, kMixed, kJolts}) {
    const Filmed f = wanderers(m, 12, 1000, 30, 8);
    expect_honest(f, smooth(f.recording), false);
  }
}

TEST(Smoothing, FillsGapsAndKnowsLessThere) {
  Filmed f = wanderers(kMixed, 12, 1000, 30, 9);
  for (Track& t : f.recording.tracks) {  // gaps of 1 .. 9 frames
    for (std::size_t from = 20, width = 1; from + 10 < t.x.size(); from += 25) {
      for (std::size_t k = 0; k < width; ++k) t.x[from + k] = t.y[from + k] = kUnseen;
      width = width % 9 + 1;
    }
  }
  const SmoothRecording s = smooth(f.recording);
  EXPECT_NEAR(s.position.noise / kMixed.noise, 1, 0.05);
  expect_honest(f, s, true);
  const SmoothTrack& t = s.tracks[0];
  EXPECT_EQ(t.seen[20], 0);
  EXPECT_EQ(t.seen[21], 1);
  EXPECT_GT(t.sd_x[220 + 4], 1.5 * t.sd_x[210]);  // within nine frames unseen
  EXPECT_GT(t.sd_x[0], t.sd_x[210]) << "nothing is known before the first frame";
}

TEST(Smoothing, IsBetterThanTheSightings) {
  const Filmed f = wanderers(kLasting, 8, 1000, 30, 10);
  const SmoothRecording s = smooth(f.recording);
  double raw = 0, smoothed = 0;
  for (std::size_t b = 0; b < f.x.size(); ++b) {
    for (std::size_t i = 0; i < f.x[b].size(); ++i) {
      raw += std::pow(f.recording.tracks[b].x[i] - f.x[b][i], 2);
      smoothed += std::pow(s.tracks[b].x[i] - f.x[b][i], 2);
    }
  }
  EXPECT_LT(smoothed, 0.35 * raw);
}

TEST(Smoothing, HeadingsHaveTheirOwnNoise) {
  Filmed f = wanderers(kMixed, 8, 1000, 30, 11);
  for (std::size_t b = 0; b < f.x.size(); ++b) {
    Track& t = f.recording.tracks[b];
    for (std::size_t i = 0; i < f.x[b].size(); ++i) {
      t.theta.push_back(10 * f.x[b][i] +
                        0.01 * normal(12, static_cast<int>(i), static_cast<int>(b)));
    }
  }
  const SmoothRecording s = smooth(f.recording);
  EXPECT_NEAR(s.heading.noise, 0.01, 0.0005);
  Claims spin;
  for (std::size_t b = 0; b < f.x.size(); ++b) {
    for (std::size_t i = 1; i + 1 < f.x[b].size(); ++i) {
      spin.add(s.tracks[b].spin[i] - 10 * f.vx[b][i], s.tracks[b].sd_spin[i]);
    }
  }
  spin.expect_honest("spins");
}

}  // namespace
}  // namespace lilytank
