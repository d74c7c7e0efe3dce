// Motion summaries of motion whose numbers are known.
#include "lilytank/motion_summary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "lilytank/random.hpp"

namespace lilytank {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Bodies that go round on circles of 10 cm and 20 cm with 2 rad/s, and turn with it.
Recording circles_for(double seconds) {
  Recording r;
  r.rate = 30, r.frames = 1 + static_cast<int>(std::lround(seconds * r.rate));
  for (int b = 0; b < 2; ++b) {
    Track track;
    track.id = b;
    for (int f = 0; f < r.frames; ++f) {
      const double angle = b + 2 * f / r.rate, radius = 0.1 * (b + 1);
      track.x.push_back(radius * std::cos(angle)), track.y.push_back(radius * std::sin(angle));
      track.theta.push_back(angle);
    }
    r.tracks.push_back(track);
  }
  return r;
}

std::map<std::string, double> named(const std::vector<Recording>& recordings,
                                    const MotionSummary& summary) {
  const auto entries = summary_entries(summary);
  const auto values = summarise(recordings, summary);
  EXPECT_EQ(entries.size(), values.size());
  std::map<std::string, double> out;
  for (std::size_t i = 0; i < entries.size(); ++i) out[entries[i].name] = values[i];
  EXPECT_EQ(out.size(), entries.size()) << "names repeat";
  return out;
}

TEST(MotionSummary, tellsACircleForWhatItIs) {
  const auto of = named({circles_for(120)}, MotionSummary{});
  for (const double lag : {0.4, 2.0, 12.0}) {
    // Mean over both circles of 2 R^2 (1 - cos w t).
    const double msd = (0.01 + 0.04) * (1 - std::cos(2 * lag));
    EXPECT_NEAR(of.at("msd " +
                      std::string(lag < 1   ? "0.4"
                                  : lag < 3 ? "2"
                                            : "12") +
                      " s"),
                std::log(msd), 1e-6);
  }
  // Velocities over 0.1 s or so are a chord's, a little less than the arc's.
  EXPECT_NEAR(of.at("mean square"), std::log((0.04 + 0.16) / 2), 0.02);
  EXPECT_NEAR(of.at("memory 1.6 s"), std::cos(3.2), 1e-6);
  EXPECT_NEAR(of.at("turns 0.8 s"), 2 * std::log(1.6), 1e-9);
  EXPECT_NEAR(of.at("mean spin"), 2, 1e-9);
  // Half of the frames at 10 cm (ring 2 or 3, at its edge), half at 20 cm.
  double inner = 0, outer = 0;
  for (int r = 1; r <= 6; ++r) {
    const double share = std::pow(of.at("share ring " + std::to_string(r)), 2);
    (r <= 3 ? inner : outer) += share;
  }
  EXPECT_NEAR(inner, 0.5, 1e-9);
  EXPECT_NEAR(outer, 0.5, 1e-9);
}

TEST(MotionSummary, framesThatWereNotSeenDoNotCount) {
  Recording gaps = circles_for(60);
  for (Track& track : gaps.tracks) {
    for (std::size_t f = 1; f + 1 < track.x.size(); ++f) {
      const auto bits = random_bits({1, Stream::camera, static_cast<std::int64_t>(f), 0, 0});
      if (bits[0] % 4 == 0) track.x[f] = track.y[f] = track.theta[f] = kNone;
    }
  }
  const auto whole = named({circles_for(60)}, MotionSummary{}),
             some = named({gaps}, MotionSummary{});
  for (const auto& [name, value] : whole) {
    EXPECT_TRUE(std::isfinite(some.at(name))) << name;
    // Of a circle every pair of frames tells the same.
    if (name.starts_with("msd") || name.starts_with("turns")) {
      EXPECT_NEAR(some.at(name), value, 1e-6) << name;
    }
  }
}

TEST(MotionSummary, isFiniteWhereThereIsHardlyAnything) {
  Recording nothing;
  nothing.rate = 30, nothing.frames = 2;
  nothing.tracks.push_back({0, 0, {0.1, 0.1}, {0, 0}, {0, 0}});
  for (const double v : summarise({nothing}, MotionSummary{})) EXPECT_TRUE(std::isfinite(v));
}

TEST(Eq9, isZeroForEqualCurvesAndScalesAsThePaperSums) {
  const auto a = eq9_curve({circles_for(120)});
  ASSERT_EQ(a.size(), 600u);
  EXPECT_EQ(eq9(a, a), 0);
  auto b = a;
  for (double& v : b) v += 0.001;
  EXPECT_NEAR(eq9(a, b), 2400 * 0.001, 1e-9);
  EXPECT_EQ(eq9(a, {}), std::numeric_limits<double>::infinity());
}

TEST(Eq9, ofTheFirstOriginIsThatOfAPiece) {
  const auto piece = eq9_curve({circles_for(60)}, {.first_origin = true});
  for (std::size_t k = 0; k < piece.size(); ++k) {
    const double lag = 0.1 * static_cast<double>(k + 1);
    EXPECT_NEAR(piece[k], (0.01 + 0.04) * (1 - std::cos(2 * lag)), 1e-9);
  }
}

// At 25 frames a second 0.1 s is two and a half of them: no lag is off by more than half a frame.
TEST(Eq9, roundingsOfLagsDoNotAddUp) {
  Recording slow = circles_for(120);
  slow.rate = 25, slow.frames = 3000;
  for (Track& track : slow.tracks) {
    const std::vector<double> start{track.x.front(), track.y.front()};
    for (int f = 0; f < slow.frames; ++f) {
      track.x[static_cast<std::size_t>(f)] = start[0] + 0.01 * f / slow.rate;  // straight on
      track.y[static_cast<std::size_t>(f)] = start[1];
    }
    for (auto* of : {&track.x, &track.y, &track.theta}) of->resize(3000);
  }
  const auto curve = eq9_curve({slow});
  ASSERT_EQ(curve.size(), 600u);
  for (std::size_t k = 0; k < curve.size(); ++k) {
    EXPECT_NEAR(std::sqrt(curve[k]) / 0.01, 0.1 * static_cast<double>(k + 1), 0.02 + 1e-9) << k;
  }
}

}  // namespace
}  // namespace lilytank
