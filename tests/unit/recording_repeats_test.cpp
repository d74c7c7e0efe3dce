// Poses that repeat to the last digit: of bodies that move they are no measurements, of bodies that
// rest or move by less than the last digit they are.
#include <gtest/gtest.h>

#include <random>

#include "support/recordings.hpp"

namespace lilytank {
namespace {

/// Bodies on circles, with tracking noise of 0.3 mm, written to 0.01 mm.
class Repeats : public testing::Test {
 protected:
  struct Pose {
    double x, y;
  };
  void SetUp() override {
    std::mt19937 random(7);
    const auto noise = [&] { return 3e-4 * (static_cast<double>(random() % 2001) / 1000 - 1); };
    const Recording truth = circling(kBodies, kFrames, 30, false);
    for (const Track& track : truth.tracks) {
      std::vector<Pose> poses;
      for (std::size_t f = 0; f < track.x.size(); ++f) {
        poses.push_back({track.x[f] + noise(), track.y[f] + noise()});
      }
      poses_.push_back(std::move(poses));
    }
  }
  CheckedRecording check(double digit = 1e-5, const RecordingOptions& options = {}) {
    std::string table = "frame,time,id,x,y\n";
    for (std::size_t f = 0; f < poses_[0].size(); ++f) {
      for (std::size_t b = 0; b < poses_.size(); ++b) {
        char row[120];
        std::snprintf(row, sizeof row, "%zu,%.4f,%zu,%.5f,%.5f\n", f, static_cast<double>(f) / 30,
                      b, digit * std::round(poses_[b][f].x / digit),
                      digit * std::round(poses_[b][f].y / digit));
        table += row;
      }
    }
    return check_recording(here_.write("tracks.csv", table), options);
  }
  void hold(std::size_t body, std::size_t from, std::size_t to) {
    for (std::size_t f = from + 1; f <= to; ++f) poses_[body][f] = poses_[body][from];
  }
  void double_frames() {
    for (auto& poses : poses_) {
      for (std::size_t f = 1; f < poses.size(); f += 2) poses[f] = poses[f - 1];
    }
  }

  static constexpr int kBodies = 4, kFrames = 300;
  std::vector<std::vector<Pose>> poses_;
  TemporaryDirectory here_;
};

TEST_F(Repeats, areNotFoundWhereThereAreNone) {
  EXPECT_EQ(all_texts(check()), "");
}

TEST_F(Repeats, heldPosesAreMarked) {
  hold(2, 100, 130);
  hold(2, 200, 220);
  const CheckedRecording c = check();
  const auto found = of_kind(c, Check::repeat);
  ASSERT_EQ(found.size(), 2u) << all_texts(c);
  EXPECT_EQ(found[0].frame, 101);
  EXPECT_EQ(found[0].id, 2);
  EXPECT_EQ(found[0].treatment, Treatment::mark);
  EXPECT_TRUE(found[0].what.starts_with(
      "holds its pose to the last digit for 30 frames, up to frame 130, and is "))
      << found[0].what;
  for (const Track& track : c.recording.tracks) {
    EXPECT_TRUE(track.id != 2 || track.last() <= 100 || track.first > 130);
  }
  RecordingOptions options;
  options.rules[Check::repeat] = Treatment::keep;
  const CheckedRecording kept = check(1e-5, options);
  EXPECT_EQ(of_kind(kept, Check::repeat).size(), 2u);
  options.rules[Check::repeat] = Treatment::refuse;
  EXPECT_TRUE(check(1e-5, options).refused());
}

TEST_F(Repeats, aPoseHeldToTheEndIsMarked) {
  hold(1, 250, 299);
  const CheckedRecording c = check();
  const auto found = of_kind(c, Check::repeat);
  ASSERT_EQ(found.size(), 1u) << all_texts(c);
  EXPECT_EQ(found[0].frame, 251);
}

TEST_F(Repeats, framesWrittenTwiceHalveTheClock) {
  double_frames();
  const CheckedRecording c = check();
  const auto found = of_kind(c, Check::repeat);
  ASSERT_EQ(found.size(), 1u) << all_texts(c);
  EXPECT_EQ(found[0].id, -1);
  EXPECT_NE(found[0].what.find("in 150 of 300 frames (every frame is written twice): frames 1, 3, "
                               "5, 7, 9, 11, 13, 15, ..."),
            std::string::npos)
      << found[0].what;
  EXPECT_EQ(c.frame_step, 2);
  EXPECT_DOUBLE_EQ(c.recording.rate, 15);
  EXPECT_EQ(c.recording.frames, 150);
  ASSERT_EQ(c.recording.tracks.size(), 4u);
  for (const Track& track : c.recording.tracks) EXPECT_EQ(track.x.size(), 150u);
}

TEST_F(Repeats, framesWrittenTwiceAreFoundWithoutIdentities) {
  double_frames();
  RecordingOptions options;
  options.columns.id = "-", options.body_radius = 0.0175;
  const CheckedRecording c = check(1e-5, options);
  EXPECT_EQ(of_kind(c, Check::repeat).size(), 1u) << all_texts(c);
  EXPECT_DOUBLE_EQ(c.recording.rate, 15);
  EXPECT_EQ(c.recording.tracks.size(), 4u);
}

TEST_F(Repeats, aSingleFrameWrittenTwiceIsMarked) {
  for (auto& poses : poses_) poses[77] = poses[76];
  const CheckedRecording c = check();
  const auto found = of_kind(c, Check::repeat);
  ASSERT_EQ(found.size(), 1u) << all_texts(c);
  EXPECT_EQ(found[0].frame, 77);
  EXPECT_TRUE(std::isnan(c.recording.tracks[3].x[77]));
}

TEST_F(Repeats, bodiesThatRestAreNoRepeats) {
  // One stays where it is throughout, one slows down, rests, and sets off again.
  hold(0, 0, 299);
  for (std::size_t f = 100; f < 300; ++f) {
    const double t = static_cast<double>(f) - 100;
    const double way = t < 40 ? t - t * t / 80 : t < 120 ? 20 : 20 + (t - 120) * (t - 120) / 80;
    const double angle = way * 0.2 / 0.13 / 30;
    poses_[2][f] = {0.13 * std::cos(angle + 0.5), 0.13 * std::sin(angle + 0.5)};
  }
  const CheckedRecording c = check();
  EXPECT_TRUE(of_kind(c, Check::repeat).empty()) << all_texts(c);
}

TEST_F(Repeats, restingBodiesOfADoubledFilmStayInIt) {
  hold(0, 0, 299);
  double_frames();
  const CheckedRecording c = check();
  EXPECT_EQ(c.frame_step, 2) << all_texts(c);
  ASSERT_EQ(c.recording.tracks.size(), 4u);
  EXPECT_EQ(c.recording.tracks[0].x.size(), 150u);
}

TEST_F(Repeats, coarseDigitsOfSlowBodiesAreNoRepeats) {
  // A step of 0.7 mm by noise and motion, written to 1 mm and to 0.5 mm.
  for (auto& poses : poses_) {
    for (std::size_t f = 0; f < poses.size(); ++f) {
      poses[f].x = 0.1 * poses[f].x, poses[f].y = 0.1 * poses[f].y + 0.05;
    }
  }
  for (const double digit : {1e-3, 5e-4, 1e-4}) {
    const CheckedRecording c = check(digit);
    EXPECT_TRUE(of_kind(c, Check::repeat).empty()) << digit << "\n" << all_texts(c);
  }
}

TEST_F(Repeats, zerosForWhatWasNotSeen) {
  for (std::size_t f = 60; f < 75; ++f) poses_[3][f] = {0, 0};
  for (std::size_t f = 150; f < 152; ++f) poses_[1][f] = {0, 0};
  const CheckedRecording c = check();
  const auto found = of_kind(c, Check::repeat);
  ASSERT_EQ(found.size(), 2u) << all_texts(c);
  EXPECT_EQ(found[0].frame, 60);
  EXPECT_EQ(found[0].id, 3);
  EXPECT_NE(found[0].what.find("exactly at 0, 0 of the file in 15 sightings"), std::string::npos);
  for (const Track& track : c.recording.tracks) {
    for (std::size_t i = 0; i < track.x.size(); ++i) {
      EXPECT_FALSE(track.x[i] == 0 && track.y[i] == 0);
    }
  }
}

}  // namespace
}  // namespace lilytank
