// Smoothers on simple motions, and what they let through.
#include "lilytank/smoothing.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/tracks.hpp"

namespace lilytank {
namespace {

using test::kUnseen;
using test::recording_of;

constexpr double kPi = 3.14159265358979323846;

TEST(Smoothing, TakesExactAndMotionlessTracks) {
  Recording r = recording_of(1, 200, 30, [](int, int f) {
    const double a = 0.02 * f;
    return std::array{0.1 * std::cos(a), 0.1 * std::sin(a)};
  });
  SmoothingOptions known;
  known.noise = 1e-7;
  const SmoothRecording orbit = smooth(r, known);
  EXPECT_NEAR(orbit.tracks[0].vy[100], 0.1 * 0.6 * std::cos(2), 1e-4);
  EXPECT_NEAR(orbit.tracks[0].ax[100], -0.1 * 0.36 * std::cos(2), 1e-4);
  r = recording_of(2, 50, 30, [](int b, int) { return std::array{0.1 * b, 0.0}; });
  const SmoothRecording still = smooth(r);
  EXPECT_DOUBLE_EQ(still.tracks[1].x[20], 0.1);
  EXPECT_NEAR(still.tracks[1].vx[20], 0, 1e-12);
  for (const int frames : {1, 2, 3, 7}) {
    r = recording_of(1, frames, 30, [](int, int f) { return std::array{0.1 + 0.01 * f, 0.0}; });
    const SmoothRecording s = smooth(r);
    for (int f = 0; f < frames; ++f) {
      EXPECT_NEAR(s.tracks[0].x[f], 0.1 + 0.01 * f, 1e-6) << frames << " frames";
      EXPECT_FALSE(std::isnan(s.tracks[0].sd_v[f]) || std::isnan(s.tracks[0].ax[f]));
    }
  }
  EXPECT_TRUE(smooth(Recording{}).tracks.empty());
}

// What smoothing leaves of a motion of one frequency is what the transfer function says.
double amplitude_kept(const SmoothingOptions& options, double frequency, int order) {
  const double rate = 30, w = 2 * kPi * frequency;
  Recording r = recording_of(1, 3000, rate, [=](int, int f) {
    return std::array{std::cos(w * f / rate), std::sin(w * f / rate)};
  });
  const SmoothTrack t = smooth(r, options).tracks[0];
  const std::size_t f = 1500;
  if (order == 0) return std::hypot(t.x[f], t.y[f]);
  if (order == 1) return std::hypot(t.vx[f], t.vy[f]) / w;
  return std::hypot(t.ax[f], t.ay[f]) / (w * w);
}

TEST(TransferFunction, OfPolynomialsIsWhatTheyDo) {
  SmoothingOptions options;
  options.noise = 1;
  options.method = SmoothingMethod::polynomial;
  for (const int degree : {2, 3, 5}) {
    options.degree = degree, options.window = 0.4;
    const TransferFunction t = transfer_function(options, {}, 30, 31);  // every 0.5 Hz
    for (const int k : {1, 4, 9, 20}) {
      EXPECT_NEAR(t.position[k], amplitude_kept(options, t.frequency[k], 0), 1e-9);
      EXPECT_NEAR(t.velocity[k], amplitude_kept(options, t.frequency[k], 1), 1e-9);
      EXPECT_NEAR(t.acceleration[k], amplitude_kept(options, t.frequency[k], 2), 1e-9);
    }
  }
}

// The weights of Savitzky and Golay's table for five points: (-3, 12, 17, 12, -3) / 35.
TEST(TransferFunction, OfFivePointsIsSavitzkysAndGolays) {
  SmoothingOptions options;
  options.method = SmoothingMethod::polynomial;
  options.degree = 2, options.window = 5 / 30.0;
  const TransferFunction t = transfer_function(options, {}, 30, 31);
  for (std::size_t i = 0; i < t.frequency.size(); ++i) {
    const double w = 2 * kPi * t.frequency[i] / 30;
    EXPECT_NEAR(t.position[i], std::fabs(17 + 24 * std::cos(w) - 6 * std::cos(2 * w)) / 35, 1e-12);
    if (i == 0) continue;
    const double slope = std::fabs(2 * std::sin(w) + 4 * std::sin(2 * w)) / 10;
    EXPECT_NEAR(t.velocity[i], slope / w, 1e-12);
  }
  EXPECT_NEAR(t.position_noise_gain, std::sqrt(17.0 / 35), 1e-12);
}

// Wiener's smoother: S / (S + noise^2) with the spectrum S of the motion. Sampled velocities that
// walk at random have second differences of variance 2/3 q and covariance 1/6 q, q = jolts^2 /
// rate^3.
TEST(TransferFunction, OfTheKalmanSmootherIsWieners) {
  const double rate = 30;
  const MotionModel m{0.0004, 1e-9, 1, 0.12, 0, 0};
  const TransferFunction t = transfer_function({}, m, rate, 61);
  const double q = m.jolts * m.jolts / (rate * rate * rate);
  for (std::size_t i = 1; i < t.frequency.size(); ++i) {
    const double w = 2 * kPi * t.frequency[i] / rate, bend = std::pow(2 - 2 * std::cos(w), 2);
    const double s = q * (2 + std::cos(w)) / 3 / bend;
    EXPECT_NEAR(t.position[i], s / (s + m.noise * m.noise), 1e-6) << t.frequency[i] << " Hz";
  }
  EXPECT_GT(t.position_cutoff, t.acceleration_cutoff);
}

TEST(TransferFunction, NoiseGainIsTheClaimedDeviationOfPolynomials) {
  SmoothingOptions options;
  options.method = SmoothingMethod::polynomial;
  options.noise = 0.001;
  const Recording r = test::random_walks(3, 1, 200, 30, 0.01);
  const SmoothTrack s = smooth(r, options).tracks[0];
  const TransferFunction t = transfer_function(options, {}, 30);
  EXPECT_NEAR(s.sd_x[100], 0.001 * t.position_noise_gain, 1e-12);
  EXPECT_NEAR(s.sd_v[100], 0.001 * t.velocity_noise_gain, 1e-10);
  EXPECT_NEAR(s.sd_a[100], 0.001 * t.acceleration_noise_gain, 1e-8);
}

TEST(Polynomial, KeepsCubicsThroughGapsAndEnds) {
  const auto x = [](double t) { return 0.1 - 0.3 * t + 0.2 * t * t - 0.05 * t * t * t; };
  Recording r = recording_of(1, 90, 30, [&](int, int f) {
    return std::array{x(f / 30.0), -x(f / 30.0)};
  });
  for (const std::size_t f : {6, 40, 41, 42}) r.tracks[0].x[f] = r.tracks[0].y[f] = kUnseen;
  SmoothingOptions options;
  options.method = SmoothingMethod::polynomial;
  const SmoothTrack s = smooth(r, options).tracks[0];
  for (int f = 0; f < 90; ++f) {
    const double t = f / 30.0;
    EXPECT_NEAR(s.x[f], x(t), 1e-12);
    EXPECT_NEAR(s.vx[f], -0.3 + 0.4 * t - 0.15 * t * t, 1e-10);
    EXPECT_NEAR(s.ay[f], -(0.4 - 0.3 * t), 1e-8);
  }
}

TEST(Polynomial, SaysNothingWhereTooLittleWasSeen) {
  Recording r = test::random_walks(3, 1, 60, 30, 0.01);
  for (std::size_t f = 10; f < 50; ++f) r.tracks[0].x[f] = r.tracks[0].y[f] = kUnseen;
  SmoothingOptions options;
  options.method = SmoothingMethod::polynomial;
  const SmoothTrack s = smooth(r, options).tracks[0];
  EXPECT_TRUE(std::isnan(s.x[30]) && std::isnan(s.vx[30]) && std::isnan(s.sd_a[30]));
  EXPECT_FALSE(std::isnan(s.x[5]));
}

TEST(Smoothing, RefusesWhatItCannotUse) {
  Recording r = test::random_walks(3, 1, 20, 30, 0.01);
  SmoothingOptions options;
  options.degree = 6;
  EXPECT_THROW(smooth(r, options), InputError);
  options.degree = 3, options.window = 0;
  EXPECT_THROW(smooth(r, options), InputError);
  r.rate = 0;
  EXPECT_THROW(smooth(r), InputError);
}

}  // namespace
}  // namespace lilytank
